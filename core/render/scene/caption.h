// Private to the folder: title, legend and scale bar over a drawn picture.
#pragma once

#include <optional>
#include <span>

#include "render/base/camera.h"
#include "render/base/image.h"
#include "render/scene/shot.h"

namespace marey::render {

/// One metre on the floor.
struct ScaleBar {
  Vec3 from, to;
};
/// On the floor in front of the points, along the lower edge of the picture.
ScaleBar scaleBarFor(const Camera& camera, std::span<const Vec3> points);

/// The height that title and legend take at the top of a picture, pixels.
double captionHeight(const Shot& shot, int height);
Image withCaption(const Image& image, const Shot& shot, const Camera& camera,
                  const std::optional<ScaleBar>& bar);

}  // namespace marey::render
