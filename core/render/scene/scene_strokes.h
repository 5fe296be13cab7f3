// Private to the folder: everything that a scene draws, as strokes. Knows nothing of OpenGL but the
// form of a stroke.
#pragma once

#include <vector>

#include "render/scene/figure_strokes.h"
#include "render/scene/soft_shadow.h"
#include "render/scene/stage.h"

namespace marey::render {

/// Strokes by the way they are drawn. Kept and refilled, so that a frame allocates nothing.
struct SceneStrokes {
  FigureStrokes solid, sheer, lines;  ///< figures; solid ones of the strobe among them
  FigureStrokes strobe;               ///< its see-through figures
  FigureStrokes trails, decals;
  std::vector<ShadowLimb> shadows;

  /// All that depends on the time.
  void fillNow(const Stage& stage);
  /// See-through figures of other moments.
  void fillStrobe(const Stage& stage);
  size_t figureCount() const;
  size_t strokeCount() const;

 private:
  void addPresent(const Stage& stage);
  void addHighlightBall(FigureStrokes& figures, const Stage& stage, size_t motion);
  void fillTrails(const Stage& stage);
  void fillDecals(const Stage& stage);
};

}  // namespace marey::render
