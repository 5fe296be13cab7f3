// What a path's name means: preset:NAME, clip:FILE or a path file.
#pragma once

#include <filesystem>
#include <string>

#include "model/sampler.h"

namespace marey {

struct PathChoice {
  std::string path;              ///< as given
  double seconds = 0.0;          ///< 0: a preset's 10 s, else the whole clip or path
  bool startFromClip = false;    ///< clip:FILE only: its first frames are the start pose
  std::filesystem::path folder;  ///< relative file names start there
};

/// The request's path, and start poses of a clip. Throws UsageError or InputError.
SampleRequest requestFor(const MotionModel& model, const PathChoice& choice);

}  // namespace marey
