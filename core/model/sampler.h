// Many motions from one model along one path.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "base/job.h"
#include "model/motion_model.h"
#include "motion/control/encode_control.h"

namespace marey {

struct SampleRequest {
  /// Root frames at the model's rate, one per frame to keep.
  std::vector<RootFrame> path;
  ControlRequest control = {};  ///< beside the path; without a body it is the model's
  int samples = 1;
  uint64_t seed = 1;
  double temperature = 1.0;
  OptionValues options;  ///< of the model's optionSchema, beside the temperature
  double warmUpS = 1.0;  ///< generated before the first kept frame and dropped
  int firstSample = 0;   ///< number of the first sample: latents depend on it, not on the batch
  /// Poses to start from, [context, D] (the frames before the first kept one);
  /// empty: the mean pose and a warm-up.
  Matrix startPoses;
  Matrix startControl;  ///< [context, C], with startPoses
};

/// The rows [T, C] of a request's path, as the model sees them. Throws InputError where control is
/// missing that the model cannot do without.
Matrix controlOf(const ModelInfo& info, const SampleRequest& request);
/// One of a request's motions as a model sees it.
FeatureSequence sequenceOf(const ModelInfo& info, const SampleRequest& request, int sample,
                           Matrix poses);

/// Called with each frame's poses [samples, D] of one request.
using FrameSink = std::function<void(size_t request, int frame, const Matrix& poses)>;

/// Latent of one sample at one frame: the same bits for any batch size and thread count.
/// `frame` counts from the first generated frame, warm-up included.
void drawLatent(uint64_t seed, int sample, int frame, double temperature, double df,
                std::span<float> out);

/// Which of a model's latents are drawn, and how.
struct LatentDraw {
  uint64_t seed = 1;
  int sample = 0;
  double temperature = 1.0;
  const OptionValues* options = nullptr;  ///< null: none
};
/// That of a frame of a model's motion; the same in every frame where a latent is a clip's.
void drawLatent(const ModelInfo& info, const LatentDraw& draw, int frame, float* out);
/// Throws InputError naming `origin` for what the model's optionSchema does not allow.
void requireDrawable(const ModelInfo& info, double temperature, const OptionValues& options,
                     const std::string& origin);

/// All requests advance together as one batch; results do not depend on which are together.
/// Memory is constant per sample: frames go to `sink` and are not kept.
/// Throws InputError for an empty path or mismatched start poses, CancelledError,
/// NumericError naming sample and frame when a pose is not finite.
void sampleFrames(const MotionModel& model, std::span<const SampleRequest> requests,
                  const FrameSink& sink, Progress& progress);

/// The motions of one request as a model sees them, with the path's control.
std::vector<FeatureSequence> sampleSequences(const MotionModel& model, const SampleRequest& request,
                                             Progress& progress);
/// The motions of every request.
std::vector<std::vector<FeatureSequence>> sampleSequences(const MotionModel& model,
                                                          std::span<const SampleRequest> requests,
                                                          Progress& progress);

/// World motion of a sampled sequence. Throws InputError for a model without a skeleton.
Clip sampledClip(const MotionModel& model, const FeatureSequence& sequence);

/// The motions as clips "sample_000", ... in world coordinates along the path.
std::vector<Clip> sampleClips(const MotionModel& model, const SampleRequest& request,
                              Progress& progress);

/// The request for following a clip's own path and other control, whatever its joints;
/// `startFromClip` takes its first frames as history (the path then begins after them). Throws
/// InputError when the clip is shorter than that needs or, for a start from it, has other joints
/// than the model.
SampleRequest requestAlongClip(const MotionModel& model, const Clip& clip, bool startFromClip);

}  // namespace marey
