// Private to the folder: title, legend and scale bar over a rendered picture.
#pragma once

#include "render/scene/scene.h"

namespace marey::render {

/// The height that title and legend take at the top of a picture, pixels.
double overlayHeight(const SceneSpec& spec, int height);
/// `barFrom` and `barTo` are one metre apart in the world; drawn with "1 m" below.
struct ScaleBar {
  Vec3 from, to;
};
Image withOverlay(const Image& image, const SceneSpec& spec, const Camera& camera,
                  const std::optional<ScaleBar>& bar);

}  // namespace marey::render
