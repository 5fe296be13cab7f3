#include "stats/joint_samples.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/error.h"
#include "motion/features.h"

namespace marey::stats {
namespace {

using Eigen::Vector3d;

Vector3d positionAt(const Clip& clip, int t, int joint) {
  return clip.at(t, joint).cast<double>();
}

int firstChild(const Skeleton& skeleton, int joint) {
  const auto it = std::find(skeleton.parents.begin(), skeleton.parents.end(), joint);
  return it == skeleton.parents.end() ? -1 : static_cast<int>(it - skeleton.parents.begin());
}

double speedCmS(const Clip& clip, int t, int joint) {
  return 100.0 * clip.fps * (positionAt(clip, t, joint) - positionAt(clip, t - 1, joint)).norm();
}

double bendDegrees(const Clip& clip, int t, int joint) {
  const Vector3d in =
      positionAt(clip, t, joint) - positionAt(clip, t, clip.skeleton->parents[joint]);
  const Vector3d on =
      positionAt(clip, t, firstChild(*clip.skeleton, joint)) - positionAt(clip, t, joint);
  // The angle of two vectors without the loss of accuracy of acos near 0.
  return std::atan2(in.cross(on).norm(), in.dot(on)) * 180.0 / std::numbers::pi;
}

double inRootFrameCm(const Clip& clip, const RootFrame& root, Quantity quantity, int t, int joint) {
  const Vector3d p = positionAt(clip, t, joint);
  const double dx = p.x() - root.x;
  const double dz = p.z() - root.z;
  const double s = std::sin(root.heading);
  const double c = std::cos(root.heading);
  return 100.0 * (quantity == Quantity::Sideways ? c * dx - s * dz : s * dx + c * dz);
}

}  // namespace

const QuantityText& textOf(Quantity quantity) {
  static const std::vector<QuantityText> texts = {
      {"speed", "cm/s"}, {"height", "cm"}, {"sideways", "cm"}, {"forward", "cm"}, {"angle", "deg"}};
  return texts[static_cast<size_t>(quantity)];
}

const std::vector<Quantity>& allQuantities() {
  static const std::vector<Quantity> list = {Quantity::Speed, Quantity::Height, Quantity::Sideways,
                                             Quantity::Forward, Quantity::Angle};
  return list;
}

bool isDefined(const Skeleton& skeleton, Quantity quantity, int joint) {
  if (joint < 0 || joint >= skeleton.jointCount()) return false;
  if (quantity != Quantity::Angle) return true;
  return skeleton.parents[joint] >= 0 && firstChild(skeleton, joint) >= 0;
}

std::vector<std::vector<double>> jointSamples(const Clip& clip, Quantity quantity, int stride,
                                              int phase) {
  std::vector<std::vector<double>> out(static_cast<size_t>(clip.jointCount()));
  std::vector<RootFrame> roots;
  if (quantity == Quantity::Sideways || quantity == Quantity::Forward)
    roots = rootTrajectory(clip, {});
  const int first = quantity == Quantity::Speed ? 1 : 0;
  for (int joint = 0; joint < clip.jointCount(); ++joint) {
    if (!isDefined(*clip.skeleton, quantity, joint)) continue;
    for (int t = first + phase; t < clip.frameCount(); t += std::max(1, stride)) {
      double value = 0.0;
      if (quantity == Quantity::Speed)
        value = speedCmS(clip, t, joint);
      else if (quantity == Quantity::Height)
        value = 100.0 * clip.at(t, joint).y();
      else if (quantity == Quantity::Angle)
        value = bendDegrees(clip, t, joint);
      else
        value = inRootFrameCm(clip, roots[t], quantity, t, joint);
      out[joint].push_back(value);
    }
  }
  return out;
}

std::vector<double> pooledSamples(const std::vector<Clip>& clips, Quantity quantity, int joint) {
  std::vector<double> out;
  for (const Clip& clip : clips) {
    if (!isDefined(*clip.skeleton, quantity, joint))
      throwInput({.path = clip.name}, "a joint where the " + textOf(quantity).name + " is defined",
                 "joint {}", joint);
    const auto samples = jointSamples(clip, quantity);
    out.insert(out.end(), samples[joint].begin(), samples[joint].end());
  }
  return out;
}

}  // namespace marey::stats
