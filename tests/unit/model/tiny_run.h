// A tiny MoGlow on walker motion, trained for a few steps, that the tests of this folder share.
#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "../base/support.h"

#include "model/gradient/build.h"
#include "moglow/family.h"
#include "motion/walker.h"

namespace marey::test {

inline const std::vector<ModelFamily>& families() {
  static const std::vector<ModelFamily> all{moglow::family()};
  return all;
}

inline std::vector<Clip> walkerClips(int count, double seconds, uint64_t seed) {
  std::vector<Clip> out;
  for (auto& walked : walkerDataSet(count, seconds, seed, 20.0))
    out.push_back(std::move(walked.clip));
  return out;
}

inline const DataSet& tinyData() {
  static const DataSet data = [] {
    Progress progress;
    DataSet out = prepareDataSet(walkerClips(3, 4.0, 2), walkerClips(1, 4.0, 9), {}, progress);
    out.hash = "tiny";
    return out;
  }();
  return data;
}

inline Json tinyConfig() {
  return {{"family", "moglow"},
          {"name", "tiny"},
          {"model",
           {{"tau", 3},
            {"lookahead", 1},
            {"steps", 2},
            {"hidden", 8},
            {"dropout", 0.5},
            {"observation_floor_mm", 0}}},
          {"training",
           {{"window_s", 1.0},
            {"hop_s", 0.5},
            {"batch", 4},
            {"learning_rate", 0.002},
            {"schedule", "cosine"},
            {"warmup_steps", 2},
            {"ema", 0.9},
            {"steps", 6},
            {"checkpoint_every", 3},
            {"validation_share", 0.34}}}};
}

inline TrainRequest tinyRequest(const std::filesystem::path& run) {
  TrainRequest out;
  out.config = tinyConfig();
  out.configOrigin = "tiny.json";
  out.run = run;
  return out;
}

inline TrainResult trainTiny(const TrainRequest& request, const DataSet& data = tinyData()) {
  Progress progress;
  return train(data, request, families(), progress);
}

/// The trained model as stored.
inline const TensorFile& tinyFile() {
  static const TensorFile file = [] {
    const TempFolder folder;
    TrainRequest request = tinyRequest(folder / "run");
    request.steps = 3;
    return readTensorFile(trainTiny(request).last);
  }();
  return file;
}

inline const MotionModel& tinyModel() {
  static const auto model = moglow::family().load(tinyFile(), "tiny.marey", {});
  return *model;
}

}  // namespace marey::test
