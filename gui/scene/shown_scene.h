// What the 3D view shows, for whoever draws it elsewhere: stills and films.
#pragma once

#include <vector>

#include "gui/scene/scene_content.h"

#include "render/scene/scene.h"

namespace marey::gui {

/// As it was drawn last; without motions where it never was.
struct ShownScene {
  std::vector<render::SceneMotion> motions;
  render::SceneOptions options;
  render::Viewpoint viewpoint;
  bool follow = false;
  double timeS = 0.0;
  ColourBy colourBy = ColourBy::System;
  SceneLegend legend;
  int width = 0, height = 0;  ///< pixels
};

}  // namespace marey::gui
