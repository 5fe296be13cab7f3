// What a steered motion is made by: options, and a command for every frame.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/json.h"
#include "model/sampling_option.h"
#include "motion/features.h"

namespace marey {

/// Velocities along the way, and where the body looks while it goes there.
struct LiveCommand {
  double forwardMS = 0.0;
  double sidewaysMS = 0.0;  ///< positive: to the left of the way
  double turnRadS = 0.0;    ///< of the way and the body; positive: to the left
  double facingRad = 0.0;   ///< of the body from the way ahead; positive: to the left
  std::string type = {};    ///< label of the motion; empty: none is asked for
  bool operator==(const LiveCommand&) const = default;
};

struct LiveOptions {
  uint64_t seed = 1;
  int sample = 0;
  double temperature = 1.0;
  OptionValues options = {};  ///< of the model's optionSchema, beside the temperature
  double warmUpS = 1.0;       ///< generated under `begin` and dropped, as the sampler does
  double smoothingS = 0.3;  ///< time constant with which the velocity follows the command; 0: none
  LiveCommand begin = {};   ///< velocity at the start
  RootFrame start = {};
  std::vector<std::string> leftOut = {};  ///< channels of control that are left out
};

/// All that a steered motion was made by, besides its model: the same frames come of it again.
struct Steering {
  LiveOptions options;
  std::vector<LiveCommand> commands;  ///< of every frame
};

/// Seed, temperature and options are left out: they stand in the recipe or set that holds a
/// steering. Equal commands in a row are written once, with the number of their frames.
Json toJson(const Steering& steering);
/// Strict: throws InputError naming `prefix` and the key.
Steering steeringFromJson(const Json& value, const std::string& origin, const std::string& prefix);
}  // namespace marey
