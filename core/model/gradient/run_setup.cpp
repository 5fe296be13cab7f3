#include "model/gradient/run_setup.h"

#include "base/error.h"
#include "model/gradient/input_noise.h"
#include "model/gradient/schedules.h"

namespace marey {
namespace {

/// Processes on one machine take its CUDA devices in turn.
torch::Device deviceOf(const TrainRequest& request) {
  if (request.device == "cpu") return torch::kCPU;
  if (request.device != "cuda")
    throw UsageError("--device: expected cpu or cuda, found '" + request.device + "'");
  if (!torch::cuda::is_available())
    throw UsageError("--device cuda: this libtorch sees no CUDA device");
  const auto count = static_cast<int>(torch::cuda::device_count());
  return {torch::kCUDA, static_cast<c10::DeviceIndex>(request.process.rank % count)};
}

Trainee traineeOf(const DataSet& data, const TrainRequest& request, const ModelFamily& family) {
  return family.makeTrainee(
      request.config.at("model"), request.configOrigin,
      {data.poseDim(), data.controlDim(), data.skeleton, data.standardiser, data.options.features},
      request.seed);
}

}  // namespace

RunSetup::RunSetup(const DataSet& givenData, const TrainRequest& givenRequest,
                   const ModelFamily& givenFamily)
    : data(givenData),
      request(givenRequest),
      family(givenFamily),
      config(trainingConfigFromJson(request.config.value("training", Json::object()),
                                    request.configOrigin)),
      device(deviceOf(request)),
      group(nn::joinProcesses(
          request.process,
          nn::meetingPoint(std::filesystem::weakly_canonical(request.run).string()))),
      trainee(traineeOf(data, request, family)),
      objective(trainee.net->objective()),
      training(trainingDataOf(data, config, *trainee.net, device, request.configOrigin)) {
  requireSuitedInputs(config, net(), request.configOrigin);
}

double RunSetup::learningRateAt(int64_t step) const {
  return marey::learningRateAt(config, step, training.train.windowCount());
}

Json RunSetup::identity() const {
  return {{"data", data.hash},
          {"seed", request.seed},
          {"training", identityOf(config)},
          {"model", trainee.config}};
}

}  // namespace marey
