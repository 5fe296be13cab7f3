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

SampleRequest wholeRequest(const MotionModel& model, const PathChoice& choice, double fps) {
  if (choice.path.starts_with("clip:"))
    return requestAlongClip(model, io::readClip(choice.folder / choice.path.substr(5)),
                            choice.startFromClip);
  if (choice.startFromClip) throw UsageError("--start clip: needs a path of the form clip:FILE");
  SampleRequest out;
  if (choice.path.starts_with("preset:")) {
    const bool quadruped = model.info().skeleton && rolesOf(*model.info().skeleton).quadruped;
    out.path =
        presetPath(choice.path.substr(7), choice.seconds > 0 ? choice.seconds : kPresetSeconds, fps,
                   quadruped ? kQuadrupedScale : 1.0);
  } else {
    const auto file = choice.folder / choice.path;
    out.path = samplePath(readPathFile(file), fps, file.string());
  }
  return out;
}

}  // namespace

SampleRequest requestFor(const MotionModel& model, const PathChoice& choice) {
  const double fps = model.info().features.fps;
  SampleRequest out = wholeRequest(model, choice, fps);
  if (choice.seconds <= 0.0) return out;
  const auto wanted = static_cast<size_t>(std::max(2L, std::lround(choice.seconds * fps)));
  if (wanted > out.path.size() + 1)
    throwInput(
        {.path = choice.path, .item = "--seconds"},
        fmt::format("at most the path's {:.2f} s", static_cast<double>(out.path.size()) / fps),
        "{} s", choice.seconds);
  out.path.resize(std::min(wanted, out.path.size()));
  return out;
}

}  // namespace marey
