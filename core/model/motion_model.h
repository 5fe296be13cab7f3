// What every family of generative motion models offers to the sampler, the scorer, the
// command line and the window. No libtorch type appears here.
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
#include "motion/features.h"

namespace marey {

/// Mean and standard deviation per dimension, fitted on the augmented training data.
/// Empty: the model works on values that are already standardised.
struct Standardiser {
  std::vector<float> poseMean, poseStd;        ///< [D]
  std::vector<float> controlMean, controlStd;  ///< [C]

  bool empty() const { return poseMean.empty(); }
  /// Added to a log-density of standardised poses it gives that of poses in metres (per frame).
  double logDetPerFrame() const;
};

struct LinearGaussian;  // model/linear_gaussian.h

struct ModelInfo {
  std::string family;   ///< "moglow", ...
  std::string variant;  ///< free name of the configuration, "moglow-small"
  int poseDim = 0, controlDim = 0;
  int context = 0;    ///< tau: past frames that the model sees
  int lookahead = 0;  ///< future control frames that it sees
  int64_t parameters = 0;
  FeatureSpec features;
  std::shared_ptr<const Skeleton> skeleton;  ///< null for models imported without one
  Standardiser standardiser;
  ObservationNoise observation;  ///< through which poses are scored; none in imported models
  /// Fitted on the same training data; null in models that were stored without one.
  std::shared_ptr<const LinearGaussian> yardstick;
  Json config;       ///< hyper-parameters as used
  Json provenance;   ///< data set, steps, metrics, command
  std::string hash;  ///< content hash of the weights
};

/// Recurrent state and pose history of a batch of rollouts. A value: copying it forks the
/// rollout. What it holds belongs to the family that made it.
struct RolloutState {
  std::any value;
};

/// Latents and log-likelihoods of a sequence.
struct SequenceScore {
  Matrix latent;                   ///< [T, D]
  std::vector<double> loglikNats;  ///< [T], density of standardised poses
};

/// Poses [T, D] and controls [context + T + lookahead, C] of a sequence that is being observed.
struct ObservedSequence {
  const Matrix* poses = nullptr;
  const Matrix* controls = nullptr;
  /// [T, D]: what is scored in place of the poses, which stay the history; null: the poses.
  const Matrix* targets = nullptr;
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

/// Thread rule: const functions may run at the same time on different states.
class MotionModel {
 public:
  virtual ~MotionModel() = default;
  virtual const ModelInfo& info() const = 0;

  /// Rollouts whose history is `history` ([B, context * D], oldest frame first, in metres); an
  /// empty matrix stands for the mean pose. Recurrent state is zero.
  virtual RolloutState start(int batch, const Matrix& history) const = 0;
  /// The next pose [B, D] in metres given latents [B, D] of the base distribution and controls
  /// [B, (context + 1 + lookahead) * C], frames t - context .. t + lookahead of frame t.
  virtual Matrix sampleFrame(RolloutState& state, const Matrix& controlWindow,
                             const Matrix& latent) const = 0;
  /// Advances over observed frames: poses [T, D] and controls [context + T + lookahead, C] of a
  /// batch of one, continuing from `state`.
  virtual SequenceScore observe(RolloutState& state, const Matrix& poses,
                                const Matrix& controls) const = 0;
  /// The same for many sequences, each with the state of a batch of one. Where a family has a way
  /// to advance them together it does, and a sequence's result does not depend on the others.
  /// `between` is called every few frames and may throw; the states are then of no use. A family
  /// whose models have observation noise overrides this and heeds `targets`.
  virtual std::vector<SequenceScore> observeMany(std::span<RolloutState> states,
                                                 std::span<const ObservedSequence> sequences,
                                                 const std::function<void()>& between) const;
  /// Degrees of freedom of a Student-t base; 0 for a standard normal.
  virtual double baseDegreesOfFreedom() const = 0;
  /// Weights, standardiser and configuration as they are stored.
  virtual TensorFile save() const = 0;
};

class TrainableModel;  // model/trainable.h: libtorch inside

/// What a new network must know of its data.
struct TraineeData {
  int poseDim = 0, controlDim = 0;
  std::shared_ptr<const Skeleton> skeleton;
  Standardiser standardiser;
};

/// A freshly made network, ready to be trained.
struct Trainee {
  std::shared_ptr<TrainableModel> net;
  Json config;  ///< hyper-parameters as really used
};

/// A family in the explicit list of families (plugins/families.h).
struct ModelFamily {
  std::string name;
  /// From a stored model. Strict: unknown, missing, mis-shaped or non-finite tensors throw
  /// InputError naming `origin`. The file is handed over, so that weights are held once.
  std::function<std::unique_ptr<MotionModel>(TensorFile, const std::string& origin,
                                             const LoadOptions& options)>
      load;
  /// Number of trainable parameters of a configuration, without building data.
  std::function<ModelInfo(const Json& config, const std::string& origin)> describe;
  /// Random weights from `seed`.
  std::function<Trainee(const Json& modelConfig, const std::string& origin, const TraineeData& data,
                        uint64_t seed)>
      makeTrainee;
};

/// Stored models carry "family" in their metadata. Throws InputError for unknown families.
std::unique_ptr<MotionModel> loadModel(const std::string& path,
                                       std::span<const ModelFamily> families,
                                       const LoadOptions& options = {});
const ModelFamily& familyNamed(const std::string& name, std::span<const ModelFamily> families,
                               const std::string& origin);

/// Throws InputError naming `path` unless the clip has the model's joints in the model's order. A
/// model without a skeleton (an imported one) only says how many it has.
void requireSameJoints(const ModelInfo& info, const Clip& clip, const std::string& path);

/// Standardiser, features and skeleton inside stored models and data sets.
void storeCommon(const ModelInfo& info, TensorFile& file);
ModelInfo loadCommon(const TensorFile& file, const std::string& origin);

Json toJson(const FeatureSpec& spec);
FeatureSpec featureSpecFromJson(const Json& value, const std::string& origin);
Json toJson(const Skeleton& skeleton);
std::shared_ptr<const Skeleton> skeletonFromJson(const Json& value, const std::string& origin);

}  // namespace marey
