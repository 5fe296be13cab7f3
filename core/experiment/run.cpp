#include "experiment/run.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

#include "base/error.h"
#include "experiment/packed_motion.h"
#include "io/annotation_files.h"
#include "model/sampler.h"
#include "stats/footsteps.h"

namespace marey {
namespace {

/// Samples of different stages of one experiment take different latents.
constexpr int kHeldOutSampleBase = 1000000;
/// Motions that are sampled in one batch, or natural clips whose control is followed in one.
constexpr size_t kTogether = 64;

void checkRate(const MotionModel& model, const Experiment& experiment) {
  if (std::abs(model.info().features.fps - experiment.fps) > 1e-6)
    throwInput(
        {.path = experiment.title, .item = "key 'fps'"},
        fmt::format("the rate of model {}: {}", model.info().variant, model.info().features.fps),
        "{}", experiment.fps);
}

/// Numbers 0 .. count - 1 by rising `length`, each rank's share with short and long ones.
std::vector<size_t> dealtByLength(size_t count, int ranks,
                                  const std::function<size_t(size_t)>& length) {
  std::vector<size_t> sorted(count), out;
  std::iota(sorted.begin(), sorted.end(), 0);
  std::stable_sort(sorted.begin(), sorted.end(),
                   [&](size_t a, size_t b) { return length(a) < length(b); });
  for (size_t r = 0; r < static_cast<size_t>(ranks); ++r)
    for (size_t i = r; i < count; i += static_cast<size_t>(ranks)) out.push_back(sorted[i]);
  return out;
}

/// Results that were gathered in the order of `dealt`, by number.
std::vector<std::string> byNumber(const std::vector<size_t>& dealt,
                                  std::vector<std::string> gathered) {
  std::vector<std::string> out(gathered.size());
  for (size_t i = 0; i < gathered.size(); ++i) out[dealt[i]] = std::move(gathered[i]);
  return out;
}

}  // namespace

// Clips of similar length go together.
void sampleHeldOut(const MotionModel& model, const Experiment& e, const std::vector<Clip>& natural,
                   SystemResult& out, Progress& progress, Ranks& ranks) {
  std::vector<SampleRequest> requests;
  for (size_t i = 0; i < natural.size(); ++i) {
    Clip clip = natural[i];
    io::readSignals(clip, model.info().features.control);
    requests.push_back(requestAlongClip(model, clip, false));
    requests.back().samples = e.heldOutSamples;
    requests.back().seed = e.seed;
    requests.back().temperature = out.temperature;
    requests.back().options = out.options;
    requests.back().firstSample = kHeldOutSampleBase + static_cast<int>(i) * e.heldOutSamples;
  }
  const auto dealt = dealtByLength(natural.size(), ranks.size(),
                                   [&](size_t i) { return requests[i].path.size(); });
  SamplingPace pace;
  const auto share = [&](size_t begin, size_t end, Progress& own) {
    std::vector<std::string> packed;
    const auto all = static_cast<double>(end - begin);
    for (size_t first = begin; first < end; first += kTogether) {
      const size_t last = std::min(first + kTogether, end);
      std::vector<SampleRequest> batch;
      for (size_t i = first; i < last; ++i) batch.push_back(requests[dealt[i]]);
      Progress part = own.part(static_cast<double>(first - begin) / all,
                               static_cast<double>(last - begin) / all);
      for (auto& result : packedSamples(model, batch, pace, part))
        packed.push_back(std::move(result));
    }
    return packed;
  };
  const auto results = byNumber(dealt, ranks.gather(natural.size(), share, progress));
  // The other processes are taken to be as fast as the first one.
  out.framesPerSecond = ranks.size() * pace.frames / pace.seconds;
  for (size_t i = 0; i < results.size(); ++i) {
    int sample = 0;
    for (ScoredSequence& scored : unpackSamples(results[i])) {
      const auto sequence =
          sequenceOf(model.info(), requests[i], sample++, std::move(scored.poses));
      out.heldOutScores.push_back(std::move(scored.score));
      out.heldOut.push_back(sampledClip(model, sequence));
      out.heldOut.back().name = natural[i].name + "/" + sequence.name;
      out.heldOutPaths.push_back(requests[i].path);
    }
  }
}

namespace {

/// The motions of all paths are numbered one after the other, so that few along many paths are
/// dealt out as well as many along one.
void samplePaths(const MotionModel& model, const Experiment& e, SystemResult& out,
                 Progress& progress, Ranks& ranks) {
  std::vector<SampleRequest> requests;
  for (const ExperimentPath& path : e.paths)
    requests.push_back(requestOf(model, {.system = {out.name, {}, out.temperature, out.options},
                                         .path = path,
                                         .samples = 1,
                                         .seed = e.seed,
                                         .fps = e.fps,
                                         .folder = e.folder}));
  const auto ofPath = static_cast<size_t>(e.samples);
  SamplingPace pace;
  const auto share = [&](size_t begin, size_t end, Progress& own) {
    std::vector<std::string> packed;
    for (size_t first = begin; first < end;) {
      const size_t path = first / ofPath;
      const size_t last = std::min({end, (path + 1) * ofPath, first + kTogether});
      std::vector<SampleRequest> batch(last - first, requests[path]);
      for (size_t i = first; i < last; ++i)
        batch[i - first].firstSample = static_cast<int>(i - path * ofPath);
      const auto all = static_cast<double>(end - begin);
      Progress part = own.part(static_cast<double>(first - begin) / all,
                               static_cast<double>(last - begin) / all);
      for (auto& result : packedSamples(model, batch, pace, part))
        packed.push_back(std::move(result));
      first = last;
    }
    return packed;
  };
  const auto results = ranks.gather(ofPath * e.paths.size(), share, progress);
  for (size_t i = 0; i < results.size(); ++i) {
    SampleRequest& request = requests[i / ofPath];
    PathSamples& samples = out.paths[e.paths[i / ofPath].name];
    samples.wanted = request.path;
    for (ScoredSequence& scored : unpackSamples(results[i])) {
      samples.scores.push_back(std::move(scored.score));
      samples.clips.push_back(std::make_shared<const Clip>(
          sampledClip(model, sequenceOf(model.info(), request, static_cast<int>(i % ofPath),
                                        std::move(scored.poses)))));
    }
  }
}

void scoreNatural(const MotionModel& model, const std::vector<Clip>& natural, SystemResult& out,
                  Progress& progress, Ranks& ranks) {
  const auto dealt = dealtByLength(natural.size(), ranks.size(), [&](size_t i) {
    return static_cast<size_t>(natural[i].frameCount());
  });
  const auto share = [&](size_t begin, size_t end, Progress& own) {
    std::vector<Clip> mine;
    for (size_t i = begin; i < end; ++i) mine.push_back(natural[dealt[i]]);
    std::vector<std::string> packed;
    for (const ClipScore& score : scoreClips(model, mine, false, own)) {
      Packer packer;
      pack(score, packer);
      packed.push_back(packer.take());
    }
    return packed;
  };
  for (const auto& packed : byNumber(dealt, ranks.gather(natural.size(), share, progress))) {
    Unpacker bytes(packed);
    out.naturalScores.push_back(unpackScore(bytes));
  }
}

/// Why a system cannot be compared with the natural motion; empty: it can.
std::string whyNot(const MotionModel& model, const Experiment& experiment, const Clip& natural) {
  try {
    checkRate(model, experiment);
    requireSameJoints(model.info(), natural, natural.name);
  } catch (const InputError& fault) {
    return fault.what();
  }
  return {};
}

/// Models with different contexts are compared on the frames that all of them score.
void summariseLikelihoods(std::vector<SystemResult>& systems) {
  int first = 0;
  for (const SystemResult& s : systems)
    if (s.info.density != DensityKind::None) first = std::max(first, s.info.context);
  for (SystemResult& s : systems) {
    s.naturalLikelihood = summarise(s.info, s.naturalScores, first);
    s.heldOutLikelihood = summarise(s.info, s.heldOutScores, first);
  }
}

}  // namespace

std::string labelOf(const SystemResult& system) {
  std::string out = system.name;
  if (system.temperature != 1.0) out += fmt::format(", temperature {:g}", system.temperature);
  if (!system.options.empty()) out += ", " + textOf(system.options);
  return out;
}

ExperimentResult runExperiment(const Experiment& experiment, std::span<const ModelFamily> families,
                               Progress& progress) {
  Ranks one;
  return runExperiment(experiment, families, progress, one);
}

ExperimentResult runExperiment(const Experiment& experiment, std::span<const ModelFamily> families,
                               Progress& progress, Ranks& ranks) {
  if (experiment.natural.empty())
    throw InputError({.path = experiment.title, .item = "key 'natural'"},
                     "at least one source of clips", "none");
  ExperimentResult out{.experiment = experiment, .hash = experimentHash(experiment)};
  Progress reading = progress.part(0.0, 0.05);
  NaturalMotion natural = naturalMotion(experiment, reading);
  for (const auto& [source, inputs] : natural.inputs) out.inputs.add(inputs);
  out.natural = std::move(natural.clips);
  out.leftOut = dropNamed(out.natural, experiment.naturalLeftOut);
  for (LeftOut& odd : keepMainBody(out.natural)) out.leftOut.push_back(std::move(odd));
  if (out.natural.empty())
    throwInput({.path = experiment.title, .item = "key 'natural'"}, "a clip to compare with",
               "none of {}: {}", out.leftOut.size(), out.leftOut.front().why);
  out.feet = stats::feetOf(*out.natural.front().skeleton, experiment.feet);
  const double share = 0.95 / static_cast<double>(std::max<size_t>(1, experiment.systems.size()));
  for (size_t i = 0; i < experiment.systems.size(); ++i) {
    const ExperimentSystem& system = experiment.systems[i];
    const auto model = loadModel((experiment.folder / system.model).string(), families);
    if (std::string why = whyNot(*model, experiment, out.natural.front()); !why.empty()) {
      out.leftOut.push_back({system.name, std::move(why)});
      continue;
    }
    SystemResult result{.name = system.name,
                        .info = model->info(),
                        .temperature = system.temperature,
                        .options = system.options};
    const double from = 0.05 + share * static_cast<double>(i);
    Progress scoring = progress.part(from, from), heldOut = progress.part(from, from + 0.5 * share),
             paths = progress.part(from + 0.5 * share, from + share);
    io::readSignals(out.natural, model->info().features.control);
    scoreNatural(*model, out.natural, result, scoring, ranks);
    if (experiment.heldOutSamples > 0)
      sampleHeldOut(*model, experiment, out.natural, result, heldOut, ranks);
    samplePaths(*model, experiment, result, paths, ranks);
    for (const ExperimentCase& one : experiment.cases) {
      Progress working = progress.part(from + share, from + share);
      result.cases[one.name] =
          runCase(*model, one, out.natural, experiment.seed, system, working, ranks);
    }
    out.systems.push_back(std::move(result));
  }
  if (out.systems.empty() && !experiment.systems.empty())
    throwInput({.path = experiment.title, .item = "key 'systems'"},
               "a system that fits the natural motion", "none: {}", out.leftOut.back().why);
  summariseLikelihoods(out.systems);
  return out;
}

}  // namespace marey
