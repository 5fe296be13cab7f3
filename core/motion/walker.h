// The procedural walker: Marey's own motion data with known ground truth. A 21-joint person
// walks any path with planted feet (exactly zero foot speed in contact), analytic leg IK and
// several gait styles with continuous, correlated variation.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "motion/clip.h"
#include "motion/features.h"

namespace marey {

/// A gait. Values are means; each clip and step varies about them.
struct WalkerStyle {
  std::string name;
  double strideScale = 1.0;   ///< step length against the default for the speed
  double stanceShare = 0.62;  ///< part of a gait cycle that a foot is planted (walking)
  double armSwing = 0.38;     ///< radians, amplitude at the shoulder at 1.3 m/s
  double lean = 0.05;         ///< radians, forward
  double stepHeightM = 0.10;
  double stepWidthM = 0.16;
  double bounceM = 0.02;  ///< vertical hip amplitude
  double crouchM = 0.02;  ///< how much lower than standing the hips are carried
};
const std::vector<WalkerStyle>& walkerStyles();

struct WalkerOptions {
  std::string style = "normal";
  uint64_t seed = 1;
  double fps = 60.0;
  double noise = 1.0;  ///< scales the correlated noise of arms, trunk and head
};

/// A planted interval of one foot.
struct Contact {
  int joint = 0;  ///< the ankle joint
  double beginS = 0.0, endS = 0.0;
};

struct WalkerTruth {
  std::vector<Contact> contacts;    ///< ordered by begin
  std::vector<double> stepTimesS;   ///< from one touch-down to the next (other foot)
  std::vector<float> boneLengthsM;  ///< per bone of Skeleton::bones()
};

struct WalkerClip {
  Clip clip;
  WalkerTruth truth;
};

std::shared_ptr<const Skeleton> walkerSkeleton();

/// Walks the path (root frames at options.fps); the clip's label is the style. A contact's ankle
/// stays where it landed, bit for bit. Throws InputError on an empty path or unknown style.
WalkerClip walk(const std::vector<RootFrame>& path, const WalkerOptions& options);

/// The data of the demo and of tests: clips of varied paths, speeds and styles. Deterministic.
/// Every kind of control of the papers appears: standing, slow, fast, sideways, backward, turning.
std::vector<WalkerClip> walkerDataSet(int clips, double secondsPerClip, uint64_t seed,
                                      double fps = 60.0);

}  // namespace marey
