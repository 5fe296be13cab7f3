// Private to the folder: what a scene shows and where all of it stands at a time. Knows nothing of
// graphics.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "render/scene/scene.h"
#include "render/scene/tracks.h"

namespace marey::render {

/// A ball around everything that is ever shown, and a cylinder for the floor.
struct SceneExtent {
  Vec3 centre{0.0F, 0.9F, 0.0F};
  float radius = 2.0F;
  float floorRadius = 2.0F;
};

bool isSolid(double opacity);

class Stage {
 public:
  /// As Scene::setMotions.
  void setMotions(std::vector<SceneMotion> motions);
  /// As Scene::setOptions.
  void setOptions(SceneOptions options);
  void setTime(double seconds);

  const std::vector<SceneMotion>& motions() const { return m_motions; }
  const SceneOptions& options() const { return m_options; }
  double time() const { return m_time; }
  const Track& track(size_t motion) const { return *m_tracks[motion]; }
  /// Seconds to the last frame of the longest motion.
  double longestS() const;

  /// Joints of a motion at the stage's time.
  std::span<const Vec3> pose(size_t motion) const;
  /// What a motion's figure of a moment looks like: highlights, endings and the background
  /// considered.
  Colour colour(size_t motion, double timeS) const;
  bool asLines() const;
  /// Whether marks on the floor have a place: not where all walk on the spot.
  bool marksInPlace() const { return m_options.placement != Placement::RootAligned; }

  const SceneExtent& extent() const { return m_extent; }
  /// Points around everything that is ever shown, the path included.
  std::vector<Vec3> outline() const;
  /// Points around the figures of all moments as a camera that follows sees them, when it is at
  /// `followed`.
  std::vector<Vec3> outlineAround(const Vec3& followed) const;
  /// Where, on the floor, the highlighted motions are, or all; smoothed, so that a camera glides.
  Vec3 meanRoot(double timeS) const;
  /// The main direction of travel, level.
  Vec3 travel() const;
  /// The shorter side of the place on the floor that the roots walk over, metres.
  double spreadM() const;

 private:
  template <class Shift>
  std::vector<Vec3> figureOutline(Shift&& shiftAt) const;
  void update();

  std::vector<SceneMotion> m_motions;
  std::vector<std::shared_ptr<Track>> m_tracks;  ///< one per motion
  SceneOptions m_options;
  double m_time = 0.0;
  bool m_someHighlighted = false;
  SceneExtent m_extent;
  mutable std::vector<Vec3> m_poses;  ///< of every motion at m_time, one after the other
  mutable std::vector<size_t> m_offsets;
  mutable bool m_posesCurrent = false;
};

}  // namespace marey::render
