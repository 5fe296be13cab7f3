#include <cstdio>
#include <functional>

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

/// What is read at a time.
struct Piece {
  std::string source;
  std::filesystem::path file;  ///< empty: the source is a walker
};

/// Told what is wrong with a source or file; throws, or goes on without it.
using OnFault = std::function<void(const Error&)>;

std::vector<Piece> piecesOf(const Experiment& experiment, const OnFault& onFault) {
  std::vector<Piece> out;
  for (const std::string& source : experiment.natural) {
    if (source.starts_with("walker:")) {
      out.push_back({source, {}});
      continue;
    }
    try {
      for (const auto& file : io::expandInputs({source}, experiment.folder))
        out.push_back({source, file});
    } catch (const Error& fault) {
      onFault(fault);
    }
  }
  return out;
}

NaturalMotion readPieces(const Experiment& experiment, Progress& progress, const OnFault& onFault) {
  NaturalMotion out;
  const std::vector<Piece> pieces = piecesOf(experiment, onFault);
  for (size_t i = 0; i < pieces.size(); ++i) {
    progress.throwIfCancelled();
    const Piece& piece = pieces[i];
    try {
      const std::vector<Clip> clips = piece.file.empty()
                                          ? walkerClips(piece.source, experiment.title)
                                          : io::readClips(piece.file);
      for (const Clip& clip : clips) {
        out.clips.push_back(resampled(clip, experiment.fps));
        out.sources.push_back(piece.source);
      }
    } catch (const Error& fault) {
      onFault(fault);
    }
    progress.report(static_cast<double>(i + 1) / static_cast<double>(pieces.size()),
                    "reading natural motion");
  }
  return out;
}

}  // namespace

std::vector<Clip> naturalClips(const Experiment& experiment, Progress& progress) {
  return readPieces(experiment, progress, [](const Error&) { throw; }).clips;
}

NaturalMotion readableNatural(const Experiment& experiment, Progress& progress) {
  std::vector<std::string> faults;
  NaturalMotion out = readPieces(experiment, progress,
                                 [&](const Error& fault) { faults.emplace_back(fault.what()); });
  out.faults = std::move(faults);
  return out;
}

}  // namespace marey
