#include "plots/diversity_data.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "stats/diversity.h"

namespace marey::gui {
namespace {
constexpr int kCompared = 48;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

std::vector<Matrix> rootFramePoses(const std::vector<ClipPtr>& clips, Progress& progress) {
  std::vector<Matrix> poses;
  const Clip& first = *clips.front();
  for (const int i : stats::spreadIndices(static_cast<int>(clips.size()), kCompared)) {
    progress.throwIfCancelled();
    const Clip& clip = *clips[static_cast<size_t>(i)];
    if (clip.jointCount() != first.jointCount() || clip.fps != first.fps)
      throwInput(
          {.path = clip.name},
          fmt::format("{} joints at {} fps as the other motions", first.jointCount(), first.fps),
          "{} at {} fps", clip.jointCount(), clip.fps);
    FeatureSpec spec;
    spec.fps = clip.fps;
    poses.push_back(extractFeatures(clip, spec).pose);
  }
  return poses;
}

double meanPairCm(const std::vector<Matrix>& poses, Eigen::Index t) {
  double sum = 0.0;
  int pairs = 0;
  for (size_t i = 0; i < poses.size(); ++i)
    for (size_t j = i + 1; j < poses.size(); ++j) {
      if (t >= poses[i].rows() || t >= poses[j].rows()) continue;
      const double joints = static_cast<double>(poses[i].cols()) / 3.0;
      const auto squared = static_cast<double>((poses[i].row(t) - poses[j].row(t)).squaredNorm());
      sum += 100.0 * std::sqrt(squared / joints);
      ++pairs;
    }
  return pairs > 0 ? sum / pairs : kNaN;
}
}  // namespace

std::vector<DiversityCurve> diversityCurves(const std::vector<MotionSet>& sets,
                                            Progress& progress) {
  std::vector<DiversityCurve> out;
  for (size_t s = 0; s < sets.size(); ++s) {
    if (sets[s].clips.size() < 2) continue;
    const std::vector<Matrix> poses = rootFramePoses(sets[s].clips, progress);
    DiversityCurve curve{.look = lookOf(sets[s]),
                         .fps = sets[s].clips.front()->fps,
                         .compared = static_cast<int>(poses.size())};
    Eigen::Index frames = 0;
    for (const Matrix& pose : poses) frames = std::max(frames, pose.rows());
    for (Eigen::Index t = 0; t < frames; ++t) {
      progress.throwIfCancelled();
      curve.distanceCm.push_back(meanPairCm(poses, t));
    }
    // Beyond the second-longest motion there is no pair.
    while (!curve.distanceCm.empty() && std::isnan(curve.distanceCm.back()))
      curve.distanceCm.pop_back();
    out.push_back(std::move(curve));
    progress.report(static_cast<double>(s + 1) / static_cast<double>(sets.size()));
  }
  return out;
}

double meanInRange(const DiversityCurve& curve, const std::optional<TimeRange>& range) {
  double sum = 0.0;
  int count = 0;
  for (size_t t = 0; t < curve.distanceCm.size(); ++t) {
    const double time = static_cast<double>(t) / curve.fps;
    if (range && (time < range->beginS || time > range->endS)) continue;
    if (!std::isfinite(curve.distanceCm[t])) continue;
    sum += curve.distanceCm[t];
    ++count;
  }
  return count > 0 ? sum / count : kNaN;
}

LinkedGrid diversityGrid(const std::vector<DiversityCurve>& curves) {
  LinkedGrid out{.grid = render::single({})};
  render::Chart& chart = out.grid.charts.front();
  chart.x = {.label = "time", .unit = "s"};
  chart.y = {.label = "mean distance of pairs", .unit = "cm"};
  for (const DiversityCurve& curve : curves) {
    std::vector<double> x;
    for (size_t t = 0; t < curve.distanceCm.size(); ++t)
      x.push_back(static_cast<double>(t) / curve.fps);
    out.add(curve.look.line(std::move(x), curve.distanceCm), curve.look.ids);
  }
  return out;
}

}  // namespace marey::gui
