// How the feet go along each path: speeds and steps, and where the path stands still, how often a
// foot is put elsewhere.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/quantile.h"
#include "model/training_pace.h"
#include "motion/standing.h"
#include "report/experiment_report.h"
#include "stats/displacements.h"
#include "stats/footsteps.h"

namespace marey::report {
namespace {

/// Quantile of floor speeds of the feet, cm/s.
double footSpeedQuantile(const std::vector<ClipPtr>& clips, const std::vector<int>& feet,
                         double share) {
  std::vector<double> speeds;
  for (const auto& clip : clips)
    for (const int foot : feet) {
      const auto own = stats::horizontalSpeedsCmS(*clip, foot);
      speeds.insert(speeds.end(), own.begin(), own.end());
    }
  return quantile(std::move(speeds), share);
}

/// Time in which a path stands still, and displacements of feet per second of it.
struct Standing {
  double seconds = 0.0;
  double displacementsPerS = std::nan("");
};

Standing standingOf(const PathSamples& samples, const ExperimentResult& r) {
  Standing out;
  double count = 0.0, watched = 0.0;
  out.seconds = standingSeconds(samples.wanted, r.experiment.fps);
  for (const auto& [first, last] : standsOf(samples.wanted, r.experiment.fps)) {
    for (const auto& clip : samples.clips) {
      watched += std::max(0, std::min(last, clip->frameCount()) - first) / clip->fps;
      for (const int foot : r.feet) count += stats::displacements(*clip, foot, first, last);
    }
  }
  if (watched > 0.0) out.displacementsPerS = count / watched;
  return out;
}

/// What is known of models that never saw standing, where paths ask for it; "" where all is well.
std::string standingNotes(const ExperimentResult& r) {
  std::string out;
  for (const auto& s : r.systems)
    for (const auto& [name, samples] : s.paths) {
      const std::string warning = standingWarning(s.name, trainingPaceOf(s.info.provenance, s.name),
                                                  samples.wanted, r.experiment.fps);
      if (!warning.empty()) out += fmt::format(" On {}, {}.", name, warning);
    }
  return out;
}

}  // namespace

Table obedienceTable(const ExperimentResult& r) {
  Table out{.id = "paths",
            .title = "Feet along each path",
            .caption =
                "Floor speed of the feet over all samples, and footsteps at v95 per second. "
                "Where the path stands still for a second or more, feet should rest: there, "
                "displacements of a foot of more than 3 cm between rests are counted, which "
                "jitter is not.",
            .section = Section::Footsteps,
            .columns = {{"path"},
                        {"system"},
                        {"median foot speed", "cm/s"},
                        {"95 % foot speed", "cm/s"},
                        {"footsteps", "1/s"},
                        {"path stands", "s"},
                        {"displacements there", "1/s"}}};
  for (const auto& path : r.experiment.paths)
    for (const auto& s : r.systems) {
      const auto& samples = s.paths.at(path.name);
      std::vector<Clip> clips;
      for (const auto& clip : samples.clips) clips.push_back(*clip);
      const auto curve =
          stats::footstepCurve(clips, {.feet = r.feet, .stepCmS = r.experiment.toleranceStepCmS},
                               std::vector<int>(clips.size(), 0));
      const Standing standing = standingOf(samples, r);
      const bool moves =
          standing.seconds < static_cast<double>(samples.wanted.size() - 1) / r.experiment.fps;
      out.rows.push_back({{path.name},
                          {labelOf(s)},
                          numberCell(footSpeedQuantile(samples.clips, r.feet, 0.5), 1),
                          numberCell(footSpeedQuantile(samples.clips, r.feet, 0.95), 1),
                          numberCell(moves ? curve.stepsPerS : std::nan(""), 2),
                          numberCell(standing.seconds, 1),
                          numberCell(standing.displacementsPerS, 2)});
    }
  out.caption += standingNotes(r);
  return out;
}

}  // namespace marey::report
