// A shot: what is shown and from where, as a value. Stills, strobed pictures and films are drawn of
// it, without a display, by the scene that a window shows.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/json.h"
#include "render/base/image.h"
#include "render/scene/scene.h"

namespace marey::render {

/// What is written over a picture.
struct Caption {
  std::string title = {};
  bool legend = false;    ///< labels of motions by colour; those of one label share it
  bool scaleBar = false;  ///< 1 m
};

/// Shared clips only, so it is cheap to hand to another thread.
struct Shot {
  std::vector<SceneMotion> motions;
  SceneOptions options;
  std::optional<View> view;  ///< turned to and fitted to the picture; none: `viewpoint`
  Viewpoint viewpoint;
  bool orthographic = false;  ///< of `view`; a viewpoint has its own
  bool follow = false;        ///< the camera moves along with the figures
  double beginS = 0.0;
  std::optional<double> endS;  ///< the last moment shown; none: the end of the longest motion
  Caption caption;
  int fineness = 1;  ///< pixels drawn for each, in both directions, and averaged: 2 for smoother
                     ///< edges where see-through limbs meet
  Image over;        ///< laid over every picture, which has its size: a legend; empty: nothing
};

/// Opacity of figures that stand for what a model does: the more of them, the fainter, so that one
/// sees how they spread; beside natural motion never solid.
double sampleOpacity(size_t samples, bool besideNatural);
/// Motions as they are printed: on white, with marks of the feet, legend and scale bar, from the
/// side and above; labels that no longer fit into one line of the legend go.
Shot printed(std::vector<SceneMotion> motions);
/// The same with the opacities that tell a set of motions apart: those in the natural colour are
/// solid, all others get sampleOpacity.
Shot shotOfMotions(std::vector<SceneMotion> motions);
/// Figures of many moments over each other, as Marey exposed many moments of a walk on one plate:
/// one every so many seconds. The present one is not drawn: drawEnd shows all. Throws InputError
/// unless the time is above zero.
Shot strobed(Shot shot, double everyS);
/// As a film: earlier figures stay, lighter. Throws InputError unless the time is above zero.
Shot withTrail(Shot shot, double everyS);

/// Draws a shot moment by moment. Holds an OpenGL context without a display, so creating one takes
/// a few tenths of a second; use it from one thread at a time.
class ShotPicture {
 public:
  /// width, height in pixels, 32 or more. Throws InputError for a shot without motions and as
  /// Scene does, Error where no OpenGL without a display is to be had.
  ShotPicture(Shot shot, int width, int height);
  ~ShotPicture();
  ShotPicture(ShotPicture&&) noexcept;
  ShotPicture& operator=(ShotPicture&&) noexcept;
  /// Opaque RGBA.
  Image at(double timeS);

 private:
  struct Internals;
  std::unique_ptr<Internals> m_internals;
};

/// One moment. Throws as ShotPicture does.
Image drawShot(const Shot& shot, double timeS, int width, int height);
/// The last moment of the longest motion: all of a strobed shot.
Image drawEnd(const Shot& shot, int width, int height);
/// What was shown and from where, for recipes; the motions themselves are left out.
Json toJson(const Shot& shot);

}  // namespace marey::render
