#include <cstdio>

#include "base/error.h"
#include "experiment/run.h"
#include "io/clip_io.h"
#include "io/inputs.h"
#include "motion/resample.h"
#include "motion/walker.h"

namespace marey {
namespace {

/// walker:CLIPS,SECONDS,SEED
std::vector<Clip> walkerClips(const std::string& source, const std::string& origin) {
  int clips = 0;
  double seconds = 0.0;
  unsigned long seed = 0;
  char rest = 0;
  if (std::sscanf(source.c_str(), "walker:%d,%lf,%lu%c", &clips, &seconds, &seed, &rest) != 3 ||
      clips < 1 || clips > 100000 || !(seconds > 0.2 && seconds < 86400.0))
    throw InputError({.path = origin, .item = "key 'natural'"}, "walker:CLIPS,SECONDS,SEED",
                     "'" + source + "'");
  std::vector<Clip> out;
  for (WalkerClip& walked : walkerDataSet(clips, seconds, seed))
    out.push_back(std::move(walked.clip));
  return out;
}

}  // namespace

std::vector<Clip> naturalClips(const Experiment& experiment, Progress& progress) {
  std::vector<Clip> out;
  for (size_t i = 0; i < experiment.natural.size(); ++i) {
    const std::string& source = experiment.natural[i];
    std::vector<Clip> clips;
    if (source.starts_with("walker:")) {
      clips = walkerClips(source, experiment.title);
    } else {
      for (const auto& file : io::expandInputs({source}, experiment.folder)) {
        progress.throwIfCancelled();
        for (Clip& clip : io::readClips(file)) clips.push_back(std::move(clip));
      }
    }
    for (const Clip& clip : clips) out.push_back(resampled(clip, experiment.fps));
    progress.report(static_cast<double>(i + 1) / static_cast<double>(experiment.natural.size()),
                    "reading natural motion");
  }
  return out;
}

}  // namespace marey
