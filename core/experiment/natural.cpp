#include <cstdio>
#include <functional>

#include "base/error.h"
#include "experiment/run.h"
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

/// Told of a source that gives no file; throws, or goes on without it.
using OnFault = std::function<void(const Error&)>;

/// A source of the document: a walker, or files.
struct Source {
  std::string name;
  io::Inputs files;
  bool walker() const { return name.starts_with("walker:"); }
  size_t pieces() const { return walker() ? 1 : files.files.size(); }
};

std::vector<Source> sourcesOf(const Experiment& experiment, const OnFault& onFault) {
  std::vector<Source> out;
  for (const std::string& name : experiment.natural) {
    Source source{name, {}};
    try {
      if (!source.walker()) source.files = io::findInputs({name}, experiment.folder);
      out.push_back(std::move(source));
    } catch (const Error& fault) {
      onFault(fault);
    }
  }
  return out;
}

/// Adds the clips of sources to a result, and tells how far it has come.
class NaturalReader {
 public:
  NaturalReader(const Experiment& experiment, OnFault onFault, Progress& progress)
      : m_experiment(experiment), m_onFault(std::move(onFault)), m_progress(progress) {}

  NaturalMotion read() {
    const std::vector<Source> sources = sourcesOf(m_experiment, m_onFault);
    for (const Source& source : sources) m_pieces += source.pieces();
    for (const Source& source : sources) {
      if (source.walker())
        addWalkers(source);
      else
        addFiles(source);
    }
    return std::move(m_out);
  }

 private:
  void addWalkers(const Source& source) {
    try {
      for (const Clip& clip : walkerClips(source.name, m_experiment.title))
        add(resampled(clip, m_experiment.fps), source);
    } catch (const InputError& fault) {
      m_onFault(fault);
    }
    tell();
  }

  void addFiles(const Source& source) {
    io::InputReport report(source.files);
    size_t clips = 0;
    for (const io::InputFile& file : source.files.files) {
      m_progress.throwIfCancelled();
      for (const Clip& clip : report.read(file, {})) {
        report.resample(clip, m_experiment.fps);
        add(resampled(clip, m_experiment.fps), source);
        ++clips;
      }
      tell();
    }
    try {
      report.throwIfNone(clips);
    } catch (const InputError& fault) {
      m_onFault(fault);
    }
    m_out.inputs.emplace_back(source.name, std::move(report));
  }

  void add(Clip clip, const Source& source) {
    m_out.clips.push_back(std::move(clip));
    m_out.sources.push_back(source.name);
  }

  void tell() {
    m_progress.report(static_cast<double>(++m_done) / static_cast<double>(m_pieces),
                      "reading natural motion");
  }

  const Experiment& m_experiment;
  OnFault m_onFault;
  Progress& m_progress;
  size_t m_pieces = 0, m_done = 0;
  NaturalMotion m_out;
};

}  // namespace

NaturalMotion naturalMotion(const Experiment& experiment, Progress& progress) {
  return NaturalReader(
             experiment, [](const Error&) { throw; }, progress)
      .read();
}

NaturalMotion readableNatural(const Experiment& experiment, Progress& progress) {
  std::vector<std::string> faults;
  const auto note = [&](const Error& fault) { faults.emplace_back(fault.what()); };
  NaturalMotion out = NaturalReader(experiment, note, progress).read();
  out.faults = std::move(faults);
  return out;
}

}  // namespace marey
