#include "model/gradient/training_config.h"

#include <initializer_list>
#include <string_view>

#include "base/error.h"

namespace marey {
namespace {

void require(bool ok, const JsonReader& reader, const char* key, const char* expected,
             double found) {
  if (!ok) throwInput(reader.place(key), expected, "{}", found);
}

void requireOneOf(const JsonReader& reader, const char* key, const std::string& value,
                  std::initializer_list<std::string_view> known) {
  std::string list;
  for (const auto& name : known) {
    if (value == name) return;
    list += (list.empty() ? "" : ", ") + std::string(name);
  }
  throw InputError(reader.place(key), "one of " + list, "'" + value + "'");
}

/// A key that would have no effect is a mistake.
void requireNone(const JsonReader& reader, const char* key, const std::string& unless) {
  if (reader.has(key)) throw InputError(reader.place(key), "no such key but with " + unless, "one");
}

void readOptimiser(JsonReader& reader, TrainingConfig& c) {
  c.optimiser = reader.optional("optimiser", c.optimiser);
  requireOneOf(reader, "optimiser", c.optimiser, {"adam", "rmsprop"});
  if (c.optimiser == "rmsprop")
    c.rmsDecay = reader.optional("rms_decay", c.rmsDecay);
  else
    requireNone(reader, "rms_decay", "optimiser 'rmsprop'");
  require(c.rmsDecay >= 0 && c.rmsDecay < 1, reader, "rms_decay", "a decay in [0, 1)", c.rmsDecay);
  c.clipValue = reader.optional("clip_value", c.clipValue);
  c.clipNorm = reader.optional("clip_norm", c.clipNorm);
  c.ema = reader.optional("ema", c.ema);
  require(c.ema >= 0 && c.ema < 1, reader, "ema", "a decay in [0, 1)", c.ema);
}

/// Of the schedule 'step'.
void readDecay(JsonReader& reader, TrainingConfig& c) {
  if (c.schedule != "step") {
    for (const char* key : {"decay_every_steps", "decay_every_epochs", "decay_factor"})
      requireNone(reader, key, "schedule 'step'");
    return;
  }
  c.decayEverySteps = reader.optional("decay_every_steps", c.decayEverySteps);
  c.decayEveryEpochs = reader.optional("decay_every_epochs", c.decayEveryEpochs);
  c.decayFactor = reader.optional("decay_factor", c.decayFactor);
  const auto whole = [&](const char* key, int64_t value) {
    require(value >= 0, reader, key, "at least 0", static_cast<double>(value));
  };
  whole("decay_every_steps", c.decayEverySteps);
  whole("decay_every_epochs", c.decayEveryEpochs);
  if ((c.decayEverySteps > 0) == (c.decayEveryEpochs > 0))
    throw InputError(reader.place("schedule"),
                     "decay_every_steps or decay_every_epochs with 'step'",
                     c.decayEverySteps > 0 ? "both" : "neither");
  require(c.decayFactor > 0 && c.decayFactor <= 1, reader, "decay_factor", "a factor in (0, 1]",
          c.decayFactor);
}

void readSchedule(JsonReader& reader, TrainingConfig& c) {
  c.learningRate = reader.optional("learning_rate", c.learningRate);
  require(c.learningRate > 0, reader, "learning_rate", "a rate above zero", c.learningRate);
  c.schedule = reader.optional("schedule", c.schedule);
  requireOneOf(reader, "schedule", c.schedule, {"fixed", "noam", "cosine", "linear", "step"});
  c.warmupSteps = reader.optional("warmup_steps", c.warmupSteps);
  require(c.warmupSteps >= 1, reader, "warmup_steps", "at least 1",
          static_cast<double>(c.warmupSteps));
  c.minimumRate = reader.optional("minimum_rate", c.minimumRate);
  require(c.minimumRate >= 0, reader, "minimum_rate", "a rate of zero or more", c.minimumRate);
  readDecay(reader, c);
}

ScheduledSampling scheduledSamplingFrom(JsonReader reader) {
  ScheduledSampling s;
  s.from = reader.optional("from", s.from);
  s.to = reader.required<double>("to");
  s.beginStep = reader.optional("begin_step", s.beginStep);
  s.endStep = reader.required<int64_t>("end_step");
  reader.finish();
  require(s.from >= 0 && s.from <= 1, reader, "from", "a share in [0, 1]", s.from);
  require(s.to >= 0 && s.to <= 1, reader, "to", "a share in [0, 1]", s.to);
  require(s.beginStep >= 0, reader, "begin_step", "at least 0", static_cast<double>(s.beginStep));
  require(s.endStep > s.beginStep, reader, "end_step", "a step after begin_step",
          static_cast<double>(s.endStep));
  return s;
}

/// What the nets are given.
void readInputs(JsonReader& reader, TrainingConfig& c) {
  c.inputNoise = reader.optional("input_noise", c.inputNoise);
  require(c.inputNoise >= 0, reader, "input_noise", "at least 0", c.inputNoise);
  c.inputDropout = reader.optional("input_dropout", c.inputDropout);
  require(c.inputDropout >= 0 && c.inputDropout < 1, reader, "input_dropout", "a share in [0, 1)",
          c.inputDropout);
  c.controlDropout = reader.optional("control_dropout", c.controlDropout);
  require(c.controlDropout >= 0 && c.controlDropout <= 1, reader, "control_dropout",
          "a share in [0, 1]", c.controlDropout);
  if (reader.has("scheduled_sampling"))
    c.scheduledSampling = scheduledSamplingFrom(reader.object("scheduled_sampling"));
}

/// Windows of the data, and how they are dealt out.
void readWindows(JsonReader& reader, TrainingConfig& c) {
  c.windowS = reader.optional("window_s", c.windowS);
  c.hopS = reader.optional("hop_s", c.hopS);
  c.batch = reader.optional("batch", c.batch);
  c.accumulate = reader.optional("accumulate", c.accumulate);
  c.validationShare = reader.optional("validation_share", c.validationShare);
  c.useReversed = reader.optional("use_reversed", c.useReversed);
  require(c.windowS > 0, reader, "window_s", "seconds above zero", c.windowS);
  require(c.hopS > 0, reader, "hop_s", "seconds above zero", c.hopS);
  require(c.batch >= 1, reader, "batch", "at least 1", c.batch);
  require(c.accumulate >= 1 && c.accumulate <= c.batch, reader, "accumulate",
          "from 1 to training.batch", c.accumulate);
  require(c.validationShare >= 0 && c.validationShare < 1, reader, "validation_share",
          "a share in [0, 1)", c.validationShare);
}

/// How long a run is, and what it keeps.
void readRun(JsonReader& reader, TrainingConfig& c) {
  c.steps = reader.optional("steps", c.steps);
  c.checkpointEvery = reader.optional("checkpoint_every", c.checkpointEvery);
  c.snapshotMinutes = reader.optional("snapshot_minutes", c.snapshotMinutes);
  c.keep = reader.optional("keep", c.keep);
  require(c.steps >= 1, reader, "steps", "at least 1", static_cast<double>(c.steps));
  require(c.checkpointEvery >= 1, reader, "checkpoint_every", "at least 1",
          static_cast<double>(c.checkpointEvery));
  require(c.keep >= 0, reader, "keep", "at least 0", c.keep);
}

}  // namespace

TrainingConfig trainingConfigFromJson(const Json& value, const std::string& origin) {
  JsonReader reader(value, origin, "training.");
  TrainingConfig c;
  readWindows(reader, c);
  readOptimiser(reader, c);
  readSchedule(reader, c);
  readInputs(reader, c);
  readRun(reader, c);
  reader.finish();
  return c;
}

Json toJson(const TrainingConfig& c) {
  Json out = {{"window_s", c.windowS},
              {"hop_s", c.hopS},
              {"batch", c.batch},
              {"accumulate", c.accumulate},
              {"optimiser", c.optimiser},
              {"learning_rate", c.learningRate},
              {"schedule", c.schedule},
              {"warmup_steps", c.warmupSteps},
              {"minimum_rate", c.minimumRate},
              {"clip_value", c.clipValue},
              {"clip_norm", c.clipNorm},
              {"input_noise", c.inputNoise},
              {"input_dropout", c.inputDropout},
              {"control_dropout", c.controlDropout},
              {"ema", c.ema},
              {"steps", c.steps},
              {"checkpoint_every", c.checkpointEvery},
              {"validation_share", c.validationShare},
              {"snapshot_minutes", c.snapshotMinutes},
              {"keep", c.keep},
              {"use_reversed", c.useReversed}};
  if (c.optimiser == "rmsprop") out["rms_decay"] = c.rmsDecay;
  if (c.schedule == "step")
    out.update({{"decay_every_steps", c.decayEverySteps},
                {"decay_every_epochs", c.decayEveryEpochs},
                {"decay_factor", c.decayFactor}});
  const ScheduledSampling& s = c.scheduledSampling;
  if (!s.none())
    out["scheduled_sampling"] = {
        {"from", s.from}, {"to", s.to}, {"begin_step", s.beginStep}, {"end_step", s.endStep}};
  return out;
}

Json identityOf(const TrainingConfig& config) {
  Json out = toJson(config);
  for (const char* key : {"steps", "accumulate", "keep"}) out.erase(key);
  return out;
}

}  // namespace marey
