// What the 3D view draws, as values: motions with their colours, and what its legend says.
#pragma once

#include <QColor>
#include <QString>
#include <optional>
#include <vector>

#include "gui/scene/motion_colouring.h"
#include "gui/workspace/workspace.h"

#include "render/scene/scene.h"

namespace marey::gui {

enum class Trails { Off, SelectedJoint, Feet };

/// What the bar above the view sets.
struct SceneSettings {
  ColourBy colourBy = ColourBy::System;
  render::Placement placement = render::Placement::World;
  render::BodyDetail detail = render::BodyDetail::Auto;
  double opacity = 1.0;
  double ghostsS = 0.0;  ///< 0: none
  int ghostFrames = 0;   ///< of the document's rate, instead of seconds; 0: by seconds
  Trails trails = Trails::Off;
  double trailS = 1.0;
  std::string
      naturalUnder;  ///< the model whose likelihood of natural motion is shown; empty: first
  bool contacts = false;
  bool shadow = true;
  bool path = true;
};

struct LegendLine {
  render::Colour colour;
  QString text;
};

/// What the colours of a picture mean.
struct SceneLegend {
  std::vector<LegendLine> groups;
  bool groupColours = true;         ///< bodies have the colours of their groups
  std::optional<ScaleRange> scale;  ///< of a colour bar
  QString scaleTitle;               ///< with its unit
  QString note;                     ///< how else, or why something is not coloured
};

struct SceneContent {
  std::vector<render::SceneMotion> motions;
  std::vector<MotionId> ids;  ///< of the motions, in their order
  SceneLegend legend;
};

SceneContent sceneContent(const Workspace& workspace, const SceneSettings& settings,
                          MotionColouring& colouring);
/// The system under which natural motion is scored; empty where the document has none.
std::string naturalSystem(const Workspace& workspace, const SceneSettings& settings);
/// A line of the legend: a set and how many of its motions are shown.
QString groupLabel(const std::string& group, int shown);

}  // namespace marey::gui
