// One motion of a model, steered while it is made: a command in, the next frame out.
#pragma once

#include <memory>
#include <vector>

#include "task/steering.h"

#include "model/motion_model.h"
#include "motion/path.h"

namespace marey {

/// Deterministic for model, options and the commands. With a constant command equal to `begin` it
/// is the sampler's motion of that seed and sample along the straight path or circle. Where the
/// model looks ahead, it is told that the velocity stays as it is. Not thread-safe.
class LiveRollout {
 public:
  /// Throws InputError for a model without a skeleton, or with a signal as control that may not be
  /// left out; as do commands without a type where the model needs one, or of an unknown one.
  LiveRollout(std::shared_ptr<const MotionModel> model, const LiveOptions& options);

  /// World positions of the next frame's joints, metres. The first frame stands at
  /// LiveOptions::start. Throws NumericError when the pose is not finite.
  std::vector<Vec3> advance(const LiveCommand& command);
  int frameCount() const { return m_frames; }
  const MotionModel& model() const { return *m_model; }
  const LiveOptions& options() const { return m_options; }
  /// What this motion was made by.
  Steering steering() const { return {m_options, m_commands}; }
  /// Root frames so far: the first one is LiveOptions::start.
  const std::vector<RootFrame>& trajectory() const { return m_trajectory; }
  /// Of the last frame.
  const RootFrame& root() const { return m_root; }
  /// All frames so far, as a model sees them.
  FeatureSequence sequence() const;
  /// Way-points at every frame: a path that passes where the root went, when it did.
  std::vector<WayPoint> walkedPath() const;

 private:
  void step(const Matrix& control);
  Matrix controlRow() const;
  LiveCommand inBodyFrame(double facingBefore) const;

  std::shared_ptr<const MotionModel> m_model;
  LiveOptions m_options;
  LiveCommand m_velocity;               ///< smoothed, along the way
  LiveCommand m_bodyVelocity;           ///< the same as the body makes it
  std::vector<LabelSpan> m_labels;      ///< types so far, from the first frame
  std::vector<LiveCommand> m_commands;  ///< of all frames
  RolloutState m_state;
  Matrix m_window;  ///< [1, (context + 1 + lookahead) * C]
  Matrix m_pose;    ///< [1, D], of the last frame
  RootFrame m_root;
  int m_generated = 0;  ///< frames with the warm-up's
  int m_frames = 0;
  std::vector<float> m_poses, m_controls;  ///< rows of all frames
  std::vector<RootFrame> m_trajectory;
};

/// Advances a new rollout by every command of `steering`. Throws as LiveRollout.
LiveRollout replay(std::shared_ptr<const MotionModel> model, const Steering& steering);

}  // namespace marey
