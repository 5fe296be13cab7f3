#include "model/gradient/training_data.h"

#include <cmath>

#include "base/error.h"
#include "model/pose_units.h"

namespace marey {
namespace {

constexpr int kEvaluationFrames = 400;
constexpr int kYardstickOrder = 3;

void requireLongWindows(const TrainableModel& net, int window, const std::string& origin) {
  const int64_t seen = net.context() + net.lookahead();
  if (window - seen < 1)
    throwInput({.path = origin, .item = "key 'training.window_s'"},
               fmt::format("windows longer than the model's context of {} frames", seen),
               "{} frames", window);
}

}  // namespace

TrainingFrames TrainingData::framesFor(const TrainableModel& net) const {
  auto out = train.frames(net.context(), net.lookahead());
  out.noise = noise.deviation();
  return out;
}

TrainingData trainingDataOf(const DataSet& data, const TrainingConfig& config,
                            const TrainableModel& net, torch::Device device,
                            const std::string& origin) {
  const double fps = data.options.features.fps;
  const int window = static_cast<int>(std::lround(config.windowS * fps)),
            hop = std::max(1, static_cast<int>(std::lround(config.hopS * fps))),
            context = static_cast<int>(net.context());
  requireLongWindows(net, window, origin);
  auto [train, valid] = splitValidation(data.train, config.validationShare);
  if (!config.useReversed)
    std::erase_if(train, [](const FeatureSequence& s) { return s.name.ends_with("|reverse"); });
  const auto evaluated =
      [&](const std::vector<FeatureSequence>& sequences) -> std::optional<Batches> {
    if (sequences.empty()) return std::nullopt;
    return Batches(sequences, data.standardiser, kEvaluationFrames + context, kEvaluationFrames,
                   device);
  };
  const auto channels = channelsOf(data.options.features, data.skeleton.get(), data.poseDim());
  TrainingData out{.train = Batches(train, data.standardiser, window, hop, device),
                   .valid = evaluated(valid),
                   .test = evaluated(data.test),
                   .noise = TrainingNoise(net, data.standardiser, floorScales(channels), device),
                   .pace = trainingPace(train, fps),
                   .yardstick = nullptr};
  out.train.hideControl(data.options.features, config.controlDropout);
  if (!out.noise.none())
    out.yardstick = std::make_shared<const LinearGaussian>(
        fitLinearGaussian(train, std::min(kYardstickOrder, context), out.noise.observation().floorM,
                          out.noise.floorScale()));
  return out;
}

}  // namespace marey
