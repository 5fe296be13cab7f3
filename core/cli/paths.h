// What --path means: preset:NAME, clip:FILE or a path file.
#pragma once

#include <string>
#include <vector>

#include "model/sampler.h"

namespace marey::cli {

struct PathChoice {
  std::string path;          ///< as given
  double seconds = 0.0;      ///< 0: a preset's 10 s, else the whole clip or path
  bool startFromClip = false;
};

/// The request's path (and start poses, for a clip). Throws UsageError or InputError.
SampleRequest requestFor(const MotionModel& model, const PathChoice& choice);

}  // namespace marey::cli
