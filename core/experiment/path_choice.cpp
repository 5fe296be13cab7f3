#include "experiment/path_choice.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "io/annotation_files.h"
#include "io/clip_io.h"
#include "model/training_pace.h"
#include "motion/path.h"
#include "motion/representation/representation.h"
#include "motion/resample.h"

namespace marey {
namespace {

constexpr double kPresetSeconds = 10.0;
constexpr double kQuadrupedScale =
    0.6;  ///< a dog walks the papers' paths at this share of a man's speed

std::vector<WayPoint> wayPointsOf(const PathChoice& choice) {
  return choice.wayPoints.empty() ? readPathFile(choice.folder / choice.path) : choice.wayPoints;
}

bool isPreset(const PathChoice& choice) {
  return choice.wayPoints.empty() && choice.path.starts_with("preset:");
}

std::vector<RootFrame> pathFrames(const PathChoice& choice, double fps, double presetScale) {
  if (isPreset(choice))
    return presetPath(choice.path.substr(7), choice.seconds > 0 ? choice.seconds : kPresetSeconds,
                      fps, presetScale);
  const std::string origin =
      choice.wayPoints.empty() ? (choice.folder / choice.path).string() : choice.path;
  return samplePath(wayPointsOf(choice), fps, origin);
}

bool isClip(const PathChoice& choice) {
  return choice.wayPoints.empty() && choice.path.starts_with("clip:");
}

std::filesystem::path clipFile(const PathChoice& choice) {
  return choice.folder / choice.path.substr(5);
}

/// Ends a path after the seconds asked for.
void shorten(std::vector<RootFrame>& path, const PathChoice& choice, double fps) {
  if (choice.seconds <= 0.0) return;
  const auto wanted = static_cast<size_t>(std::max(2L, std::lround(choice.seconds * fps)));
  if (wanted > path.size() + 1)
    throwInput({.path = choice.path, .item = "--seconds"},
               fmt::format("at most the path's {:.2f} s", static_cast<double>(path.size()) / fps),
               "{} s", choice.seconds);
  path.resize(std::min(wanted, path.size()));
}

Clip onlyClip(const std::filesystem::path& file, io::InputReport& report) {
  std::vector<Clip> clips = report.read({.path = file, .named = true}, {});
  report.throwIfFailed();
  if (clips.size() != 1) throwInput({.path = file.string()}, "one clip", "{} clips", clips.size());
  return std::move(clips.front());
}

/// Far beyond what it has learnt a model gives poses, but no motion.
void addSpeedDoubt(const MotionModel& model, const PathChoice& choice,
                   const std::vector<RootFrame>& path, io::InputReport& report) {
  constexpr double kSlack = 1.1;
  const auto pace = trainingPaceOf(model.info().provenance, model.info().variant);
  if (!pace) return;
  double fastest = 0.0;
  for (size_t t = 1; t < path.size(); ++t)
    fastest = std::max(fastest, std::hypot(path[t].x - path[t - 1].x, path[t].z - path[t - 1].z));
  fastest *= model.info().features.fps;
  if (fastest > kSlack * pace->speedMS.highest)
    report.add({choice.path, "", "too_fast",
                fmt::format("goes at up to {:.2f} m/s; the fastest of the data that the model was "
                            "trained on is {:.2f} m/s (99.5 % of the frames are below)",
                            fastest, pace->speedMS.highest)});
}

/// The labels of way-points, which a type for all of it replaces.
void addLabels(const PathChoice& choice, ControlRequest& control) {
  if (!choice.control.type.empty())
    control.annotations.labels = {{.label = choice.control.type}};
  else if (!isClip(choice) && !isPreset(choice))
    control.annotations.labels = pathLabels(wayPointsOf(choice), choice.path);
}

void addSignals(const ModelInfo& info, const PathChoice& choice, ControlRequest& control) {
  for (const auto& [name, file] : choice.control.signals) {
    const ControlChannel* channel = channelNamed(info.features.control, name);
    if (!channel || channel->kind != ControlKind::Array)
      throw InputError({.path = info.variant},
                       "a signal of the model (" + summaryOf(info.features.control) + ")",
                       "'" + name + "'");
    control.annotations.signals[name] = io::readSignal(choice.folder / file, channel->fps);
  }
}

void addBody(const ModelInfo& info, const PathChoice& choice, ControlRequest& control) {
  if (choice.control.body.empty()) return;
  const std::filesystem::path file = choice.folder / choice.control.body;
  if (!channelOf(info.features.control, ControlKind::Skeleton))
    throw InputError({.path = info.variant}, "a model whose control is a body (for another one)",
                     summaryOf(info.features.control));
  const Clip clip = io::readClip(file);
  requireSameJoints(info, clip, file.string());
  control.body = representationOf(info.features, file.string()).skeletonOf({clip}, info.features);
}

/// What is asked beside the way. A type that the model does not know is refused, labels of
/// way-points that it has no use for are told.
void addControl(const ModelInfo& info, const PathChoice& choice, SampleRequest& request,
                io::InputReport& report) {
  addLabels(choice, request.control);
  addSignals(info, choice, request.control);
  addBody(info, choice, request.control);
  for (const std::string& name : choice.control.leftOut) {
    if (!channelNamed(info.features.control, name))
      throw InputError({.path = info.variant},
                       "a control to leave out (" + summaryOf(info.features.control) + ")",
                       "'" + name + "'");
    request.control.leftOut.insert(name);
  }
  if (channelOf(info.features.control, ControlKind::Label)) return;
  if (!choice.control.type.empty())
    throw InputError({.path = info.variant}, "a model that knows types of motion",
                     "control by " + summaryOf(info.features.control));
  if (!isClip(choice) && !request.control.annotations.labels.empty())
    report.add({choice.path, "", "no_effect", "its types have no effect: the model knows none"});
}

}  // namespace

std::vector<RootFrame> rootFramesOf(const PathChoice& choice, double fps) {
  std::vector<RootFrame> out;
  if (isClip(choice)) {
    const FeatureSpec spec{.fps = fps};
    const auto path = rootPath(resampled(io::readClip(clipFile(choice)), fps), spec);
    out = trajectoryFromControl(controlFromTrajectory(path), path.front());
  } else {
    out = pathFrames(choice, fps, 1.0);
  }
  shorten(out, choice, fps);
  return out;
}

SampleRequest requestFor(const MotionModel& model, const PathChoice& choice) {
  io::InputReport unused;
  return requestFor(model, choice, unused);
}

SampleRequest requestFor(const MotionModel& model, const PathChoice& choice,
                         io::InputReport& report) {
  const double fps = model.info().features.fps;
  SampleRequest out;
  if (isClip(choice)) {
    Clip clip = onlyClip(clipFile(choice), report);
    io::readSignals(clip, model.info().features.control);
    out = requestAlongClip(model, clip, choice.startFromClip);
  } else {
    if (choice.startFromClip) throw UsageError("--start clip: needs a path of the form clip:FILE");
    const bool quadruped = model.info().skeleton && rolesOf(*model.info().skeleton).quadruped;
    out.path = pathFrames(choice, fps, quadruped ? kQuadrupedScale : 1.0);
    if (!isPreset(choice))
      for (const std::string& remark : pathRemarks(wayPointsOf(choice)))
        report.add({choice.path, "", "no_effect", remark});
  }
  shorten(out.path, choice, fps);
  addControl(model.info(), choice, out, report);
  addSpeedDoubt(model, choice, out.path, report);
  return out;
}

}  // namespace marey
