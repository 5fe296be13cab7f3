#include "motion/features.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

#include "base/error.h"
#include "motion/control/encode_control.h"
#include "motion/representation/representation.h"
#include "motion/resample.h"

namespace marey {
namespace {

/// Gaussian filter truncated at 4 sigma. Beyond its ends the signal is continued by point
/// reflection (2 x_end - x), which keeps a steady velocity steady up to the ends.
std::vector<double> gaussianFiltered(const std::vector<double>& values, double sigmaFrames) {
  const int n = static_cast<int>(values.size());
  if (sigmaFrames <= 0.0 || n < 2) return values;
  const int radius = static_cast<int>(std::ceil(4.0 * sigmaFrames));
  std::vector<double> kernel(static_cast<size_t>(radius) + 1);
  double sum = 0.0;
  for (int i = 0; i <= radius; ++i) {
    kernel[i] = std::exp(-0.5 * (i / sigmaFrames) * (i / sigmaFrames));
    sum += i == 0 ? kernel[i] : 2.0 * kernel[i];
  }
  const auto at = [&](int t) {
    double shift = 0.0, sign = 1.0;
    while (t < 0 || t >= n) {
      const int end = t < 0 ? 0 : n - 1;
      shift += sign * 2.0 * values[end];
      sign = -sign;
      t = 2 * end - t;
    }
    return shift + sign * values[t];
  };
  std::vector<double> out(values.size());
  for (int t = 0; t < n; ++t) {
    double total = kernel[0] * values[t];
    for (int i = 1; i <= radius; ++i) total += kernel[i] * (at(t - i) + at(t + i));
    out[t] = total / sum;
  }
  return out;
}

double wrapped(double angle) {
  return std::remainder(angle, 2.0 * std::numbers::pi);
}

/// Makes an angle continuous, so that it can be filtered.
std::vector<double> unwrapped(std::vector<double> angles) {
  for (size_t t = 1; t < angles.size(); ++t)
    angles[t] = angles[t - 1] + wrapped(angles[t] - angles[t - 1]);
  return angles;
}

/// Unfiltered heading: the floor direction at right angles to the mean left-right vector.
std::vector<double> rawHeading(const Clip& clip, const SkeletonRoles& roles) {
  std::vector<double> out(static_cast<size_t>(clip.frameCount()));
  double last = 0.0;
  for (int t = 0; t < clip.frameCount(); ++t) {
    Vec3 across = clip.at(t, roles.leftHip) - clip.at(t, roles.rightHip);
    if (roles.leftShoulder >= 0 && roles.rightShoulder >= 0)
      across += clip.at(t, roles.leftShoulder) - clip.at(t, roles.rightShoulder);
    // across x up: with the left side at +X and Y up this is +Z, the facing of heading 0.
    const Vec3 forward = across.cross(Vec3::UnitY());
    // A body whose sides coincide on the floor has no facing of its own: keep the last one.
    if (forward.squaredNorm() > 1e-10f) last = std::atan2(forward.x(), forward.z());
    out[t] = last;
  }
  return unwrapped(std::move(out));
}

/// The direction of every step; that of the step before where there is none.
std::vector<double> headingOfMovement(const std::vector<double>& x, const std::vector<double>& z) {
  constexpr double kLeastStepM = 1e-4;
  std::vector<double> out(x.size(), 0.0);
  bool moved = false;
  for (size_t t = 1; t < x.size(); ++t) {
    const double dx = x[t] - x[t - 1], dz = z[t] - z[t - 1];
    const bool step = std::hypot(dx, dz) > kLeastStepM;
    out[t] = step ? std::atan2(dx, dz) : out[t - 1];
    if (step && !moved) std::fill(out.begin(), out.begin() + static_cast<long>(t), out[t]);
    moved = moved || step;
  }
  return unwrapped(std::move(out));
}

}  // namespace

std::vector<RootFrame> rootTrajectory(const Clip& clip, const FeatureSpec& spec) {
  if (!rolesOf(*clip.skeleton).hasFacing())
    throw InputError({.path = clip.source.path.empty() ? clip.name : clip.source.path},
                     "a left and a right hip joint (they give the facing direction)",
                     "joints without such names");
  return rootPath(clip, spec);
}

std::vector<RootFrame> rootPath(const Clip& clip, const FeatureSpec& spec) {
  const SkeletonRoles roles = rolesOf(*clip.skeleton);
  const auto n = static_cast<size_t>(clip.frameCount());
  std::vector<double> x(n), z(n);
  for (size_t t = 0; t < n; ++t) {
    const Vec3& hips = clip.at(static_cast<int>(t), roles.hips);
    x[t] = hips.x();
    z[t] = hips.z();
  }
  x = gaussianFiltered(x, spec.rootSigmaS * clip.fps);
  z = gaussianFiltered(z, spec.rootSigmaS * clip.fps);
  const auto heading =
      gaussianFiltered(roles.hasFacing() ? rawHeading(clip, roles) : headingOfMovement(x, z),
                       spec.facingSigmaS * clip.fps);
  std::vector<RootFrame> out(n);
  for (size_t t = 0; t < n; ++t) out[t] = {x[t], z[t], heading[t]};
  return out;
}

Matrix controlFromTrajectory(const std::vector<RootFrame>& trajectory) {
  Matrix control = Matrix::Zero(static_cast<long>(trajectory.size()), 3);
  for (size_t t = 1; t < trajectory.size(); ++t) {
    const RootFrame &from = trajectory[t - 1], &to = trajectory[t];
    const double c = std::cos(from.heading), s = std::sin(from.heading);
    const double dx = to.x - from.x, dz = to.z - from.z;
    control(static_cast<long>(t), 0) = static_cast<float>(c * dx - s * dz);
    control(static_cast<long>(t), 1) = static_cast<float>(s * dx + c * dz);
    control(static_cast<long>(t), 2) = static_cast<float>(wrapped(to.heading - from.heading));
  }
  if (control.rows() > 1) control.row(0) = control.row(1);
  return control;
}

std::vector<RootFrame> trajectoryFromControl(const Matrix& control, const RootFrame& start) {
  std::vector<RootFrame> out(static_cast<size_t>(control.rows()), start);
  for (size_t t = 1; t < out.size(); ++t) {
    const auto row = control.row(static_cast<long>(t));
    const RootFrame& from = out[t - 1];
    const double c = std::cos(from.heading), s = std::sin(from.heading);
    out[t] = {from.x + c * row(0) + s * row(1), from.z - s * row(0) + c * row(1),
              from.heading + row(2)};
  }
  return out;
}

namespace {

Place placeOf(const Clip& clip) {
  return {.path = clip.source.path.empty() ? clip.name : clip.source.path};
}

}  // namespace

ControlRequest requestOf(const Clip& clip, const FeatureSpec& spec,
                         std::shared_ptr<const Skeleton> body) {
  ControlRequest out{.annotations = clip.annotations, .body = std::move(body), .leftOut = {}};
  const ControlChannel* type = channelOf(spec.control, ControlKind::Label);
  if (type && type->fromNames && out.annotations.labels.empty())
    if (const std::string label = labelInName(*type, clip.name); !label.empty())
      out.annotations.labels = {{.label = label}};
  return out;
}

FeatureSequence extractFeatures(const Clip& source, const FeatureSpec& spec,
                                std::shared_ptr<const Skeleton> skeleton) {
  validate(source);
  const Representation& poses = representationOf(spec, source.name);
  if (!skeleton) skeleton = source.skeleton;
  ReadyClip ready = poses.ready(resampled(source, spec.fps), *skeleton);
  const auto trajectory = rootTrajectory(ready.clip, spec);
  return {.name = ready.clip.name,
          .pose = poses.encode(ready.clip, *skeleton, trajectory),
          .control = encodeControl(spec.control, trajectory, requestOf(ready.clip, spec, skeleton),
                                   spec.fps, placeOf(source)),
          .start = trajectory.front(),
          .fitM = ready.fitM};
}

Clip rebuildMotion(const Matrix& pose, const Matrix& control, const RootFrame& start,
                   std::shared_ptr<const Skeleton> skeleton, const FeatureSpec& spec) {
  const Representation& poses = representationOf(spec, "features");
  const int width = poses.width(*skeleton);
  if (pose.cols() != width || control.cols() < 3 || control.rows() != pose.rows())
    throwInput({.path = "features"},
               fmt::format("poses of {} values and at least 3 controls per frame", width),
               "{} x {} poses, {} x {} controls", pose.rows(), pose.cols(), control.rows(),
               control.cols());
  Clip out = poses.decode(pose, trajectoryFromControl(control, start), std::move(skeleton));
  out.fps = spec.fps;
  return out;
}

FeatureSequence mirrored(const FeatureSequence& in, const FeatureSpec& spec,
                         const Skeleton& skeleton) {
  FeatureSequence out = in;
  out.pose = representationOf(spec, in.name).mirror(in.pose, skeleton);
  out.control = mirroredControl(spec.control, spec.fps, in.control, skeleton);
  out.start = {-in.start.x, in.start.z, -in.start.heading};
  return out;
}

FeatureSequence timeReversed(const FeatureSequence& in, const FeatureSpec& spec) {
  FeatureSequence out = in;
  out.pose = representationOf(spec, in.name).reverse(in.pose);
  const auto trajectory = trajectoryFromControl(in.control, in.start);
  // Backwards, each step is undone; it is expressed in the frame it now starts from.
  std::vector<RootFrame> backwards(trajectory.rbegin(), trajectory.rend());
  out.control = reversedControl(spec.control, spec.fps, in.control, backwards);
  out.start = backwards.front();
  return out;
}

}  // namespace marey
