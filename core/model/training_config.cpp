#include "model/training_config.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/error.h"

namespace marey {
namespace {

void require(bool ok, const JsonReader& reader, const char* key, const char* expected,
             double found) {
  if (!ok) throwInput(reader.place(key), expected, "{}", found);
}

}  // namespace

TrainingConfig trainingConfigFromJson(const Json& value, const std::string& origin) {
  JsonReader reader(value, origin, "training.");
  TrainingConfig c;
  c.windowS = reader.optional("window_s", c.windowS);
  c.hopS = reader.optional("hop_s", c.hopS);
  c.batch = reader.optional("batch", c.batch);
  c.accumulate = reader.optional("accumulate", c.accumulate);
  c.learningRate = reader.optional("learning_rate", c.learningRate);
  c.schedule = reader.optional("schedule", c.schedule);
  c.warmupSteps = reader.optional("warmup_steps", c.warmupSteps);
  c.minimumRate = reader.optional("minimum_rate", c.minimumRate);
  c.clipValue = reader.optional("clip_value", c.clipValue);
  c.clipNorm = reader.optional("clip_norm", c.clipNorm);
  c.ema = reader.optional("ema", c.ema);
  c.steps = reader.optional("steps", c.steps);
  c.checkpointEvery = reader.optional("checkpoint_every", c.checkpointEvery);
  c.validationShare = reader.optional("validation_share", c.validationShare);
  c.snapshotMinutes = reader.optional("snapshot_minutes", c.snapshotMinutes);
  c.keep = reader.optional("keep", c.keep);
  c.useReversed = reader.optional("use_reversed", c.useReversed);
  reader.finish();
  require(c.windowS > 0, reader, "window_s", "seconds above zero", c.windowS);
  require(c.hopS > 0, reader, "hop_s", "seconds above zero", c.hopS);
  require(c.batch >= 1, reader, "batch", "at least 1", c.batch);
  require(c.accumulate >= 1 && c.accumulate <= c.batch, reader, "accumulate",
          "from 1 to training.batch", c.accumulate);
  require(c.learningRate > 0, reader, "learning_rate", "a rate above zero", c.learningRate);
  require(c.warmupSteps >= 1, reader, "warmup_steps", "at least 1",
          static_cast<double>(c.warmupSteps));
  require(c.minimumRate >= 0, reader, "minimum_rate", "a rate of zero or more", c.minimumRate);
  require(c.ema >= 0 && c.ema < 1, reader, "ema", "a decay in [0, 1)", c.ema);
  require(c.steps >= 1, reader, "steps", "at least 1", static_cast<double>(c.steps));
  require(c.checkpointEvery >= 1, reader, "checkpoint_every", "at least 1",
          static_cast<double>(c.checkpointEvery));
  require(c.validationShare >= 0 && c.validationShare < 1, reader, "validation_share",
          "a share in [0, 1)", c.validationShare);
  require(c.keep >= 0, reader, "keep", "at least 0", c.keep);
  if (c.schedule != "fixed" && c.schedule != "noam" && c.schedule != "cosine")
    throw InputError(reader.place("schedule"), "fixed, noam or cosine", "'" + c.schedule + "'");
  return c;
}

Json toJson(const TrainingConfig& c) {
  return {{"window_s", c.windowS},
          {"hop_s", c.hopS},
          {"batch", c.batch},
          {"accumulate", c.accumulate},
          {"learning_rate", c.learningRate},
          {"schedule", c.schedule},
          {"warmup_steps", c.warmupSteps},
          {"minimum_rate", c.minimumRate},
          {"clip_value", c.clipValue},
          {"clip_norm", c.clipNorm},
          {"ema", c.ema},
          {"steps", c.steps},
          {"checkpoint_every", c.checkpointEvery},
          {"validation_share", c.validationShare},
          {"snapshot_minutes", c.snapshotMinutes},
          {"keep", c.keep},
          {"use_reversed", c.useReversed}};
}

double learningRateAt(const TrainingConfig& c, int64_t step) {
  const double t = static_cast<double>(step + 1), warm = static_cast<double>(c.warmupSteps);
  if (c.schedule == "noam")
    return std::max(c.minimumRate, c.learningRate * std::sqrt(warm) *
                                       std::min(t * std::pow(warm, -1.5), 1.0 / std::sqrt(t)));
  if (c.schedule == "cosine") {
    if (t < warm) return c.learningRate * t / warm;
    const double done =
        std::min(1.0, (t - warm) / std::max(1.0, static_cast<double>(c.steps) - warm));
    return c.minimumRate +
           0.5 * (c.learningRate - c.minimumRate) * (1.0 + std::cos(std::numbers::pi * done));
  }
  return c.learningRate;
}

}  // namespace marey
