#include "model/gradient/trainer.h"

#include <chrono>
#include <cmath>

#include "model/gradient/run_folder.h"
#include "model/pose_units.h"

namespace marey {
namespace {

/// What the processes agree on before every step; the largest holds.
constexpr double kGoOn = 0.0, kEnd = 1.0, kCancel = 2.0;

/// Goes from step to step and from checkpoint to checkpoint until it is to end.
class Run {
 public:
  explicit Run(RunSetup& setup) : m_setup(setup), m_folder(setup) {
    setup.net().to(setup.device);
    setup.net().execution = setup.request.execution;
    m_steps.emplace(setup);
    m_state = m_folder.begin(m_steps->optimiser());
  }

  TrainResult execute(Progress& progress) {
    const int64_t firstStep = m_state.step;
    const double decision = stepOn(progress);
    const bool idle = m_state.step == firstStep;
    if (idle && m_setup.request.resume)
      restate();
    else if (idle || m_steps->since().steps() > 0)
      checkpoint();
    if (decision == kCancel) throw CancelledError();
    m_result.steps = m_state.step;
    m_result.valid = m_state.bestValid;
    return m_result;
  }

 private:
  /// Until the processes decide otherwise; what they decided.
  double stepOn(Progress& progress) {
    const auto clock = std::chrono::steady_clock::now();
    const double before = m_state.seconds;
    const int64_t firstStep = m_state.step;
    double decision = kGoOn;
    while ((decision = m_setup.group->largest(wish(progress))) == kGoOn) {
      m_steps->takeOne(m_state);
      m_state.seconds =
          before + std::chrono::duration<double>(std::chrono::steady_clock::now() - clock).count();
      tell(progress,
           static_cast<double>(m_state.step - firstStep) / (m_state.seconds - before + 1e-9));
      if (m_state.step % m_setup.config.checkpointEvery == 0) checkpoint();
    }
    return decision;
  }

  double wish(const Progress& progress) const {
    if (progress.cancelled()) return kCancel;
    if (m_state.step >= m_setup.lastStep()) return kEnd;
    // Clocks differ: that of the leading process counts.
    const auto& minutes = m_setup.request.minutes;
    const bool late = minutes && m_state.seconds >= 60.0 * *minutes;
    return late && m_setup.leads() ? kEnd : kGoOn;
  }

  double trainLoss() const {
    const Since& since = m_steps->since();
    return shownLoss(m_setup.objective, since.mean(since.loss));
  }

  void checkpoint() {
    Checkpoint made;
    {
      const AveragedWeights averaged(m_setup.net(), m_state);
      made.judged = judge(m_setup);
      if (m_setup.leads()) made.model = serialise(m_folder.exported(m_state, made.judged));
    }
    made.train = trainLoss();
    m_result.train = made.train;
    m_result.testNatsPerFrame = natsPerFrame(m_setup, made.judged.test);
    const double criterion = std::isnan(made.judged.valid)
                                 ? made.train
                                 : shownLoss(m_setup.objective, made.judged.valid);
    made.best = criterion < m_state.bestValid;
    if (made.best) m_state.bestValid = criterion;
    if (m_setup.leads()) m_folder.write(made, m_state, m_steps->since(), m_steps->optimiser());
    m_steps->forget();
  }

  /// A run that had ended says again what it reached.
  void restate() {
    const AveragedWeights averaged(m_setup.net(), m_state);
    m_result.train = std::nan("");
    m_result.testNatsPerFrame = natsPerFrame(m_setup, judge(m_setup).test);
  }

  void tell(Progress& progress, double rate) const {
    const double bySteps =
        static_cast<double>(m_state.step) / static_cast<double>(m_setup.lastStep());
    const auto& minutes = m_setup.request.minutes;
    const double byTime = minutes ? m_state.seconds / (60.0 * *minutes) : 0.0;
    const auto valid = std::isfinite(m_state.bestValid)
                           ? fmt::format(" (valid {:.4g})", m_state.bestValid)
                           : std::string();
    progress.report(std::min(1.0, std::max(bySteps, byTime)),
                    fmt::format("step {}, {:.2f} steps/s, {:.4g} {}{}", m_state.step, rate,
                                trainLoss(), shownUnit(m_setup.objective), valid));
  }

  RunSetup& m_setup;
  RunFolder m_folder;
  std::optional<TrainingSteps> m_steps;
  TrainingState m_state;
  TrainResult m_result{.objective = m_setup.objective,
                       .testUnit = likelihoodUnit(m_setup.data.options.features),
                       .best = m_setup.request.run / "best.marey",
                       .last = m_setup.request.run / "last.marey"};
};

}  // namespace

TrainResult trainByGradient(const DataSet& data, const TrainRequest& request,
                            const ModelFamily& family, Progress& progress) {
  RunSetup setup(data, request, family);
  try {
    return Run(setup).execute(progress);
  } catch (const std::exception& e) {
    setup.group->abandon(e.what());
    throw;
  }
}

}  // namespace marey
