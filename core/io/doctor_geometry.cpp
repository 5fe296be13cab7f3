#include <algorithm>
#include <cmath>
#include <set>

#include "base/quantile.h"
#include "io/doctor_checks.h"

namespace marey::io {
namespace {

/// A planted foot does not rise more; a swinging one passes higher. Paws swing lower.
constexpr float kNearFloorM = 0.025f;
constexpr float kPawNearFloorM = 0.01f;
constexpr double kSkateMS = 0.5;
/// Of the frames that must agree on where left is.
constexpr double kClearShare = 0.65;
constexpr double kLowQuantile = 0.05;

/// The feet and all joints below them.
std::set<int> footJoints(const Skeleton& s, const SkeletonRoles& roles) {
  std::set<int> out(roles.feet.begin(), roles.feet.end());
  for (int j = 0; j < s.jointCount(); ++j)
    if (out.contains(s.parents[static_cast<size_t>(j)])) out.insert(j);
  return out;
}

std::vector<double> heights(const Clip& clip, int joint) {
  std::vector<double> out(static_cast<size_t>(clip.frameCount()));
  for (int t = 0; t < clip.frameCount(); ++t) out[static_cast<size_t>(t)] = clip.at(t, joint).y();
  return out;
}

/// Frames in which a joint is at most `near` above the 5 % quantile of its height.
std::vector<char> lowFrames(const Clip& clip, int joint, float near) {
  const std::vector<double> height = heights(clip, joint);
  const double limit = quantile(height, kLowQuantile) + static_cast<double>(near);
  std::vector<char> out;
  for (const double y : height) out.push_back(y <= limit ? 1 : 0);
  return out;
}

Vec3 horizontal(const Vec3& v) {
  return {v.x(), 0.0f, v.z()};
}

int firstChild(const Skeleton& s, int joint) {
  const auto it = std::find(s.parents.begin(), s.parents.end(), joint);
  return it == s.parents.end() ? -1 : static_cast<int>(it - s.parents.begin());
}

struct Forward {
  enum class From { Feet, Spine, Movement } from = From::Movement;
  int neck = -1;
  std::vector<std::pair<int, int>> feet;  ///< ankle, toe
};

Forward forwardOf(const Skeleton& s, const SkeletonRoles& roles) {
  Forward out;
  out.neck = s.find("Neck");
  if (roles.quadruped && out.neck >= 0) {
    out.from = Forward::From::Spine;
    return out;
  }
  for (const int foot : roles.feet)
    if (const int toe = firstChild(s, foot); toe >= 0) out.feet.emplace_back(foot, toe);
  if (!out.feet.empty()) out.from = Forward::From::Feet;
  return out;
}

Vec3 forwardAt(const Clip& clip, const SkeletonRoles& roles, const Forward& forward, int t) {
  if (forward.from == Forward::From::Spine)
    return horizontal(clip.at(t, forward.neck) - clip.at(t, roles.hips));
  if (forward.from == Forward::From::Movement)
    return t == 0 ? Vec3(Vec3::Zero())
                  : horizontal(clip.at(t, roles.hips) - clip.at(t - 1, roles.hips));
  // The lower foot: one that swings behind the body points anywhere.
  const auto lower = std::min_element(forward.feet.begin(), forward.feet.end(),
                                      [&clip, t](const auto& a, const auto& b) {
                                        return clip.at(t, a.first).y() < clip.at(t, b.first).y();
                                      });
  return horizontal(clip.at(t, lower->second) - clip.at(t, lower->first));
}

}  // namespace

std::optional<double> floorHeight(const Clip& clip, const SkeletonRoles& roles) {
  if (roles.feet.empty()) return std::nullopt;
  const std::set<int> feet = footJoints(*clip.skeleton, roles);
  std::vector<double> lowest(static_cast<size_t>(clip.frameCount()), INFINITY);
  for (int t = 0; t < clip.frameCount(); ++t)
    for (const int j : feet)
      lowest[static_cast<size_t>(t)] =
          std::min(lowest[static_cast<size_t>(t)], static_cast<double>(clip.at(t, j).y()));
  return quantile(std::move(lowest), kLowQuantile);
}

std::optional<double> footSkateShare(const Clip& clip, const SkeletonRoles& roles) {
  if (roles.feet.empty() || clip.frameCount() < 2) return std::nullopt;
  const float near = roles.quadruped ? kPawNearFloorM : kNearFloorM;
  long low = 0, sliding = 0;
  for (const int foot : roles.feet) {
    const int toe = firstChild(*clip.skeleton, foot);
    const std::vector<char> footLow = lowFrames(clip, foot, near);
    const std::vector<char> toeLow = toe < 0 ? footLow : lowFrames(clip, toe, near);
    for (size_t t = 1; t < footLow.size(); ++t) {
      if ((footLow[t] & footLow[t - 1] & toeLow[t] & toeLow[t - 1]) == 0) continue;
      ++low;
      const auto frame = static_cast<int>(t);
      const double step = horizontal(clip.at(frame, foot) - clip.at(frame - 1, foot)).norm();
      if (step * clip.fps > kSkateMS) ++sliding;
    }
  }
  if (low == 0) return std::nullopt;
  return static_cast<double>(sliding) / static_cast<double>(low);
}

BoneDrift boneDrift(const Clip& clip) {
  BoneDrift out;
  for (const auto& [parent, child] : clip.skeleton->bones()) {
    double mean = 0.0, squares = 0.0;
    for (int t = 0; t < clip.frameCount(); ++t) {
      const double length = (clip.at(t, child) - clip.at(t, parent)).cast<double>().norm();
      const double before = mean;
      mean += (length - mean) / (t + 1);
      squares += (length - before) * (length - mean);
    }
    const double deviation = std::sqrt(squares / clip.frameCount());
    if (deviation <= out.maxStdM && !out.bone.empty()) continue;
    out.maxStdM = deviation;
    out.bone = clip.skeleton->names[static_cast<size_t>(parent)] + "-" +
               clip.skeleton->names[static_cast<size_t>(child)];
  }
  return out;
}

Finding sidesByGeometry(const Clip& clip, const SkeletonRoles& roles) {
  if (!roles.hasFacing()) return {"unknown", "no left and right hip known by name"};
  const Forward forward = forwardOf(*clip.skeleton, roles);
  constexpr float kLeastStepM = 0.002f;  // standing still says nothing of a direction
  const float least = forward.from == Forward::From::Movement ? kLeastStepM : 1e-6f;
  long right = 0, seen = 0;
  for (int t = 0; t < clip.frameCount(); ++t) {
    const Vec3 ahead = forwardAt(clip, roles, forward, t);
    const Vec3 across = horizontal(clip.at(t, roles.leftHip) - clip.at(t, roles.rightHip));
    if (!(ahead.norm() > least) || !(across.norm() > 1e-6f)) continue;
    ++seen;
    if (Vec3::UnitY().cross(ahead).dot(across) > 0.0f) ++right;
  }
  static constexpr const char* sources[] = {"ankle-to-toe", "hips-to-neck", "movement"};
  const char* source = sources[static_cast<int>(forward.from)];
  if (seen == 0) return {"unknown", fmt::format("no {} direction in any frame", source)};
  const double share = static_cast<double>(right) / static_cast<double>(seen);
  const char* verdict = share > kClearShare         ? "as named"
                        : share < 1.0 - kClearShare ? "swapped"
                                                    : "unknown";
  return {verdict,
          fmt::format("the left hip is on the left of the {} direction in {:.0f} % of {} frames",
                      source, 100.0 * share, seen)};
}

std::string skeletonKind(const Skeleton& s, const SkeletonRoles& roles) {
  const std::string body = roles.quadruped      ? "quadruped"
                           : roles.feet.empty() ? "skeleton without known feet"
                                                : "biped";
  const auto starts = [&s](const char* prefix) {
    return std::any_of(s.names.begin(), s.names.end(),
                       [prefix](const std::string& n) { return n.starts_with(prefix); });
  };
  if (starts("mixamorig")) return "Mixamo " + body;
  if (s.find("lfemur") >= 0) return "CMU (ASF names) " + body;
  if (s.find("LHipJoint") >= 0) return "CMU " + body;
  if (s.find("UpperLeg_L") >= 0 && s.find("Shoulder_L") >= 0) return "Bandai-Namco " + body;
  if (s.find("LeftUpLeg") >= 0) return body + " with Mixamo-like names";
  return body;
}

}  // namespace marey::io
