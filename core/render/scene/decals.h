// Private to the folder: marks of a scene that lie flat on the floor.
#pragma once

#include <span>

#include "motion/features.h"
#include "render/scene/contacts.h"
#include "render/scene/figure_strokes.h"

namespace marey::render {

/// A line with an arrow each metre and a larger one at its end, moved by `shift`.
void addPath(FigureStrokes& strokes, std::span<const RootFrame> path, const Vec3& shift,
             const Colour& colour);

/// A ring where each foot has rested until now, stronger while it rests.
void addRests(FigureStrokes& strokes, std::span<const Rest> rests, double timeS, const Vec3& shift,
              const Colour& colour);

/// A wide ring under a figure; `root` is its root joint.
void addFootRing(FigureStrokes& strokes, const Vec3& root, float radiusM, const Colour& colour);

}  // namespace marey::render
