#include "gui/plots/distribution_data.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "motion/main_body.h"
#include "motion/roles.h"
#include "stats/sample_distance.h"

namespace marey::gui {
namespace {
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
/// Frames per set and joint that distances over the whole body are worked out from.
constexpr int kDistanceFrames = 20000;
constexpr int kPoseClips = 50;

/// All joints, pooled over clips: samples[joint].
std::vector<std::vector<double>> bodySamples(const std::vector<Clip>& clips,
                                             stats::Quantity quantity, Progress& progress) {
  int frames = 0;
  for (const Clip& clip : clips) frames += clip.frameCount();
  const int stride = std::max(1, frames / kDistanceFrames);
  std::vector<std::vector<double>> pooled;
  for (const Clip& clip : clips) {
    progress.throwIfCancelled();
    const auto samples = stats::jointSamples(clip, quantity, stride);
    pooled.resize(samples.size());
    for (size_t j = 0; j < samples.size(); ++j)
      pooled[j].insert(pooled[j].end(), samples[j].begin(), samples[j].end());
  }
  return pooled;
}

void addValues(DistributionSet& out, const MotionSet& set, const std::vector<Clip>& inRange,
               const DistributionQuery& query, Progress& progress) {
  out.values.resize(query.joints.size());
  const auto add = [&](const Clip& clip, bool pooled) {
    progress.throwIfCancelled();
    const auto samples = stats::jointSamples(clip, query.quantity);
    for (size_t k = 0; k < query.joints.size(); ++k) {
      const auto joint = static_cast<size_t>(query.joints[k]);
      if (joint >= samples.size()) continue;
      auto& values = out.values[k];
      if (pooled)
        values.pooled.insert(values.pooled.end(), samples[joint].begin(), samples[joint].end());
      else
        values.byMotion.push_back(samples[joint]);
    }
  };
  for (const ClipPtr& clip : set.clips) add(*clip, false);
  if (query.range) {
    for (const Clip& clip : inRange) add(clip, true);
    return;
  }
  for (JointValues& values : out.values)
    for (const auto& run : values.byMotion)
      values.pooled.insert(values.pooled.end(), run.begin(), run.end());
}

std::vector<double> distances(const std::vector<std::vector<double>>& samples,
                              const std::vector<std::vector<double>>& natural) {
  std::vector<double> out(samples.size(), kNaN);
  for (size_t j = 0; j < samples.size() && j < natural.size(); ++j)
    if (!samples[j].empty() && !natural[j].empty())
      out[j] = stats::wasserstein1(samples[j], natural[j]);
  return out;
}

std::vector<Vec3> meanPoseOf(const MotionSet& set) {
  const Clip& first = *set.clips.front();
  std::vector<Vec3> mean(static_cast<size_t>(first.jointCount()), Vec3::Zero());
  if (!rolesOf(*first.skeleton).hasFacing())
    return std::vector<Vec3>(first.frame(0).begin(), first.frame(0).end());
  float frames = 0.0F;
  const size_t count = std::min<size_t>(set.clips.size(), kPoseClips);
  for (size_t i = 0; i < count; ++i) {
    FeatureSpec spec;
    spec.fps = set.clips[i]->fps;
    const Matrix pose = extractFeatures(*set.clips[i], spec).pose;
    for (Eigen::Index t = 0; t < pose.rows(); ++t)
      for (size_t j = 0; j < mean.size(); ++j)
        mean[j] += pose.row(t).segment<3>(3 * static_cast<Eigen::Index>(j)).transpose();
    frames += static_cast<float>(pose.rows());
  }
  for (Vec3& joint : mean) joint /= std::max(1.0F, frames);
  return mean;
}
}  // namespace

DistributionResult distributionResult(const std::vector<MotionSet>& sets,
                                      const DistributionQuery& query, Progress& progress) {
  DistributionResult out{
      .query = query, .skeleton = nullptr, .sets = {}, .leftOut = {}, .meanPose = {}};
  if (sets.empty()) return out;
  out.skeleton = sets.front().clips.front()->skeleton;
  out.meanPose = meanPoseOf(sets.front());
  std::vector<std::vector<double>> natural;
  for (size_t i = 0; i < sets.size(); ++i) {
    const MotionSet& set = sets[i];
    if (!sameJoints(set.body(), sets.front().body())) {
      out.leftOut.push_back(set.name + ": " + otherJoints(set.body(), sets.front().body()));
      continue;
    }
    // Sets are of one body, unless somebody else put them together.
    for (const ClipPtr& clip : set.clips) requireJointsOf(*clip, *set.clips.front());
    const std::vector<Clip> clips = clipsIn(set, query.range).clips;
    if (clips.empty()) continue;
    DistributionSet one{.look = lookOf(set), .fps = set.clips.front()->fps};
    addValues(one, set, clips, query, progress);
    const auto samples = bodySamples(clips, query.quantity, progress);
    if (set.natural)
      natural = samples;
    else
      one.distance = distances(samples, natural);
    out.sets.push_back(std::move(one));
    progress.report(static_cast<double>(i + 1) / static_cast<double>(sets.size()));
  }
  return out;
}

std::vector<DistributionRow> distributionRows(const DistributionResult& result) {
  std::vector<DistributionRow> rows;
  for (size_t k = 0; k < result.query.joints.size(); ++k)
    for (const DistributionSet& set : result.sets) {
      const std::vector<double>& values = set.values[k].pooled;
      if (values.empty()) continue;
      const auto count = static_cast<double>(values.size());
      double sum = 0.0, squares = 0.0;
      for (const double v : values) sum += v;
      for (const double v : values) squares += (v - sum / count) * (v - sum / count);
      const int joint = result.query.joints[k];
      const auto index = static_cast<size_t>(joint);
      rows.push_back({.set = set.look.name,
                      .joint = result.skeleton->names[index],
                      .mean = sum / count,
                      .deviation = std::sqrt(squares / count),
                      .distance = index < set.distance.size() ? set.distance[index] : kNaN,
                      .ids = set.look.ids,
                      .jointIndex = joint});
    }
  return rows;
}

}  // namespace marey::gui
