// Documents of every part that an experiment can have, for the fuzzer to start from.
#pragma once

#include <filesystem>

#include "base/json.h"

namespace marey {

inline Json wholeDocument() {
  return {{"title", "Walking"},
          {"notes", ""},
          {"natural", {"walker:4,10,1"}},
          {"systems", {{{"name", "A"}, {"model", "a.marey"}, {"temperature", 0.9}}}},
          {"paths", {{{"name", "ahead"}, {"path", "preset:slow"}, {"seconds", 5.0}}}},
          {"cases",
           {{{"name", "soon"},
             {"task", "predict"},
             {"samples", 2},
             {"options", {{"seed_frames", 20}, {"seconds", 1.5}}}}}},
          {"samples", 2},
          {"held_out_samples", 0},
          {"seed", 7},
          {"fps", 20.0},
          {"feet", "LeftFoot,RightFoot"},
          {"tolerance_step_cm_s", 1.0}};
}

/// Way-points with each of what they may say, and a path that starts from a clip.
inline Json pathKinds() {
  const Json points = {{{"x", 0.0}, {"z", 0.0}, {"speed", 1.2}},
                       {{"x", 0.5}, {"z", 2.0}, {"time", 2.5}, {"facing_deg", 90.0}},
                       {{"x", 1.0}, {"z", 3.0}, {"type", "run"}}};
  return {{{"name", "drawn"}, {"waypoints", points}, {"seconds", 0.0}},
          {{"name", "asked"},
           {"path", "preset:slow"},
           {"seconds", 10.0},
           {"type", "walk"},
           {"signals", {{"speech", "speech.npy"}}},
           {"left_out", {"music"}},
           {"body", "tall.bvh"}},
          {{"name", "followed"}, {"path", "clip:walk.bvh"}, {"start", "clip"}, {"seconds", 3.0}}};
}

inline Json cameraSeed() {
  return {{"eye", {0.0, 1.0, 5.0}},
          {"target", {0.0, 1.0, 0.0}},
          {"up", {0.0, 1.0, 0.0}},
          {"height_m", 2.0},
          {"orthographic", true}};
}

inline Json sceneSeed() {
  return {{"colour_by", "likelihood"},
          {"placement", "side_by_side"},
          {"detail", "lines"},
          {"trails", "feet"},
          {"opacity", 0.5},
          {"ghosts_s", 0.4},
          {"ghost_frames", 3},
          {"trail_s", 2.0},
          {"natural_under", "A"},
          {"contacts", true},
          {"shadow", false},
          {"path", false}};
}

/// A set of samples with every mark, and one of a motion that was steered.
inline Json setKinds() {
  const Json system = {{"name", "A"}, {"model", "a.marey"}, {"temperature", 0.65}};
  const Json drawn = {{"name", "drawn"}, {"path", "preset:fast"}, {"seconds", 4.0}};
  Json command = {
      {"forward_m_s", 1.0}, {"sideways_m_s", 0.1}, {"turn_rad_s", 0.2}, {"facing_rad", 0.3}};
  Json steering = {{"warm_up_s", 1.0},
                   {"smoothing_s", 0.3},
                   {"sample", 0},
                   {"begin", command},
                   {"start", {{"x", 0.5}, {"z", -1.0}, {"heading_rad", 0.2}}}};
  command["frames"] = 3;
  Json turning = command;
  turning["turn_rad_s"] = -0.4;
  steering["commands"] = Json::array({command, turning});
  return {
      {{"system", system},
       {"path", drawn},
       {"samples", 6},
       {"seed", 3},
       {"held_out", true},
       {"pinned", true},
       {"colour", 4},
       {"hidden", {0, 2}},
       {"left_out", {1, 5}}},
      {{"system", system}, {"path", drawn}, {"samples", 1}, {"seed", 4}, {"steering", steering}}};
}

inline Json viewSeed() {
  return {{"path", "drawn"},
          {"not_sampled", {"A"}},
          {"natural", {{{"source", "walker:4,10,1"}, {"clips", {0, 2}}}}},
          {"compare", "held_out"},
          {"scene", sceneSeed()},
          {"camera", cameraSeed()},
          {"follow", true},
          {"cameras", {{"1", cameraSeed()}, {"9", cameraSeed()}}},
          {"training_run", "runs/small"},
          {"sets", setKinds()}};
}

/// A document with all parts that are optional.
inline Json richDocument() {
  Json out = wholeDocument();
  for (const Json& path : pathKinds()) out["paths"].push_back(path);
  out["version"] = 1;
  out["systems"][0]["options"] = {{"decoder_noise", 0.0}};
  out["against"] = "same-control";
  out["natural_left_out"] = {"walk_001", "walk_002"};
  out["view"] = viewSeed();
  return out;
}

/// A configuration's training, every key but those that stand in for another.
inline Json trainingSeed() {
  return {{"training",
           {{"window_s", 2.0},
            {"hop_s", 1.0},
            {"batch", 8},
            {"accumulate", 2},
            {"learning_rate", 1e-3},
            {"optimiser", "rmsprop"},
            {"rms_decay", 0.9},
            {"schedule", "step"},
            {"decay_every_steps", 20},
            {"decay_factor", 0.5},
            {"warmup_steps", 10},
            {"minimum_rate", 1e-5},
            {"clip_value", 5.0},
            {"clip_norm", 100.0},
            {"ema", 0.9},
            {"input_noise", 0.1},
            {"input_dropout", 0.1},
            {"scheduled_sampling",
             {{"from", 0.1}, {"to", 0.5}, {"begin_step", 1}, {"end_step", 50}}},
            {"steps", 100},
            {"checkpoint_every", 5},
            {"keep", 4},
            {"validation_share", 0.1},
            {"snapshot_minutes", 3},
            {"use_reversed", false}}}};
}

}  // namespace marey
