// What a path's name means: preset:NAME, clip:FILE, a path file, or way-points themselves.
#pragma once

#include <filesystem>
#include <string>

#include "experiment/control_choice.h"
#include "io/input_report.h"
#include "model/sampler.h"
#include "motion/path.h"

namespace marey {

struct PathChoice {
  std::string path;  ///< as given; where there are way-points, only a name for errors
  std::vector<WayPoint> wayPoints = {};
  double seconds = 0.0;        ///< 0: a preset's 10 s, else the whole clip or path
  bool startFromClip = false;  ///< clip:FILE only: its first frames are the start pose
  ControlChoice control = {};
  std::filesystem::path folder;  ///< relative file names start there
};

/// Root frames of a choice at `fps`, where no model is at hand (a preset for a human).
/// Throws UsageError or InputError.
std::vector<RootFrame> rootFramesOf(const PathChoice& choice, double fps);
/// The request's path, and start poses of a clip. Throws UsageError or InputError.
SampleRequest requestFor(const MotionModel& model, const PathChoice& choice);
/// The same; `report` gets the doubts of a clip, what of a path file has no effect, and a path that
/// is faster than what the model was trained on.
SampleRequest requestFor(const MotionModel& model, const PathChoice& choice,
                         io::InputReport& report);

}  // namespace marey
