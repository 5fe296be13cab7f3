#include "motion/control/encode_control.h"

#include <algorithm>
#include <cctype>
#include <cmath>

#include "base/error.h"
#include "motion/representation/rest_pose.h"

namespace marey {
namespace {

/// A root frame between two, `u` of the way; the heading is not needed.
Eigen::Vector2d between(const RootFrame& a, const RootFrame& b, double u) {
  return {a.x + u * (b.x - a.x), a.z + u * (b.z - a.z)};
}

/// Root frames after the end: the last step again and again.
std::vector<RootFrame> prolonged(const std::vector<RootFrame>& trajectory, long frames) {
  std::vector<RootFrame> out = trajectory;
  if (trajectory.size() < 2 || frames == 0) {
    out.resize(trajectory.size() + static_cast<size_t>(frames), trajectory.back());
    return out;
  }
  const Matrix step = controlFromTrajectory({trajectory.end() - 2, trajectory.end()});
  Matrix steps(frames + 1, 3);
  for (long i = 0; i <= frames; ++i) steps.row(i) = step.row(1);
  const auto after = trajectoryFromControl(steps, trajectory.back());
  out.insert(out.end(), after.begin() + 1, after.end());
  return out;
}

void encodePath(const ControlColumns& at, const std::vector<RootFrame>& trajectory, double fps,
                Matrix& out) {
  const auto& ahead = at.channel->aheadS;
  const double longest = *std::max_element(ahead.begin(), ahead.end());
  const auto way = prolonged(trajectory, static_cast<long>(std::ceil(longest * fps)) + 1);
  for (long t = 0; t < out.rows(); ++t) {
    const RootFrame& from = way[static_cast<size_t>(t)];
    const double c = std::cos(from.heading), s = std::sin(from.heading);
    for (size_t i = 0; i < ahead.size(); ++i) {
      const double frame = static_cast<double>(t) + ahead[i] * fps;
      const auto whole = static_cast<size_t>(std::floor(frame));
      const Eigen::Vector2d point = between(way[whole], way[whole + 1], frame - std::floor(frame));
      const double dx = point.x() - from.x, dz = point.y() - from.z;
      const long column = at.first + 2 * static_cast<long>(i);
      out(t, column) = static_cast<float>(c * dx - s * dz);
      out(t, column + 1) = static_cast<float>(s * dx + c * dz);
    }
  }
}

int indexOfLabel(const ControlChannel& channel, const std::string& label, const Place& place) {
  const auto found = std::find(channel.values.begin(), channel.values.end(), label);
  if (found != channel.values.end()) return static_cast<int>(found - channel.values.begin());
  std::string known;
  for (const std::string& value : channel.values) known += (known.empty() ? "" : ", ") + value;
  throw InputError(place, channel.name + " one of " + known, "'" + label + "'");
}

/// Marks what is there, or refuses what is not and must be.
void setPresence(const ControlColumns& at, long frame, bool present, const Place& place,
                 Matrix& out) {
  if (at.presence >= 0) {
    out(frame, at.presence) = present ? 1.F : 0.F;
    return;
  }
  if (present) return;
  Place here = place;
  here.frame = frame + 1;
  throw InputError(
      here, fmt::format("control '{}' ({})", at.channel->name, summaryOf({*at.channel})), "none");
}

void encodeLabels(const ControlColumns& at, const std::vector<LabelSpan>& labels, double fps,
                  const Place& place, Matrix& out) {
  const Matrix weights = labelWeights(*at.channel, labels, out.rows(), fps, place);
  out.middleCols(at.first, at.width) = weights;
  for (long t = 0; t < out.rows(); ++t)
    setPresence(at, t, weights.row(t).maxCoeff() > 0.F, place, out);
}

void encodeSignal(const ControlColumns& at, const Signal& signal, double fps, const Place& place,
                  Matrix& out) {
  const ControlChannel& channel = *at.channel;
  if (signal.width() != static_cast<int>(channel.values.size()))
    throwInput(place,
               fmt::format("{} columns of control '{}'", channel.values.size(), channel.name), "{}",
               signal.width());
  if (signal.rows() == 0) throwInput(place, "rows of control '" + channel.name + "'", "none");
  const int past = pastFrames(channel, fps), future = futureFrames(channel, fps);
  Signal shifted = signal;
  shifted.startS += past / fps;
  const Matrix values = signalAt(shifted, out.rows() + past + future, fps);
  const long width = signal.width();
  for (int k = 0; k <= past + future; ++k)
    out.middleCols(at.first + k * width, width) = values.middleRows(k, out.rows());
  for (long t = 0; t < out.rows(); ++t) setPresence(at, t, true, place, out);
}

void encodeBody(const ControlColumns& at, const Skeleton& body, const Place& place, Matrix& out) {
  if (body.jointCount() != at.channel->joints)
    throwInput(place, fmt::format("a body of {} joints", at.channel->joints), "{}",
               body.jointCount());
  const auto values = restPoseControl(body);
  out.middleCols(at.first, at.width) =
      Eigen::Map<const Eigen::RowVectorXf>(values.data(), at.width).replicate(out.rows(), 1);
}

void encodeChannel(const ControlColumns& at, const std::vector<RootFrame>& trajectory,
                   const ControlRequest& request, double fps, const Place& place, Matrix& out) {
  const ControlChannel& channel = *at.channel;
  const auto absent = [&] {
    for (long t = 0; t < out.rows(); ++t) setPresence(at, t, false, place, out);
  };
  if (request.leftOut.contains(channel.name)) return absent();
  switch (channel.kind) {
    case ControlKind::RootMotion:
      out.middleCols(at.first, 3) = controlFromTrajectory(trajectory);
      return;
    case ControlKind::Label:
      return encodeLabels(at, request.annotations.labels, fps, place, out);
    case ControlKind::Array: {
      const auto found = request.annotations.signals.find(channel.name);
      if (found == request.annotations.signals.end()) return absent();
      return encodeSignal(at, found->second, fps, place, out);
    }
    case ControlKind::FuturePath:
      encodePath(at, trajectory, fps, out);
      break;
    case ControlKind::Skeleton:
      if (!request.body) return absent();
      encodeBody(at, *request.body, place, out);
      break;
  }
  for (long t = 0; t < out.rows(); ++t) setPresence(at, t, true, place, out);
}

}  // namespace

Matrix encodeControl(const ControlLayout& layout, const std::vector<RootFrame>& trajectory,
                     const ControlRequest& request, double fps, const Place& place) {
  const auto columns = columnsOf(layout, fps);
  Matrix out = Matrix::Zero(static_cast<long>(trajectory.size()), widthOf(layout, fps));
  if (out.rows() == 0) return out;
  for (const std::string& name : request.leftOut)
    if (!channelNamed(layout, name))
      throw InputError(place, "a control that the model has: " + summaryOf(layout),
                       "'" + name + "' left out");
  for (const ControlColumns& at : columns) encodeChannel(at, trajectory, request, fps, place, out);
  return out;
}

std::vector<bool> presenceOf(const ControlColumns& columns, const Matrix& control) {
  std::vector<bool> out(static_cast<size_t>(control.rows()), true);
  if (columns.presence < 0) return out;
  for (size_t t = 0; t < out.size(); ++t)
    out[t] = control(static_cast<long>(t), columns.presence) != 0.F;
  return out;
}

void fillAbsent(const ControlLayout& layout, double fps, const std::vector<float>& mean,
                Matrix& control) {
  if (mean.empty()) return;
  for (const ControlColumns& at : columnsOf(layout, fps)) {
    if (at.presence < 0) continue;
    const Eigen::Map<const Eigen::RowVectorXf> means(mean.data() + at.first, at.width);
    const auto present = presenceOf(at, control);
    for (size_t t = 0; t < present.size(); ++t)
      if (!present[t]) control.row(static_cast<long>(t)).segment(at.first, at.width) = means;
  }
}

namespace {

/// Spans by their start, checked.
std::vector<LabelSpan> ordered(std::vector<LabelSpan> spans, const Place& place) {
  std::stable_sort(spans.begin(), spans.end(),
                   [](const LabelSpan& a, const LabelSpan& b) { return a.fromS < b.fromS; });
  for (size_t i = 0; i < spans.size(); ++i) {
    if (!(spans[i].toS > spans[i].fromS))
      throwInput(place, "labels that end after they begin", "'{}' from {} to {} s", spans[i].label,
                 spans[i].fromS, spans[i].toS);
    if (i > 0 && spans[i].fromS < spans[i - 1].toS - 1e-9)
      throwInput(place, "labels that do not overlap", "'{}' from {} s, '{}' up to {} s",
                 spans[i].label, spans[i].fromS, spans[i - 1].label, spans[i - 1].toS);
  }
  return spans;
}

/// When the change from one span to the next begins and ends.
std::pair<double, double> changeBetween(const LabelSpan& from, const LabelSpan& to,
                                        double transitionS) {
  const bool gap = to.fromS > from.toS + 1e-9;
  return gap ? std::pair{from.toS, to.fromS} : std::pair{to.fromS, to.fromS + transitionS};
}

}  // namespace

Matrix labelWeights(const ControlChannel& channel, const std::vector<LabelSpan>& labels,
                    long frames, double fps, const Place& place) {
  constexpr double kSlackS = 1e-9;
  const auto spans = ordered(labels, place);
  std::vector<int> index;
  for (const LabelSpan& span : spans) index.push_back(indexOfLabel(channel, span.label, place));
  Matrix out = Matrix::Zero(frames, static_cast<long>(channel.values.size()));
  for (long t = 0; t < frames; ++t) {
    const double time = static_cast<double>(t) / fps + kSlackS;
    size_t now = spans.size();  // the last that has begun
    for (size_t i = 0; i < spans.size() && spans[i].fromS <= time; ++i) now = i;
    if (now == spans.size()) continue;
    const bool last = now + 1 == spans.size();
    if (time >= spans[now].toS && last) continue;
    if (time >= spans[now].toS) {  // in a gap
      const auto [begin, end] = changeBetween(spans[now], spans[now + 1], 0.0);
      const double share = std::clamp((time - begin) / (end - begin), 0.0, 1.0);
      out(t, index[now]) += static_cast<float>(1.0 - share);
      out(t, index[now + 1]) += static_cast<float>(share);
      continue;
    }
    double share = 1.0;
    if (now > 0 && spans[now].fromS <= spans[now - 1].toS + kSlackS && channel.transitionS > 0.0)
      share = std::min(1.0, (time - spans[now].fromS) / channel.transitionS);
    out(t, index[now]) += static_cast<float>(share);
    if (share < 1.0) out(t, index[now - 1]) += static_cast<float>(1.0 - share);
  }
  return out;
}

Matrix signalAt(const Signal& signal, long frames, double fps) {
  const long width = signal.width(), rows = signal.rows();
  const Eigen::Map<const Matrix> values(signal.values.data(), rows, width);
  const double perFrame = signal.fps / fps;
  Matrix out(frames, width);
  for (long t = 0; t < frames; ++t) {
    const double at = (static_cast<double>(t) / fps - signal.startS) * signal.fps;
    if (perFrame > 1.0 + 1e-6) {  // several rows in a frame's time
      const long first =
          std::clamp(std::lround(std::ceil(at - 0.5 * perFrame - 1e-6)), 0L, rows - 1);
      const long last =
          std::clamp(std::lround(std::ceil(at + 0.5 * perFrame - 1e-6)) - 1, first, rows - 1);
      out.row(t) = values.middleRows(first, last - first + 1).colwise().mean();
      continue;
    }
    const double inside = std::clamp(at, 0.0, static_cast<double>(rows - 1));
    const auto whole = std::min(static_cast<long>(inside + 1e-9), rows - 1);
    const auto rest = static_cast<float>(std::max(0.0, inside - static_cast<double>(whole)));
    const long next = std::min(whole + 1, rows - 1);
    out.row(t) =
        rest < 1e-6F
            ? Eigen::RowVectorXf(values.row(whole))
            : Eigen::RowVectorXf((1.F - rest) * values.row(whole) + rest * values.row(next));
  }
  return out;
}

std::string labelInName(const ControlChannel& channel, const std::string& name) {
  const auto lower = [](std::string text) {
    std::transform(text.begin(), text.end(), text.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return text;
  };
  const auto isLetter = [](char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0; };
  const std::string in = lower(name);
  std::string best;
  for (const std::string& label : channel.values) {
    const std::string word = lower(label);
    for (size_t at = in.find(word); at != std::string::npos; at = in.find(word, at + 1)) {
      const size_t end = at + word.size();
      if ((at > 0 && isLetter(in[at - 1])) || (end < in.size() && isLetter(in[end]))) continue;
      if (label.size() > best.size()) best = label;
    }
  }
  return best;
}

std::vector<float> restPoseControl(const Skeleton& skeleton) {
  const auto local = restRotations(skeleton);
  std::vector<Quatd> turns;
  std::vector<Eigen::Vector3d> joints;
  double lowest = 0.0;
  for (int j = 0; j < skeleton.jointCount(); ++j) {
    const auto i = static_cast<size_t>(j);
    const int parent = skeleton.parents[i];
    if (parent < 0) {
      turns.push_back(local[i]);
      joints.emplace_back(Eigen::Vector3d::Zero());
      continue;
    }
    const auto p = static_cast<size_t>(parent);
    joints.emplace_back(joints[p] + turns[p] * skeleton.offsets[i].cast<double>());
    turns.push_back(turns[p] * local[i]);
    lowest = std::min(lowest, joints.back().y());
  }
  std::vector<float> out;
  for (const Eigen::Vector3d& joint : joints)
    for (int k = 0; k < 3; ++k) out.push_back(static_cast<float>(joint[k]));
  out.push_back(static_cast<float>(-lowest));
  return out;
}

}  // namespace marey
