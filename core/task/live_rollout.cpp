#include "task/live_rollout.h"

#include <cmath>
#include <limits>

#include "base/error.h"
#include "model/sampler.h"

namespace marey {
namespace {

/// Displacements and turn of one frame.
Eigen::RowVector3f rootMotionOf(const LiveCommand& velocity, double fps) {
  return {static_cast<float>(velocity.sidewaysMS / fps),
          static_cast<float>(velocity.forwardMS / fps),
          static_cast<float>(velocity.turnRadS / fps)};
}

/// A type holds from `timeS` on; an empty one ends the last.
void setType(const std::string& type, std::vector<LabelSpan>& labels, double timeS) {
  const bool open = !labels.empty() && std::isinf(labels.back().toS);
  if (open ? labels.back().label == type : type.empty()) return;
  if (open) labels.back().toS = timeS;
  if (!type.empty()) labels.push_back({.fromS = timeS, .label = type});
}

void approach(double& value, double wanted, double share) {
  value += share * (wanted - value);
}

}  // namespace

LiveRollout::LiveRollout(std::shared_ptr<const MotionModel> model, const LiveOptions& options)
    : m_model(std::move(model)),
      m_options(options),
      m_velocity(options.begin),
      m_bodyVelocity(options.begin),
      m_root(options.start) {
  const ModelInfo& info = m_model->info();
  if (!info.skeleton)
    throw InputError({.path = info.variant}, "a model with a skeleton", "one imported without it");
  if (!info.knowsControl())
    throwInput({.path = info.variant},
               fmt::format("a model of {} control values per frame ({})",
                           info.features.controlWidth(), summaryOf(info.features.control)),
               "{}", info.controlDim);
  requireDrawable(info, options.temperature, options.options, info.variant);
  const int rows = info.context + 1 + info.lookahead;
  m_bodyVelocity = inBodyFrame(m_velocity.facingRad);
  setType(options.begin.type, m_labels, -std::numeric_limits<double>::infinity());
  m_window = controlRow().replicate(1, rows);
  m_state = requireRollout(*m_model).start(1, {});
  const auto warmUp = static_cast<int>(std::lround(options.warmUpS * info.features.fps));
  for (int t = 0; t < warmUp; ++t) step(controlRow());
}

/// The control of the next frame; beyond it the body goes on as it does.
Matrix LiveRollout::controlRow() const {
  const FeatureSpec& f = m_model->info().features;
  Matrix out(1, f.controlWidth());
  const Eigen::RowVector3f motion = rootMotionOf(m_bodyVelocity, f.fps);
  if (!isRootMotionAlone(f.control)) {
    SampleRequest request;
    request.path = trajectoryFromControl(motion.replicate(2, 1), {});
    request.control.annotations.labels = m_labels;
    request.control.annotations =
        startingAt(std::move(request.control.annotations), m_frames / f.fps);
    request.control.leftOut = {m_options.leftOut.begin(), m_options.leftOut.end()};
    out = controlOf(m_model->info(), request).row(0);
  }
  out.leftCols(3) = motion;
  return out;
}

/// Draws the next pose under a row of control.
void LiveRollout::step(const Matrix& control) {
  const ModelInfo& info = m_model->info();
  const long wide = info.controlDim;
  const long kept = static_cast<long>(info.context) * wide;
  const Matrix past = m_window.middleCols(wide, kept);
  m_window.leftCols(kept) = past;
  m_window.rightCols(m_window.cols() - kept) = control.replicate(1, 1 + info.lookahead);
  Matrix latent(1, info.latent.width);
  drawLatent(info, {m_options.seed, m_options.sample, m_options.temperature, &m_options.options},
             m_generated, latent.data());
  m_pose = m_model->rollout()->sampleFrame(m_state, m_window, latent);
  if (!m_pose.allFinite())
    throw NumericError(fmt::format(
        "the motion left the range of numbers at frame {}: expected finite poses, found NaN or "
        "infinity (try a lower temperature)",
        m_frames));
  ++m_generated;
}

/// A body that looks to the left of its way goes to its right, and turns more than its way does.
LiveCommand LiveRollout::inBodyFrame(double facingBefore) const {
  // Displacements are those in the frame of the step before.
  const double c = std::cos(facingBefore), s = std::sin(facingBefore);
  LiveCommand out = m_velocity;
  out.forwardMS = c * m_velocity.forwardMS + s * m_velocity.sidewaysMS;
  out.sidewaysMS = c * m_velocity.sidewaysMS - s * m_velocity.forwardMS;
  out.turnRadS += (m_velocity.facingRad - facingBefore) * m_model->info().features.fps;
  return out;
}

std::vector<Vec3> LiveRollout::advance(const LiveCommand& command) {
  const ModelInfo& info = m_model->info();
  const double fps = info.features.fps;
  const double share =
      m_options.smoothingS > 0.0 ? 1.0 - std::exp(-1.0 / (fps * m_options.smoothingS)) : 1.0;
  approach(m_velocity.forwardMS, command.forwardMS, share);
  approach(m_velocity.sidewaysMS, command.sidewaysMS, share);
  approach(m_velocity.turnRadS, command.turnRadS, share);
  const double facingBefore = m_velocity.facingRad;
  // The first frame stands at the start and cannot turn.
  if (m_frames > 0) approach(m_velocity.facingRad, command.facingRad, share);
  m_bodyVelocity = inBodyFrame(facingBefore);
  m_commands.push_back(command);
  setType(command.type, m_labels, m_frames / fps);
  const Matrix control = controlRow();
  step(control);
  if (m_frames > 0) m_root = trajectoryFromControl(control.replicate(2, 1), m_root).back();
  m_poses.insert(m_poses.end(), m_pose.data(), m_pose.data() + m_pose.size());
  m_controls.insert(m_controls.end(), control.data(), control.data() + control.size());
  m_trajectory.push_back(m_root);
  ++m_frames;
  return rebuildMotion(m_pose, control, m_root, info.skeleton, info.features).positions;
}

FeatureSequence LiveRollout::sequence() const {
  const ModelInfo& info = m_model->info();
  FeatureSequence out{.name = "live", .pose = {}, .control = {}, .start = m_options.start};
  out.pose = Eigen::Map<const Matrix>(m_poses.data(), m_frames, info.poseDim);
  out.control = Eigen::Map<const Matrix>(m_controls.data(), m_frames, info.controlDim);
  // The first row has no previous frame: by convention its root motion repeats the second's.
  if (m_frames > 1) out.control.row(0).head(3) = out.control.row(1).head(3);
  return out;
}

std::vector<WayPoint> LiveRollout::walkedPath() const {
  const double fps = m_model->info().features.fps;
  std::vector<WayPoint> out;
  for (size_t t = 0; t < m_trajectory.size(); ++t) {
    WayPoint point{.x = m_trajectory[t].x, .z = m_trajectory[t].z};
    point.timeS = static_cast<double>(t) / fps;
    point.facing = m_trajectory[t].heading;
    out.push_back(point);
  }
  return out;
}

LiveRollout replay(std::shared_ptr<const MotionModel> model, const Steering& steering) {
  LiveRollout out(std::move(model), steering.options);
  for (const LiveCommand& command : steering.commands) out.advance(command);
  return out;
}

}  // namespace marey
