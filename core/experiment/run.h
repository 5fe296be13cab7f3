// Runs an experiment: natural clips, held-out and free samples of every system, their scores.
#pragma once

#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "base/job.h"
#include "base/ranks.h"
#include "experiment/left_out.h"
#include "experiment/sample_set.h"
#include "experiment/task_cases.h"
#include "io/input_report.h"
#include "model/likelihood.h"
#include "model/model_family.h"
#include "model/scorer.h"

namespace marey {

/// Motions of one system along one path.
struct PathSamples {
  std::vector<RootFrame> wanted;
  std::vector<ClipPtr> clips;
  std::vector<ClipScore> scores;  ///< of the clips, with the control that they were given
};

struct SystemResult {
  std::string name;
  ModelInfo info;
  double temperature = 1.0;
  OptionValues options = {};  ///< of its optionSchema, beside the temperature
  std::vector<Clip> heldOut;  ///< along the natural clips' control
  std::vector<std::vector<RootFrame>> heldOutPaths;
  std::vector<ClipScore> naturalScores, heldOutScores;  ///< of every clip, also too short ones
  std::map<std::string, PathSamples> paths;             ///< by the path's name
  std::map<std::string, CaseResult> cases;              ///< by the case's name
  double framesPerSecond = 0.0;                         ///< of sampling
  /// Over the frames that every system scores; each in its own unit.
  LikelihoodSummary naturalLikelihood, heldOutLikelihood;
};

/// Its name, with the temperature of its samples unless that is 1 and the options that it was
/// given.
std::string labelOf(const SystemResult& system);

struct ExperimentResult {
  Experiment experiment;
  std::string hash;
  std::vector<Clip> natural;  ///< at the experiment's rate
  std::vector<int> feet;
  std::vector<SystemResult> systems;
  /// Clips of another skeleton than most, or that the document does not use, and systems that do
  /// not fit the natural motion.
  std::vector<LeftOut> leftOut;
  io::InputReport inputs;  ///< what became of the files of the natural motion
};

/// What could be read of the natural sources, at the experiment's rate.
struct NaturalMotion {
  std::vector<Clip> clips;
  std::vector<std::string> sources;  ///< of the document, one for every clip
  /// What became of the files of each source but walkers, in the document's order.
  std::vector<std::pair<std::string, io::InputReport>> inputs;
  std::vector<std::string> faults;  ///< why a source, or a file that was named, is missing
};
/// For a report. Files found in folders that cannot be read are left out, and `inputs` names them.
/// Throws InputError or FileError where a source gives no clip or a named file is at fault,
/// CancelledError.
NaturalMotion naturalMotion(const Experiment& experiment, Progress& progress);
/// For a window: any fault costs only its own clips. Throws CancelledError.
NaturalMotion readableNatural(const Experiment& experiment, Progress& progress);
/// Samples `heldOutSamples` motions along the control of every natural clip with `out`'s
/// temperature, in the clips' order; fills `out.heldOut`, its paths, its scores (empty for motions
/// that are no longer than the model's context) and the speed. A report and a window get the same
/// motions. `natural` has the experiment's rate. Throws InputError, NumericError and
/// CancelledError.
void sampleHeldOut(const MotionModel& model, const Experiment& experiment,
                   const std::vector<Clip>& natural, SystemResult& out, Progress& progress,
                   Ranks& ranks);
/// Deterministic for a document, its files and the model weights. Throws InputError (also where
/// there is no natural motion), FileError, NumericError, CancelledError.
ExperimentResult runExperiment(const Experiment& experiment, std::span<const ModelFamily> families,
                               Progress& progress);
/// The same with sampling and scoring dealt out over `ranks`; the result is whole at the first one
/// and of no use elsewhere. Motions and scores do not depend on their number.
ExperimentResult runExperiment(const Experiment& experiment, std::span<const ModelFamily> families,
                               Progress& progress, Ranks& ranks);

}  // namespace marey
