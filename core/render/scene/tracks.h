// Private to the folder: the motions of a scene, put where the scene shows them.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "motion/clip.h"
#include "render/scene/bodies.h"
#include "render/scene/contacts.h"
#include "render/scene/scene.h"

namespace marey::render {

/// One clip with what is worked out from it once.
class Track {
 public:
  /// Throws InputError for an invalid clip.
  explicit Track(std::shared_ptr<const Clip> clip);

  const Clip& clip() const { return *m_clip; }
  const BodyShape& shape() const { return m_shape; }
  int jointCount() const { return m_clip->jointCount(); }
  double lastS() const { return (m_clip->frameCount() - 1) / m_clip->fps; }
  /// Corners of the box around every frame, world metres.
  const Vec3& low() const { return m_low; }
  const Vec3& high() const { return m_high; }
  /// Times and places at which feet rest, world metres.
  const std::vector<Rest>& rests(const stats::ContactRule& rule) const;
  /// Throws InputError where the skeleton has no hips.
  void needRoots() const;

  /// All joints at a time as `placement` shows them; `out` has jointCount() places.
  void pose(double timeS, Placement placement, std::span<Vec3> out) const;
  Vec3 joint(double timeS, int joint, Placement placement) const;

  /// Where SideBySide moves the motion.
  Vec3 shift = Vec3::Zero();

 private:
  struct Moment {
    int before = 0, after = 0;
    float share = 0.0F;
  };
  Moment momentAt(double timeS) const;
  Eigen::Isometry3f placing(const Moment& moment, Placement placement) const;

  std::shared_ptr<const Clip> m_clip;
  BodyShape m_shape;
  Vec3 m_low, m_high;
  mutable std::optional<std::vector<Rest>> m_rests;
  mutable stats::ContactRule m_restRule;  ///< of m_rests
  mutable std::vector<RootFrame> m_roots;
};

/// The motions next to each other across the main direction of travel, the first one to the left
/// of a walker; the row keeps the middle it had.
void placeSideBySide(std::span<const std::shared_ptr<Track>> tracks);

/// The main direction of travel of the first of them.
Vec3 travelOf(std::span<const std::shared_ptr<Track>> tracks);

}  // namespace marey::render
