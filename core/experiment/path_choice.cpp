#include "experiment/path_choice.h"

#include <cmath>

#include "base/error.h"
#include "io/clip_io.h"
#include "motion/path.h"

namespace marey {
namespace {

constexpr double kPresetSeconds = 10.0;
constexpr double kQuadrupedScale =
    0.6;  ///< a dog walks the papers' paths at this share of a man's speed

std::vector<RootFrame> pathFrames(const PathChoice& choice, double fps, double presetScale) {
  if (!choice.wayPoints.empty()) return samplePath(choice.wayPoints, fps, choice.path);
  if (choice.path.starts_with("preset:"))
    return presetPath(choice.path.substr(7), choice.seconds > 0 ? choice.seconds : kPresetSeconds,
                      fps, presetScale);
  const auto file = choice.folder / choice.path;
  return samplePath(readPathFile(file), fps, file.string());
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

}  // namespace

std::vector<RootFrame> rootFramesOf(const PathChoice& choice, double fps) {
  std::vector<RootFrame> out;
  if (isClip(choice)) {
    const FeatureSpec spec{.fps = fps};
    const FeatureSequence features = extractFeatures(io::readClip(clipFile(choice)), spec);
    out = trajectoryFromControl(features.control, features.start);
  } else {
    out = pathFrames(choice, fps, 1.0);
  }
  shorten(out, choice, fps);
  return out;
}

SampleRequest requestFor(const MotionModel& model, const PathChoice& choice) {
  const double fps = model.info().features.fps;
  SampleRequest out;
  if (isClip(choice)) {
    out = requestAlongClip(model, io::readClip(clipFile(choice)), choice.startFromClip);
  } else {
    if (choice.startFromClip) throw UsageError("--start clip: needs a path of the form clip:FILE");
    const bool quadruped = model.info().skeleton && rolesOf(*model.info().skeleton).quadruped;
    out.path = pathFrames(choice, fps, quadruped ? kQuadrupedScale : 1.0);
  }
  shorten(out.path, choice, fps);
  return out;
}

}  // namespace marey
