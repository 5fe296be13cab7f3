#include <algorithm>
#include <cmath>
#include <set>

#include "base/quantile.h"
#include "io/doctor_checks.h"

namespace marey::io {
namespace {

/// Joints do not move so far within a frame of any usual rate, unless a frame is missing or wrong.
constexpr double kJumpM = 0.1;
constexpr double kJumpTimesMedian = 8.0;
constexpr double kSpikeM = 0.1;
constexpr double kSpikeTimesMedian = 20.0;
constexpr double kSameM = 1e-6;
constexpr double kFrozenS = 0.5;
constexpr double kBelowM = 0.05;
constexpr double kFloorOffsetM = 0.1;
/// Faults of one kind that are listed one by one.
constexpr size_t kMostListed = 5;

/// 0 of nothing.
double median(const std::vector<double>& values) {
  return values.empty() ? 0.0 : quantile(values, 0.5);
}

/// Mean joint displacement from each frame to the next.
std::vector<double> meanSteps(const Clip& clip) {
  std::vector<double> out;
  for (int t = 1; t < clip.frameCount(); ++t) {
    double sum = 0.0;
    for (int j = 0; j < clip.jointCount(); ++j) sum += (clip.at(t, j) - clip.at(t - 1, j)).norm();
    out.push_back(sum / clip.jointCount());
  }
  return out;
}

/// Every joint but the root is turned as in the rest pose.
bool isRestPose(const Clip& clip, int t) {
  constexpr float kSameTurn = 0.99996f;  // cosine of half a degree
  if (!clip.transforms) return false;
  const auto width = static_cast<size_t>(clip.jointCount());
  const auto first = clip.transforms->rotations.begin() + static_cast<long>(width) * t;
  return std::all_of(first + 1, first + static_cast<long>(width),
                     [](const Quat& q) { return std::abs(q.w()) > kSameTurn; });
}

/// How far the joints move from the first frame to the second, where that tells that the first is
/// no part of the motion.
std::optional<double> calibrationStep(const Clip& clip, const std::vector<double>& steps) {
  constexpr size_t kLeastSteps = 8;
  constexpr double kTimesUsual = 3.0;
  constexpr double kRestStepM = 0.03, kRestTimesUsual = 1.5;
  if (steps.size() < kLeastSteps) return std::nullopt;
  std::vector<double> others(steps.begin() + 1, steps.end());
  std::sort(others.begin(), others.end());
  const double large = others[others.size() * 95 / 100];
  const bool far = steps[0] >= std::max(kJumpM, kTimesUsual * large);
  const bool rest = isRestPose(clip, 0) && !isRestPose(clip, 1) &&
                    steps[0] >= std::max(kRestStepM, kRestTimesUsual * large);
  return far || rest ? std::optional(steps[0]) : std::nullopt;
}

/// Steps far above the usual one: i is the step from frame i to i + 1, from 0.
std::set<size_t> jumps(const std::vector<double>& steps) {
  const double limit = std::max(kJumpM, kJumpTimesMedian * median(steps));
  std::set<size_t> out;
  for (size_t i = 0; i < steps.size(); ++i)
    if (steps[i] >= limit) out.insert(i);
  return out;
}

/// Those, and the one that leads out of a calibration pose.
std::set<size_t> allJumps(const Clip& clip) {
  const std::vector<double> steps = meanSteps(clip);
  std::set<size_t> out = jumps(steps);
  if (calibrationStep(clip, steps)) out.insert(0);
  return out;
}

double largestStep(const Clip& clip, int t) {
  double out = 0.0;
  for (int j = 0; j < clip.jointCount(); ++j)
    out = std::max<double>(out, (clip.at(t, j) - clip.at(t - 1, j)).norm());
  return out;
}

/// How far a joint is from the middle of where it was and will be.
double bend(const Clip& clip, int t, int joint) {
  return (clip.at(t, joint) - 0.5f * (clip.at(t - 1, joint) + clip.at(t + 1, joint))).norm();
}

/// Adds the first few and says how many more there are.
void addListed(std::vector<Fault> found, std::vector<Fault>& out) {
  const size_t all = found.size();
  if (all > kMostListed) {
    found.resize(kMostListed);
    found.back().evidence += fmt::format(" (and {} more)", all - kMostListed);
  }
  out.insert(out.end(), found.begin(), found.end());
}

/// What a note of a reader is, by its beginning and a part of it.
struct NoteKind {
  std::string_view begin, part;
  const char* kind;
  Severity severity;
};
constexpr NoteKind kNoteKinds[] = {
    {"frame time ", "", "rounded_frame_time", Severity::Note},
    {"line ", "a second joint '", "repeated_name", Severity::Warning},
    {"unit ", "an uncertain guess", "unit_uncertain", Severity::Warning},
    {"up axis ", "an uncertain guess", "up_uncertain", Severity::Warning},
    {"ROOT '", "is left out", "left_out", Severity::Warning},
    {"the header ", "", "frame_count", Severity::Warning},
    {"line ", "the last row has", "frame_count", Severity::Warning},
    {"root orientation ", "", "root_orientation", Severity::Note},
};

}  // namespace

void addReaderFaults(const Clip& clip, std::vector<Fault>& out) {
  for (const std::string& note : clip.source.notes)
    for (const NoteKind& known : kNoteKinds)
      if (note.starts_with(known.begin) && note.find(known.part) != std::string::npos)
        out.push_back({known.kind, known.severity, note, std::nullopt});
}

std::optional<Fault> calibrationPose(const Clip& clip) {
  const std::vector<double> steps = meanSteps(clip);
  const std::optional<double> step = calibrationStep(clip, steps);
  if (!step) return std::nullopt;
  return Fault{
      "calibration_pose", Severity::Warning,
      fmt::format("between frames 1 and 2 the joints move {:.2f} m on average (median step "
                  "{:.3f} m): the first frame may be a calibration pose (convert --frames "
                  "1: leaves it out)",
                  *step, median(steps)),
      1};
}

void checkTeleports(const Clip& clip, std::vector<Fault>& out) {
  const std::vector<double> steps = meanSteps(clip);
  const double usual = median(steps);
  std::vector<Fault> found;
  const bool calibrated = calibrationStep(clip, steps).has_value();
  for (const size_t i : jumps(steps)) {
    if (i == 0 && calibrated) continue;
    const int frame = static_cast<int>(i) + 2;
    found.push_back({"teleport", Severity::Warning,
                     fmt::format("between frames {} and {} the joints move {:.2f} m on average "
                                 "(median step {:.3f} m)",
                                 frame - 1, frame, steps[i], usual),
                     frame});
  }
  addListed(std::move(found), out);
}

void checkSpikes(const Clip& clip, std::vector<Fault>& out) {
  std::vector<Fault> found;
  const std::set<size_t> jumped = allJumps(clip);
  for (int j = 0; j < clip.jointCount(); ++j) {
    std::vector<double> bends;
    for (int t = 1; t + 1 < clip.frameCount(); ++t) bends.push_back(bend(clip, t, j));
    const double limit = std::max(kSpikeM, kSpikeTimesMedian * median(bends));
    for (size_t i = 0; i < bends.size(); ++i) {
      if (jumped.contains(i) || jumped.contains(i + 1)) continue;
      // A step that stays bends the path on both sides alike; a spike does so at its peak.
      const bool peak = (i == 0 || bends[i - 1] < 0.75 * bends[i]) &&
                        (i + 1 == bends.size() || bends[i + 1] < 0.75 * bends[i]);
      if (bends[i] < limit || !peak) continue;
      found.push_back({"spike", Severity::Warning,
                       fmt::format("joint '{}' is {:.2f} m off the path of its neighbour frames",
                                   clip.skeleton->names[static_cast<size_t>(j)], bends[i]),
                       static_cast<int>(i) + 2});
    }
  }
  addListed(std::move(found), out);
}

void checkRepeats(const Clip& clip, std::vector<Fault>& out) {
  std::vector<Fault> frozen;
  int repeated = 0, firstRepeated = 0, run = 0;
  for (int t = 1; t <= clip.frameCount(); ++t) {
    if (t < clip.frameCount() && largestStep(clip, t) <= kSameM) {
      ++run;
      continue;
    }
    const int begin = t - run;  // 1-based: the frame that the run repeats
    if (run > 0 && run + 1 >= kFrozenS * clip.fps)
      frozen.push_back(
          {"frozen", Severity::Warning,
           fmt::format("frames {} to {} ({:.2f} s) are the same", begin, t, run / clip.fps),
           begin});
    else if (run > 0) {
      if (repeated == 0) firstRepeated = begin + 1;
      repeated += run;
    }
    run = 0;
  }
  addListed(std::move(frozen), out);
  if (repeated > 0)
    out.push_back(
        {"duplicate_frames", Severity::Warning,
         fmt::format("{} of {} frames repeat the frame before them", repeated, clip.frameCount()),
         firstRepeated});
}

void checkFloor(const Clip& clip, double floorM, std::vector<Fault>& out) {
  if (std::abs(floorM) > kFloorOffsetM)
    out.push_back({"floor_offset", Severity::Note,
                   fmt::format("the feet stand at a height of {:.2f} m", floorM), std::nullopt});
  int below = 0, first = 0;
  float lowest = 0.0f;
  for (int t = 0; t < clip.frameCount(); ++t) {
    float low = INFINITY;
    for (const Vec3& p : clip.frame(t)) low = std::min(low, p.y());
    if (low >= floorM - kBelowM) continue;
    if (below++ == 0) first = t + 1;
    lowest = std::min(lowest, low - static_cast<float>(floorM));
  }
  if (below > 0)
    out.push_back({"below_floor", Severity::Warning,
                   fmt::format("joints are up to {:.0f} cm below the feet's floor in {} frames",
                               -100.0f * lowest, below),
                   first});
}

}  // namespace marey::io
