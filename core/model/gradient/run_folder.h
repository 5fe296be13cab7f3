// The folder of a training run: how it begins or goes on, and what a checkpoint leaves in it.
// Internal (libtorch types).
#pragma once

#include <string>

#include "model/gradient/judge.h"
#include "model/gradient/training_steps.h"

namespace marey {

/// What is written of a checkpoint.
struct Checkpoint {
  Judged judged;
  double train = std::nan("");  ///< mean since the last one, in shownUnit
  bool best = false;
  std::string model;  ///< as stored
};

class RunFolder {
 public:
  explicit RunFolder(RunSetup& setup) : m_setup(setup) {}
  /// Starts the net, or restores it, its optimiser and the state that is returned. Throws
  /// InputError and FileError.
  TrainingState begin(Optimiser& optimiser);
  /// The net as it is, with where it comes from.
  TensorFile exported(const TrainingState& state, const Judged& judged) const;
  /// For the leading process alone. The state comes last: a run that is killed before goes on from
  /// the checkpoint before.
  void write(const Checkpoint& checkpoint, TrainingState& state, const Since& since,
             const Optimiser& optimiser) const;

 private:
  TrainingState beginNew();
  void startNet();
  void appendRow(const Checkpoint& checkpoint, const TrainingState& state,
                 const Since& since) const;

  RunSetup& m_setup;
  Json m_facts = Json::object();  ///< of the start
};

}  // namespace marey
