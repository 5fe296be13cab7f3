// The 3D view: many motions on one clock, drawn in a few batches whatever their number, so that
// hundreds of skeletons play smoothly without a graphics card. A window shows its renderer as it
// moves, a ScenePicture draws it without a display, a Shot makes stills and films of it; nothing
// here knows of windows.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "motion/clip.h"
#include "motion/features.h"
#include "render/base/camera.h"
#include "render/base/colours.h"
#include "render/scene/bodies.h"
#include "stats/footsteps.h"

class vtkRenderer;

namespace marey::render {

struct SceneMotion {
  std::shared_ptr<const Clip> clip;  ///< world metres, any frame rate
  Colour colour = naturalColour();   ///< near-black is lifted on a dark background
  double opacity = 1.0;
  bool highlighted = false;  ///< drawn solid with a ring on the floor; all others step back
  std::string label = {};
  /// One per frame of the clip (by log-likelihood, by speed), instead of `colour`; empty: none.
  std::vector<Colour> frameColours = {};
  std::vector<int> trailJoints = {};                 ///< joints that draw a line behind them
  std::optional<int> highlightJoint = std::nullopt;  ///< a ball on this joint
};

enum class Placement {
  World,        ///< where the clips are
  RootAligned,  ///< each in its own root frame: all walk on the spot at the origin, facing +Z
  SideBySide,   ///< moved apart across the walk, so that none ever overlap; the first at its left
};
enum class BodyDetail {
  Auto,      ///< capsules; lines where there are too many figures to see their shape
  Capsules,  ///< round limbs, a head, light and shade
  Lines,     ///< thin lines of constant width
};
enum class View {
  ThreeQuarter,  ///< from the side and above, the walk going to the right and nearer
  Side,          ///< the walk going to the right
  Front,
  Back,
  Top,  ///< straight down, the walk going to the right
};

/// What figures stand on.
enum class Tone { Light, Dark, Paper /*!< white, for print */ };

/// Figures of other moments, as a stroboscope shows them.
struct Strobe {
  double everyS = 0.0;    ///< a figure every so many seconds from the first frame on; 0: none
  double opacity = 0.3;   ///< against that of their motion
  bool untilNow = false;  ///< only those before the scene's time
  bool shadows = false;   ///< whether they cast any
};

struct SceneOptions {
  Placement placement = Placement::World;
  BodyDetail detail = BodyDetail::Auto;
  Strobe strobe = {};
  bool present = true;      ///< the figures of the scene's time
  bool solidFirst = false;  ///< what is seen through is laid thinner over solid figures, so that in
                            ///< a crowd one still sees what all are compared with
  double trailS = 1.0;      ///< length of the lines behind trailJoints, seconds
  bool contactMarks = false;         ///< rings on the floor where feet have rested so far
  stats::ContactRule contacts = {};  ///< what counts as rest
  bool floor = true;
  bool shadow = true;                ///< only with the floor
  std::vector<RootFrame> path = {};  ///< line with arrows on the floor, world; empty: none
  Tone tone = Tone::Light;
  double gridM = 0.5;  ///< floor cells, metres; every metre is drawn stronger
};

/// How a scene is seen, so that another one can be seen so.
struct Viewpoint {
  Camera camera;
  Eigen::Vector2f light{0.34F, 0.2F};  ///< x, z by which a metre of height shifts its shadow
  double timeS = 0.0;                  ///< at which a following camera stands there
};

/// What lies under the mouse.
struct Hit {
  size_t motion = 0;  ///< index into the motions
  int joint = 0;
  Vec3 place = Vec3::Zero();  ///< of the joint as drawn, metres
  double pixels = 0.0;        ///< from the asked point
};

/// What the last drawing cost and drew.
struct SceneCost {
  double fillMs = 0.0;       ///< poses and vertices, before OpenGL
  size_t figures = 0;        ///< bodies, with those of the strobe
  size_t strokes = 0;        ///< limbs, lines and rings
  bool lines = false;        ///< whether Auto chose lines
  bool floorCopied = false;  ///< from an earlier drawing; neither it nor the camera has changed
};

/// Positions on screen are in pixels of a picture width x height, from its top left. Use from one
/// thread. Work that a change asks for is done when the renderer draws next, so setting the time
/// many times between two drawings costs nothing.
class Scene {
 public:
  Scene();
  ~Scene();
  Scene(Scene&&) noexcept;
  Scene& operator=(Scene&&) noexcept;

  /// Add it to any render window. Owned here: remove it from the window before the scene ends.
  /// Its camera may be moved by anyone; clipping planes are set by the scene at every drawing.
  vtkRenderer* renderer() const;

  /// Throws InputError for a missing or invalid clip or a number of frameColours that is not that
  /// of the frames, and leaves the scene as it was. Joints that a skeleton does not have are left
  /// out. Cheap for clips that were there before.
  void setMotions(std::vector<SceneMotion> motions);
  const std::vector<SceneMotion>& motions() const;
  /// Throws InputError for RootAligned where a skeleton has no hips and for a strobe of negative
  /// times, and leaves the scene as it was.
  void setOptions(SceneOptions options);
  const SceneOptions& options() const;

  /// Seconds from the first frame; clips of other rates follow the same clock; at
  /// its end a clip fades to a pale trace of its last frame.
  void setTime(double seconds);
  double time() const;
  /// Seconds from the first to the last frame of the longest motion; 0 without motions.
  double seconds() const;
  /// Joints of one motion as drawn now, metres.
  std::vector<Vec3> pose(size_t motion) const;

  /// Turns the camera to a preset relative to the main direction of travel, and fits.
  void setView(View view, int width, int height);
  /// For a picture that nobody turns: ThreeQuarter looks from higher up the more the motions spread
  /// over the floor.
  void setView(View view, const Frame& frame);
  /// Moves the camera, in its present direction, to see the whole of every motion and the path.
  void fit(int width, int height);
  /// The same inside the free part of a picture, and `more` points besides.
  void fit(const Frame& frame, std::span<const Vec3> more = {});
  /// Points around everything that `fit` shows.
  std::vector<Vec3> outline() const;
  /// The camera moves along with the mean root of the highlighted motions, or of all.
  void setFollow(bool follow);
  bool follow() const;
  /// Keeps what is in the middle at its size.
  void setOrthographic(bool orthographic);
  bool orthographic() const;
  /// For a mouse: about the point looked at, radians; shifts in pixels of a picture `height` high;
  /// zoom above 1 comes nearer. The camera stays above the floor.
  void orbit(double aroundRad, double upRad);
  void pan(double x, double y, int height);
  void zoom(double factor);
  /// The camera as it is, following included.
  Camera camera() const;
  Viewpoint viewpoint() const;
  /// Takes the camera and the light of another scene, and its time, at which they hold.
  void setViewpoint(const Viewpoint& viewpoint);

  /// The joint within `reach` pixels that is nearest on screen; of joints about as near, the one
  /// in front. Figures of the strobe are not picked.
  std::optional<Hit> pick(double x, double y, int width, int height, double reach = 14.0) const;
  /// Where the line of sight meets the floor (y = 0); none where it misses it.
  std::optional<Vec3> floorPoint(double x, double y, int width, int height) const;
  /// Where a place in the world is seen.
  ScreenPoint screenPoint(const Vec3& world, int width, int height) const;

  Colour background() const;
  /// Of the last drawing.
  const SceneCost& cost() const;

 private:
  struct Internals;
  std::unique_ptr<Internals> m_internals;
};

}  // namespace marey::render
