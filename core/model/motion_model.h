// What anything that makes motion offers to the sampler, the scorer, the command line and the
// window: facts about itself, and abilities that are there or not. No libtorch type appears here.
#pragma once

#include <any>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/tensor_file.h"
#include "model/observation.h"
#include "model/sampling_option.h"
#include "motion/features.h"

namespace marey {

/// Mean and standard deviation per dimension, fitted on the augmented training data.
/// Empty: the model works on values that are already standardised.
struct Standardiser {
  std::vector<float> poseMean, poseStd;        ///< [D]
  std::vector<float> controlMean, controlStd;  ///< [C]

  bool empty() const { return poseMean.empty(); }
  /// Added to a log-density of standardised poses it gives that of poses in their units (per
  /// frame).
  double logDetPerFrame() const;
};

struct LinearGaussian;  // model/linear_gaussian.h

/// What a motion is drawn from, beside its control.
struct LatentSpec {
  enum class Per { Frame, Clip };

  int width = 0;         ///< values of a draw; 0: none, equal control gives equal motion
  Per per = Per::Frame;  ///< whether every frame has a draw of its own, or a whole motion one
  double degreesOfFreedom = 0.0;  ///< of a Student-t; 0: standard normal

  bool operator==(const LatentSpec&) const = default;
};

/// What a model's log-likelihood is.
enum class DensityKind {
  None,   ///< it has none
  Exact,  ///< the logarithm of its density
  Bound   ///< a lower bound of that
};
/// "none", "exact", "bound".
std::string nameOf(DensityKind kind);

/// A row of a model's card.
struct ModelFact {
  std::string name, value;
  bool operator==(const ModelFact&) const = default;
};

struct ModelInfo {
  std::string family;   ///< as in the list of families
  std::string variant;  ///< free name of the configuration
  int poseDim = 0, controlDim = 0;
  int context = 0;    ///< tau: past frames that the model sees
  int lookahead = 0;  ///< future control frames that it sees
  int64_t parameters = 0;
  LatentSpec latent;
  DensityKind density = DensityKind::None;
  /// What a sampling of it takes. Empty where nothing is drawn.
  std::vector<SamplingOption> optionSchema;
  /// What the family has to say of it on a card, beside what stands here already.
  std::vector<ModelFact> facts;
  bool causal = true;  ///< false: it must know the control of a whole motion before its first frame
  FeatureSpec features;
  std::shared_ptr<const Skeleton> skeleton;  ///< null for models imported without one
  Standardiser standardiser;
  ObservationNoise observation;  ///< through which poses are scored; none in imported models
  /// Fitted on the same training data; null in models that were stored without one.
  std::shared_ptr<const LinearGaussian> yardstick;
  Json config;       ///< hyper-parameters as used
  Json provenance;   ///< data set, steps, metrics, command
  std::string hash;  ///< content hash of the weights

  /// Equal control always gives the same motion.
  bool deterministic() const { return latent.width == 0; }
  /// What its control is made of is known (it is not of all imported models).
  bool knowsControl() const { return features.controlWidth() == controlDim; }
  /// Values of the control that a frame sees: frames t - context .. t + lookahead.
  long controlWindowWidth() const {
    return static_cast<long>(context + 1 + lookahead) * controlDim;
  }
};

/// Recurrent state and pose history of a batch of rollouts. A value: copying it forks the
/// rollout. What it holds belongs to the family that made it.
struct RolloutState {
  std::any value;
};

/// Makes motion frame by frame, from the past alone (beside the control's look-ahead).
/// Thread rule: const functions may run at the same time on different states.
class FrameGenerator {
 public:
  virtual ~FrameGenerator() = default;
  /// Rollouts whose history is `history` ([B, context * D], oldest frame first, in the units of the
  /// representation); an empty matrix stands for the mean pose. Recurrent state is zero.
  virtual RolloutState start(int batch, const Matrix& history) const = 0;
  /// The next pose [B, D] given latents [B, latent.width] and controls
  /// [B, (context + 1 + lookahead) * C], frames t - context .. t + lookahead of frame t. A latent
  /// per clip is the same in every frame.
  virtual Matrix sampleFrame(RolloutState& state, const Matrix& controlWindow,
                             const Matrix& latent) const = 0;
};

/// What a whole motion is made of.
struct ClipRequest {
  Matrix history;   ///< [context, D]; empty: the mean pose
  Matrix controls;  ///< [context + T + lookahead, C]
  Matrix latents;   ///< [T, latent.width], or [1, latent.width] where that is per clip
};

/// Makes whole motions, all of whose control is known.
class ClipGenerator {
 public:
  virtual ~ClipGenerator() = default;
  /// The poses [T, D] of every request; a motion does not depend on the others. `between` is called
  /// now and then and may throw.
  virtual std::vector<Matrix> generate(std::span<const ClipRequest> requests,
                                       const std::function<void()>& between) const = 0;
};

/// Log-likelihoods of a sequence.
struct SequenceScore {
  /// [T, W]: what the poses come from; no columns in families that do not know it.
  Matrix latent;
  std::vector<double> loglikNats;  ///< [T], density of standardised poses
};

/// Poses [T, D] and controls [context + T + lookahead, C] of a sequence that is being observed.
struct ObservedSequence {
  const Matrix* poses = nullptr;
  const Matrix* controls = nullptr;
  /// [T, D]: what is scored in place of the poses, which stay the history; null: the poses.
  const Matrix* targets = nullptr;
};

/// Says how likely motion is, frame by frame. ModelInfo::density tells whether that is exact.
class DensityEstimator {
 public:
  virtual ~DensityEstimator() = default;
  /// As FrameGenerator::start.
  virtual RolloutState start(int batch, const Matrix& history) const = 0;
  /// Advances over observed frames of many sequences, each with the state of a batch of one and
  /// going on from it. A sequence's result does not depend on the others. `between` is called every
  /// few frames and may throw; the states are then of no use.
  virtual std::vector<SequenceScore> observeMany(std::span<RolloutState> states,
                                                 std::span<const ObservedSequence> sequences,
                                                 const std::function<void()>& between) const = 0;
  /// The same for one: poses [T, D] and controls [context + T + lookahead, C].
  SequenceScore observe(RolloutState& state, const Matrix& poses, const Matrix& controls) const;
};

/// A motion of which some values are unknown.
struct CompletionRequest {
  Matrix poses;     ///< [T, D]; what is not known is of no effect
  Matrix known;     ///< [T, D]: 1 where a value is known, else 0
  Matrix controls;  ///< [context + T + lookahead, C]
  Matrix latents;   ///< as ClipRequest::latents
  /// [D]: standard deviation of the noise on known values, in their units; empty: they are exact.
  std::vector<double> noise = {};
};

/// Fills in what is unknown.
class MotionCompleter {
 public:
  virtual ~MotionCompleter() = default;
  /// Whether it takes CompletionRequest::noise.
  virtual bool denoises() const { return false; }
  /// Poses [T, D]: the known values as they were, unless there is noise on them, the others as the
  /// model has them.
  virtual Matrix complete(const CompletionRequest& request,
                          const std::function<void()>& between) const = 0;
};

/// How a model computes. The engine's results are the same bits for any batch and thread count on
/// one machine; the reference is the family's plain libtorch path, which it is tested against;
/// exact is the reference in double precision, the truth of those tests.
enum class Execution { Engine, Reference, Exact };
/// How the engine keeps weights: in 16 bits (bfloat16) they take half the memory and half the time
/// to read, which is what bounds a single motion; results then differ from the model's own.
enum class WeightPrecision { Float32, BFloat16 };
struct LoadOptions {
  Execution execution = Execution::Engine;
  WeightPrecision weights = WeightPrecision::Float32;
};

/// Something that makes motion. Abilities are null where it lacks them; they live as long as it.
class MotionModel {
 public:
  virtual ~MotionModel() = default;
  virtual const ModelInfo& info() const = 0;
  virtual const FrameGenerator* rollout() const { return nullptr; }
  virtual const ClipGenerator* wholeClip() const { return nullptr; }
  virtual const DensityEstimator* density() const { return nullptr; }
  virtual const MotionCompleter* completion() const { return nullptr; }
  /// Weights, standardiser and configuration as they are stored.
  virtual TensorFile save() const = 0;
};

/// The rows of a model's card, as they hold for any family (what is drawn, likelihood, causal, what
/// a frame sees), and then the family's own.
std::vector<ModelFact> factsOf(const ModelInfo& info);

/// Throws InputError naming the model where it lacks the ability.
const FrameGenerator& requireRollout(const MotionModel& model);
const DensityEstimator& requireDensity(const MotionModel& model);

/// Throws InputError naming `path` unless the clip has the model's joints in the model's order. A
/// model without a skeleton (an imported one) only says how many it has.
void requireSameJoints(const ModelInfo& info, const Clip& clip, const std::string& path);

/// A clip as the model sees it: its rate, its representation, its control, and the model's rest
/// pose, or the clip's own where the body is a control. Throws InputError.
FeatureSequence featuresOf(const ModelInfo& info, const Clip& clip);

/// Of stored models, which loadModel checks; those without the key are of version 1.
inline constexpr int kModelVersion = 1;

/// Version, standardiser, features and skeleton inside stored models and data sets.
void storeCommon(const ModelInfo& info, TensorFile& file);
ModelInfo loadCommon(const TensorFile& file, const std::string& origin);

Json toJson(const FeatureSpec& spec);
FeatureSpec featureSpecFromJson(const Json& value, const std::string& origin);
Json toJson(const Skeleton& skeleton);
std::shared_ptr<const Skeleton> skeletonFromJson(const Json& value, const std::string& origin);

}  // namespace marey
