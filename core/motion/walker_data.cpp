// The walker's data set: many clips whose paths show every kind of control of the papers.
#include <algorithm>
#include <array>
#include <cmath>

#include "base/error.h"
#include "base/random.h"
#include "motion/walker.h"
#include "motion/walker_noise.h"

namespace marey {
namespace {

using walker::SmoothNoise;

/// Channels and streams apart from those of walk().
constexpr uint32_t kPathChannel = 200;
constexpr uint32_t kClipChannel = 300;

/// Mean velocities of a kind of path and how much they wander; m/s and rad/s.
struct PathKind {
  const char* name;
  double forward, side, turn;
  double forwardVaries, sideVaries, turnVaries;
};

constexpr std::array<PathKind, 14> kKinds = {{
    {"normal", 1.2, 0.0, 0.0, 0.12, 0.0, 0.15},
    {"turn-left", 1.15, 0.0, 0.7, 0.10, 0.0, 0.20},
    {"still", 0.0, 0.0, 0.0, 0.0, 0.0, 0.0},
    {"fast", 1.8, 0.0, 0.0, 0.15, 0.0, 0.12},
    {"speed-changes", 1.1, 0.0, 0.0, 0.0, 0.0, 0.15},
    {"sideways-left", 0.0, 0.55, 0.0, 0.05, 0.08, 0.05},
    {"turn-right", 1.15, 0.0, -0.7, 0.10, 0.0, 0.20},
    {"slow", 0.5, 0.0, 0.0, 0.08, 0.0, 0.12},
    {"backward", -0.65, 0.0, 0.0, 0.08, 0.0, 0.08},
    {"stop-and-go", 1.15, 0.0, 0.0, 0.0, 0.0, 0.10},
    {"sideways-right", 0.0, -0.55, 0.0, 0.05, 0.08, 0.05},
    {"wander", 1.15, 0.0, 0.0, 0.25, 0.08, 0.55},
    {"turn-on-spot", 0.0, 0.0, 0.0, 0.0, 0.0, 0.6},
    {"mixed", 0.5, 0.0, 0.0, 0.7, 0.25, 0.45},
}};

double smoothRamp(double u) {
  const double c = std::clamp(u, 0.0, 1.0);
  return c * c * (3.0 - 2.0 * c);
}

/// 1 while going, 0 while stopped, with smooth changes; the phase differs between clips.
double goAndStop(double timeS, double phaseS) {
  constexpr double kPeriodS = 6.5;
  const double t = std::fmod(timeS + phaseS, kPeriodS);
  return smoothRamp(t / 1.0) * (1.0 - smoothRamp((t - 3.8) / 1.1));
}

double speedFactor(const PathKind& kind, double timeS, double phaseS) {
  const std::string name = kind.name;
  if (name == "stop-and-go") return goAndStop(timeS, phaseS);
  if (name == "speed-changes") return 1.0 + 0.55 * std::sin(2.0 * M_PI * (timeS + phaseS) / 7.0);
  return 1.0;
}

std::vector<RootFrame> drivenPath(const PathKind& kind, double seconds, uint64_t seed, double fps) {
  const auto noise = [&](uint32_t channel, double scaleS) {
    return SmoothNoise(seed, kPathChannel + channel, scaleS, 0.0, seconds + 1.0);
  };
  const SmoothNoise forward = noise(0, 1.6);
  const SmoothNoise side = noise(1, 1.6);
  const SmoothNoise turn = noise(2, 1.4);
  const RandomKey key{.seed = seed, .sample = kClipChannel, .stage = RandomStage::Walker};
  const double pace = std::exp(0.10 * std::clamp(normalAt(key, 0), -2.0, 2.0));
  const double phaseS = 7.0 * uniformAt(key, 8);
  RootFrame root{.heading = 2.0 * M_PI * uniformAt(key, 9)};
  std::vector<RootFrame> path;
  const int count = std::max(1, static_cast<int>(std::lround(seconds * fps)));
  for (int i = 0; i < count; ++i) {
    path.push_back(root);
    const double t = i / fps;
    const double factor = pace * speedFactor(kind, t, phaseS);
    const double f = (kind.forward * factor + kind.forwardVaries * forward.at(t)) / fps;
    const double s = (kind.side * pace + kind.sideVaries * side.at(t)) / fps;
    const double c = std::cos(root.heading);
    const double n = std::sin(root.heading);
    root.x += c * s + n * f;
    root.z += -n * s + c * f;
    root.heading += (kind.turn + kind.turnVaries * turn.at(t)) / fps;
  }
  return path;
}

}  // namespace

std::vector<WalkerClip> walkerDataSet(int clips, double secondsPerClip, uint64_t seed, double fps) {
  const Place place{.path = "walker data set"};
  if (clips < 1) throwInput(place, "at least one clip", "{}", clips);
  if (!(secondsPerClip > 0.0)) throwInput(place, "a positive duration", "{} s", secondsPerClip);
  const auto& styles = walkerStyles();
  std::vector<WalkerClip> out;
  for (int i = 0; i < clips; ++i) {
    const PathKind& kind = kKinds[i % kKinds.size()];
    // Over a data set every kind meets every style: 14 kinds, 7 styles, one shift per round.
    const size_t round = i / kKinds.size();
    const WalkerStyle& style = styles[(i + round) % styles.size()];
    const uint64_t clipSeed = seed * 1000003ull + static_cast<uint64_t>(i);
    const WalkerOptions options{.style = style.name, .seed = clipSeed, .fps = fps};
    out.push_back(walk(drivenPath(kind, secondsPerClip, clipSeed, fps), options));
    out.back().clip.name = fmt::format("walker-{:03d}-{}-{}", i, kind.name, style.name);
  }
  return out;
}

}  // namespace marey
