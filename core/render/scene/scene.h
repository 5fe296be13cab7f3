// Pictures of motion: figures over each other along their path, as Marey exposed many moments of
// a walk on one plate.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "motion/clip.h"
#include "motion/features.h"
#include "render/base/camera.h"
#include "render/base/colours.h"
#include "render/base/image.h"
#include "stats/footsteps.h"

namespace marey::render {

struct SceneMotion {
  std::shared_ptr<const Clip> clip;  ///< world metres
  std::string system;                ///< legend entry; motions of one name share it
  Colour colour = naturalColour();
  double opacity = 1.0;      ///< of the whole figure; below 1 it lets others show through
  double strobeS = 0.4;      ///< a figure every so many seconds from the first frame on
  bool contactMarks = true;  ///< rings on the floor where feet rest
};

struct SceneSpec {
  std::vector<SceneMotion> motions;
  std::vector<RootFrame> path = {};  ///< line with arrows on the floor; empty: none
  View view = View::ThreeQuarter;
  bool orthographic = false;
  std::string title = {};
  bool legend = true;    ///< systems by colour, where a name is given
  bool scaleBar = true;  ///< 1 m
  bool floor = true;
  double gridM = 0.5;                ///< floor cells, metres; 0.5 or 1
  stats::ContactRule contacts = {};  ///< what contactMarks mark
};

/// Opacity of figures that stand for what a model does: the more of them, the fainter, so that one
/// sees how they spread; beside natural motion never solid.
double sampleOpacity(size_t samples, bool besideNatural);
/// The picture of a set of motions, wherever it is made: motions in the natural colour are solid,
/// all others get sampleOpacity, and names that no longer fit into one line of the legend go.
SceneSpec sceneOfMotions(std::vector<SceneMotion> motions);

/// Draws one scene as a still or frame by frame. Holds an OpenGL context without a display, so
/// creating one takes a few tenths of a second; use it from one thread at a time.
class SceneRenderer {
 public:
  /// width, height in pixels. Throws InputError for a scene without motions or with an invalid
  /// clip, Error where no OpenGL without a display is to be had.
  SceneRenderer(SceneSpec spec, int width, int height);
  ~SceneRenderer();
  SceneRenderer(SceneRenderer&&) noexcept;
  SceneRenderer& operator=(SceneRenderer&&) noexcept;

  /// All strobed figures at once, opaque RGBA.
  Image still();
  /// The figures at `timeS`; with `trail`, also the strobed figures up to then, lighter. The
  /// camera is fixed, or with `follow` moves along with the middle of the figures.
  Image frame(double timeS, bool follow = false, bool trail = false);
  /// Seconds from the first frame to the end of the longest motion.
  double seconds() const;

 private:
  struct Internals;
  std::unique_ptr<Internals> m_internals;
};

/// One still: SceneRenderer(spec, width, height).still().
Image renderScene(const SceneSpec& spec, int width, int height);

}  // namespace marey::render
