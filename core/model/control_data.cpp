#include "model/control_data.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "base/error.h"
#include "motion/representation/representation.h"

namespace marey {
namespace {

/// Offsets that differ by less are those of one body, metres.
constexpr float kSameBodyM = 1e-4F;

bool sameBody(const Skeleton& a, const Skeleton& b) {
  return a.offsets.size() == b.offsets.size() &&
         std::equal(a.offsets.begin(), a.offsets.end(), b.offsets.begin(),
                    [](const auto& x, const auto& y) { return (x - y).norm() < kSameBodyM; });
}

std::vector<std::string> labelsOf(const std::vector<Clip>& clips, const std::string& channel) {
  std::set<std::string> out;
  for (const Clip& clip : clips)
    for (const LabelSpan& span : clip.annotations.labels) out.insert(span.label);
  if (out.size() < 2)
    throwInput({.path = "training clips", .item = "control '" + channel + "'"},
               "at least two labels in the label files beside them", "{}", out.size());
  return {out.begin(), out.end()};
}

std::vector<std::string> columnsOfSignal(const std::vector<Clip>& clips,
                                         const std::string& channel) {
  for (const Clip& clip : clips)
    if (const auto found = clip.annotations.signals.find(channel);
        found != clip.annotations.signals.end())
      return found->second.columns;
  throw InputError({.path = "training clips", .item = "control '" + channel + "'"},
                   "a signal of that name beside at least one", "none");
}

/// Rows of some columns that count.
using Rows = std::vector<Matrix>;

Moments momentsOf(const Rows& rows, long width) {
  Eigen::RowVectorXd sum = Eigen::RowVectorXd::Zero(width), squares = sum;
  double n = 0.0;
  for (const Matrix& m : rows) {
    sum += m.cast<double>().colwise().sum();
    n += static_cast<double>(m.rows());
  }
  if (n == 0.0)
    return {std::vector<float>(static_cast<size_t>(width), 0.F),
            std::vector<float>(static_cast<size_t>(width), 1.F)};
  const Eigen::RowVectorXd mean = sum / n;
  for (const Matrix& m : rows)
    squares += (m.cast<double>().rowwise() - mean).array().square().matrix().colwise().sum();
  Moments out;
  for (long i = 0; i < width; ++i) {
    const double deviation = std::sqrt(squares(i) / n);
    out.mean.push_back(static_cast<float>(mean(i)));
    out.std.push_back(deviation > 1e-6 ? static_cast<float>(deviation) : 1.F);
  }
  return out;
}

/// A channel's values in the frames in which it is there.
Rows presentRows(const std::vector<FeatureSequence>& sequences, const ControlColumns& at) {
  Rows out;
  for (const FeatureSequence& s : sequences) {
    const auto present = presenceOf(at, s.control);
    Matrix rows(std::count(present.begin(), present.end(), true), at.width);
    long row = 0;
    for (size_t t = 0; t < present.size(); ++t)
      if (present[t])
        rows.row(row++) = s.control.row(static_cast<long>(t)).segment(at.first, at.width);
    out.push_back(std::move(rows));
  }
  return out;
}

}  // namespace

ControlLayout completedLayout(ControlLayout layout, const std::vector<Clip>& clips) {
  for (ControlChannel& channel : layout) {
    if (channel.kind == ControlKind::Label && channel.values.empty())
      channel.values = labelsOf(clips, channel.name);
    if (channel.kind == ControlKind::Array && channel.values.empty())
      channel.values = columnsOfSignal(clips, channel.name);
    if (channel.kind == ControlKind::Skeleton && channel.joints == 0)
      channel.joints = clips.front().jointCount();
  }
  validate(layout, "data set");
  return layout;
}

Bodies::Bodies(const std::vector<Clip>& train, const std::vector<Clip>& test,
               const FeatureSpec& spec) {
  if (!channelOf(spec.control, ControlKind::Skeleton)) return;
  const Representation& poses = representationOf(spec, "data set");
  std::vector<const Clip*> all;
  for (const auto* clips : {&train, &test})
    for (const Clip& clip : *clips) all.push_back(&clip);
  for (const Clip* clip : all) {
    if (of(*clip)) continue;
    std::vector<Clip> ofBody;
    for (const Clip* other : all)
      if (sameBody(*other->skeleton, *clip->skeleton)) ofBody.push_back(*other);
    m_bodies.emplace_back(clip->skeleton, poses.skeletonOf(ofBody, spec));
  }
}

std::shared_ptr<const Skeleton> Bodies::of(const Clip& clip) const {
  for (const auto& [own, body] : m_bodies)
    if (sameBody(*own, *clip.skeleton)) return body;
  return nullptr;
}

Moments poseMoments(const std::vector<FeatureSequence>& sequences) {
  Rows rows;
  for (const FeatureSequence& s : sequences) rows.push_back(s.pose);
  return momentsOf(rows, sequences.front().pose.cols());
}

Moments controlMoments(const std::vector<FeatureSequence>& sequences, const FeatureSpec& spec) {
  const auto width = static_cast<size_t>(sequences.front().control.cols());
  Moments out{std::vector<float>(width, 0.F), std::vector<float>(width, 1.F)};
  for (const ControlColumns& at : columnsOf(spec.control, spec.fps)) {
    if (at.channel->kind == ControlKind::Label) continue;
    const Moments own = momentsOf(presentRows(sequences, at), at.width);
    std::copy(own.mean.begin(), own.mean.end(), out.mean.begin() + at.first);
    std::copy(own.std.begin(), own.std.end(), out.std.begin() + at.first);
  }
  return out;
}

}  // namespace marey
