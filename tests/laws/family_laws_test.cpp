// What holds of anything that makes motion: one suite over every family in the list and a toy that
// the core does not know. Nothing here names a family.
#include <cmath>
#include <set>

#include "../unit/base/support.h"
#include "law_models.h"

#include "base/error.h"
#include "model/sampler.h"
#include "model/scorer.h"
#include "motion/representation/representation.h"
#include "motion/walker.h"
#include "nn/engine/team.h"

namespace marey {
namespace {

using test::law::allFamilies;
using test::law::allSystems;
using test::law::data;
using test::law::Made;
using test::law::madeBy;
using test::law::requestOf;
using test::law::systemName;
using test::law::walks;

SampleRequest turning(int samples, int first = 0) {
  SampleRequest out{.path = {}, .samples = samples, .seed = 3, .warmUpS = 0.5};
  out.firstSample = first;
  for (int t = 0; t < 20; ++t) out.path.push_back({0.01 * t, 0.05 * t, 0.03 * t});
  return out;
}

std::vector<Matrix> posesOf(const MotionModel& model, const SampleRequest& request) {
  Progress progress;
  std::vector<Matrix> out;
  for (auto& sequence : sampleSequences(model, request, progress))
    out.push_back(std::move(sequence.pose));
  return out;
}

class FamilyLaws : public testing::TestWithParam<ModelFamily> {
 protected:
  const ModelFamily& family() const { return GetParam(); }
  std::unique_ptr<MotionModel> model(Execution execution = Execution::Engine) const {
    return family().load(madeBy(family()).file, "law.marey", {.execution = execution});
  }
  std::string failureOf(TensorFile file) const {
    try {
      family().load(std::move(file), "law.marey", {});
    } catch (const InputError& e) {
      return e.what();
    }
    return {};
  }
};

TEST_P(FamilyLaws, SaysWhatItIsAndWhatItCanDo) {
  const auto one = model();
  const ModelInfo& info = one->info();
  EXPECT_EQ(info.family, family().name);
  EXPECT_FALSE(family().title.empty());
  EXPECT_EQ(info.poseDim, data().poseDim());
  EXPECT_EQ(info.controlDim, data().controlDim());
  EXPECT_GT(info.parameters, 0);
  EXPECT_TRUE(one->rollout() != nullptr || one->wholeClip() != nullptr);
  EXPECT_EQ(info.causal, one->rollout() != nullptr);
  EXPECT_EQ(info.density != DensityKind::None, one->density() != nullptr);
  EXPECT_EQ(info.features, data().options.features);
  // A configuration says the same as the model that comes of it.
  const ModelInfo described = family().describe(info.config, "law.marey");
  EXPECT_EQ(described.parameters, info.parameters);
  EXPECT_EQ(described.latent, info.latent);
  EXPECT_EQ(described.context, info.context);
  EXPECT_EQ(described.lookahead, info.lookahead);
  EXPECT_EQ(described.causal, info.causal);
  EXPECT_EQ(described.density, info.density);
  EXPECT_EQ(described.optionSchema, info.optionSchema);
  EXPECT_EQ(described.facts, info.facts);
}

TEST_P(FamilyLaws, HasFactsForItsCard) {
  const auto one = model();
  EXPECT_FALSE(one->info().facts.empty());
  std::set<std::string> names;
  for (const auto& [name, value] : factsOf(one->info())) {
    EXPECT_TRUE(names.insert(name).second) << name << " twice";
    EXPECT_FALSE(value.empty()) << name;
  }
  for (const char* name : {"sees", "causal", "latent", "likelihood"})
    EXPECT_TRUE(names.contains(name)) << name;
}

TEST_P(FamilyLaws, DeclaresWhatASamplingTakes) {
  const auto one = model();
  const ModelInfo& info = one->info();
  EXPECT_EQ(info.optionSchema.empty(), info.deterministic());
  std::set<std::string> names;
  for (const SamplingOption& o : info.optionSchema) {
    EXPECT_TRUE(names.insert(o.name).second) << o.name << " twice";
    EXPECT_FALSE(o.title.empty() || o.about.empty()) << o.name;
    EXPECT_TRUE(o.low <= o.fallback && o.fallback <= o.high) << o.name;
    EXPECT_TRUE(o.first >= 0 && o.count > 0 && o.first + o.count <= info.latent.width) << o.name;
  }
}

SampleRequest withOption(const std::string& name, double value) {
  SampleRequest out = turning(2);
  if (name == "temperature")
    out.temperature = value;
  else
    out.options[name] = value;
  return out;
}

TEST_P(FamilyLaws, EveryOptionHasAnEffectAndARange) {
  const auto one = model();
  const auto usual = posesOf(*one, turning(2));
  for (const SamplingOption& o : one->info().optionSchema) {
    EXPECT_TRUE(posesOf(*one, withOption(o.name, o.fallback)) == usual) << o.name;
    EXPECT_FALSE(posesOf(*one, withOption(o.name, o.low)) == usual) << o.name;
    for (const double bad : {o.low - 1.0, o.high + 1.0, std::nan("")})
      EXPECT_THROW(posesOf(*one, withOption(o.name, bad)), InputError) << o.name << " " << bad;
  }
  const auto message =
      test::messageOf<InputError>([&] { posesOf(*one, withOption("warmth", 0.5)); });
  EXPECT_NE(message.find("warmth"), std::string::npos) << message;
  for (const SamplingOption& o : one->info().optionSchema)
    EXPECT_NE(message.find(o.name), std::string::npos) << message;
}

TEST_P(FamilyLaws, LearnsInTwentyStepsWhereItIsTrained) {
  const Made& made = madeBy(family());
  if (!family().makeTrainee) {
    EXPECT_EQ(made.result.steps, 0);
    EXPECT_TRUE(static_cast<bool>(family().build));
    return;
  }
  EXPECT_EQ(made.result.steps, 20);
  ASSERT_EQ(made.losses.size(), 2U);
  EXPECT_LT(made.losses[1], made.losses[0]);
  EXPECT_FALSE(made.result.objective.name.empty());
  EXPECT_FALSE(made.result.objective.unit.empty());
  EXPECT_EQ(std::isnan(made.result.testNatsPerFrame), !made.result.objective.likelihood);
}

TEST_P(FamilyLaws, GivesTheSameBitsInAnyCompanyAndFromAnyFile) {
  const auto one = model();
  const auto all = posesOf(*one, turning(5));
  const auto some = posesOf(*one, turning(2, 2));
  EXPECT_TRUE(all[2] == some[0]);
  EXPECT_TRUE(all[3] == some[1]);
  {
    const nn::OneThread alone;
    EXPECT_TRUE(posesOf(*one, turning(5)) == all);
  }
  const auto again = family().load(one->save(), "again.marey", {});
  EXPECT_TRUE(posesOf(*again, turning(5)) == all);
}

TEST_P(FamilyLaws, DiffersFromSampleToSampleUnlessItDrawsNothing) {
  const auto one = model();
  const auto motions = posesOf(*one, turning(2));
  ASSERT_TRUE(motions[0].allFinite());
  EXPECT_EQ(motions[0] == motions[1], one->info().deterministic());
  if (!one->info().deterministic()) return;
  SampleRequest cooled = turning(1);
  cooled.temperature = 0.5;
  EXPECT_THROW(posesOf(*one, cooled), InputError);
}

TEST_P(FamilyLaws, FollowsItsControl) {
  const auto one = model();
  SampleRequest still = turning(1);
  for (RootFrame& frame : still.path) frame = {};
  EXPECT_FALSE(posesOf(*one, turning(1)) == posesOf(*one, still));
}

TEST_P(FamilyLaws, AgreesWithItsPlainPath) {
  const auto fast = posesOf(*model(), turning(2)),
             plain = posesOf(*model(Execution::Reference), turning(2));
  for (size_t b = 0; b < fast.size(); ++b)
    EXPECT_LT((fast[b] - plain[b]).cwiseAbs().maxCoeff(), 1e-3F) << "metres";
}

/// Of families that keep weights in 16 bits: those that have an engine for them, hence a gradient.
TEST_P(FamilyLaws, RoundsItsWeightsWhereItIsAskedTo) {
  if (!family().makeTrainee) return;
  const auto rounded =
      family().load(madeBy(family()).file, "law.marey", {.weights = WeightPrecision::BFloat16});
  const auto whole = posesOf(*model(), turning(1)), near = posesOf(*rounded, turning(1));
  EXPECT_FALSE(near == whole);
  EXPECT_LT((near[0] - whole[0]).cwiseAbs().maxCoeff(), 0.5F) << "metres";
}

TEST_P(FamilyLaws, ForksByCopyingItsState) {
  const auto one = model();
  const ModelInfo& info = one->info();
  if (one->rollout() == nullptr) return;
  const FrameGenerator& generator = *one->rollout();
  RolloutState state = generator.start(2, {});
  const Matrix control = Matrix::Constant(2, info.controlWindowWidth(), 0.03F),
               latent = Matrix::Constant(2, info.latent.width, 0.5F);
  for (int t = 0; t < 3; ++t) generator.sampleFrame(state, control, latent);
  RolloutState fork = state;
  const Matrix next = generator.sampleFrame(state, control, latent);
  generator.sampleFrame(state, -control, latent);
  EXPECT_TRUE(generator.sampleFrame(fork, control, latent) == next);
}

TEST_P(FamilyLaws, RefusesWhatDoesNotFit) {
  const auto one = model();
  const ModelInfo& info = one->info();
  if (one->rollout() != nullptr) {
    RolloutState state = one->rollout()->start(2, {});
    const Matrix latent = Matrix::Zero(2, info.latent.width);
    EXPECT_THROW(
        one->rollout()->sampleFrame(state, Matrix::Zero(2, info.controlWindowWidth() + 1), latent),
        InputError);
    EXPECT_THROW(one->rollout()->sampleFrame(state, Matrix::Zero(2, info.controlWindowWidth()),
                                             Matrix::Zero(2, info.latent.width + 1)),
                 InputError);
    EXPECT_THROW(one->rollout()->start(2, Matrix::Zero(2, info.context * info.poseDim + 1)),
                 InputError);
  }
  Clip other = walks(1, 4.0, 5).front();
  auto renamed = std::make_shared<Skeleton>(*other.skeleton);
  renamed->names[3] = "Elsewhere";
  other.skeleton = renamed;
  EXPECT_THROW(requireSameJoints(info, other, "other.bvh"), InputError);
}

TEST_P(FamilyLaws, RefusesDamagedFilesAndNamesWhatIsWrong) {
  const TensorFile& whole = madeBy(family()).file;
  std::string name;
  for (const auto& [key, tensor] : whole.tensors)
    if (key.starts_with("weights/") && tensor.count() > 1) name = key;
  ASSERT_FALSE(name.empty());
  const std::string own = name.substr(std::string("weights/").size());
  TensorFile missing = whole;
  missing.tensors.erase(name);
  EXPECT_NE(failureOf(missing).find(own), std::string::npos) << failureOf(missing);
  TensorFile notFinite = whole;
  auto values = notFinite.tensors.at(name).toFloats();
  values.back() = std::nanf("");
  notFinite.tensors[name] = Tensor::fromFloats(notFinite.tensors.at(name).shape, values.data());
  EXPECT_NE(failureOf(notFinite).find(own), std::string::npos) << failureOf(notFinite);
  TensorFile extra = whole;
  extra.tensors["weights/elsewhere"] = whole.tensors.at(name);
  EXPECT_NE(failureOf(extra).find("elsewhere"), std::string::npos) << failureOf(extra);
  TensorFile unknown = whole;
  unknown.metadata["config"]["elsewhere"] = 1;
  EXPECT_NE(failureOf(unknown).find("elsewhere"), std::string::npos) << failureOf(unknown);
}

std::string failureOfTraining(const ModelFamily& family, const Json& config, const DataSet& set) {
  const test::TempFolder folder;
  TrainRequest request = requestOf(family, folder / "run");
  request.config = config;
  Progress progress;
  try {
    train(set, request, allFamilies(), progress);
  } catch (const InputError& e) {
    return e.what();
  }
  return {};
}

TEST_P(FamilyLaws, RefusesConfigurationsAndDataThatAreWrong) {
  const Json good = family().example;
  Json misspelt = good;
  misspelt["trainning"] = Json::object();
  EXPECT_NE(failureOfTraining(family(), misspelt, data()).find("trainning"), std::string::npos);
  Json unknown = good;
  unknown["model"]["elsewhere"] = 1;
  EXPECT_NE(failureOfTraining(family(), unknown, data()).find("elsewhere"), std::string::npos);
  Json otherSize = good;
  otherSize["model"]["pose_dim"] = data().poseDim() + 3;
  EXPECT_NE(failureOfTraining(family(), otherSize, data()).find("pose_dim"), std::string::npos);
  Json later = good;
  later["version"] = kConfigVersion + 1;
  EXPECT_NE(failureOfTraining(family(), later, data()).find("version"), std::string::npos);
}

TEST_P(FamilyLaws, NamesTheSequenceThatIsNotFinite) {
  DataSet broken = data();
  broken.train[1].pose(2, 4) = std::nanf("");
  const std::string why = failureOfTraining(family(), family().example, broken);
  EXPECT_NE(why.find(broken.train[1].name), std::string::npos) << why;
}

TEST_P(FamilyLaws, CanBeCancelled) {
  const auto one = model();
  std::stop_source stop;
  stop.request_stop();
  Progress cancelled({}, stop.get_token());
  EXPECT_THROW(sampleSequences(*one, turning(2), cancelled), CancelledError);
  const test::TempFolder folder;
  EXPECT_THROW(train(data(), requestOf(family(), folder / "run"), allFamilies(), cancelled),
               CancelledError);
}

TEST_P(FamilyLaws, ScoresOrSaysThatItCannot) {
  const auto one = model();
  const auto clips = walks(2, 3.0, 7);
  Progress progress;
  const auto scores = scoreClips(*one, clips, false, progress);
  ASSERT_EQ(scores.size(), clips.size());
  for (const ClipScore& score : scores) {
    EXPECT_FALSE(score.tooShort());
    EXPECT_EQ(score.loglikNats.empty(), one->density() == nullptr);
    EXPECT_EQ(std::isfinite(score.meanNatsPerFrame()), one->density() != nullptr);
  }
  if (one->density() != nullptr) return;
  EXPECT_THROW(requireDensity(*one), InputError);
}

TEST_P(FamilyLaws, LeavesWhatIsKnownAsItIs) {
  const auto one = model();
  if (one->completion() == nullptr) return;
  const FeatureSequence f = extractFeatures(walks(1, 2.0, 3).front(), one->info().features);
  CompletionRequest request{.poses = f.pose,
                            .known = Matrix::Ones(f.pose.rows(), f.pose.cols()),
                            .controls = f.control,
                            .latents = Matrix::Zero(f.pose.rows(), one->info().latent.width)};
  EXPECT_TRUE(one->completion()->complete(request, [] {}) == f.pose);
  request.known.rightCols(6).setZero();
  const Matrix filled = one->completion()->complete(request, [] {});
  EXPECT_TRUE(filled.leftCols(f.pose.cols() - 6) == f.pose.leftCols(f.pose.cols() - 6));
  EXPECT_TRUE(filled.allFinite());
  // What is hidden is of no effect.
  request.poses.rightCols(6).setConstant(1e3F);
  EXPECT_TRUE(one->completion()->complete(request, [] {}) == filled);
}

/// A model that needs one representation says which `--layout` it wants.
TEST_P(FamilyLaws, WorksInEveryRepresentationOrSaysWhichItNeeds) {
  int worked = 0;
  for (const Representation& poses : representations()) {
    SCOPED_TRACE(poses.name);
    Progress progress;
    PrepareOptions options;
    options.features.layout = poses.name;
    const DataSet set = prepareDataSet(walks(2, 4.0, 2), {}, options, progress);
    const test::TempFolder folder;
    TrainRequest request = requestOf(family(), folder / "run");
    if (request.steps) request.steps = 2;
    TrainResult made;
    try {
      made = train(set, request, allFamilies(), progress);
    } catch (const InputError& e) {
      EXPECT_NE(std::string(e.what()).find("--layout"), std::string::npos) << e.what();
      continue;
    }
    ++worked;
    const auto one = loadModel(made.last.string(), allFamilies());
    EXPECT_EQ(one->info().features.layout, poses.name);
    EXPECT_EQ(one->info().poseDim, poses.width(*walkerSkeleton()));
    const Clip clip = sampleClips(*one, turning(1), progress).front();
    EXPECT_EQ(clip.transforms.has_value(), poses.rotations);
    EXPECT_NO_THROW(validate(clip));
    const auto score = scoreClips(*one, walks(1, 3.0, 7), false, progress).front();
    EXPECT_EQ(score.unit, "nats per frame, " + poses.shownUnits);
    EXPECT_EQ(std::isfinite(score.meanNatsPerFrame()), one->density() != nullptr);
  }
  EXPECT_GE(worked, 1);
}

INSTANTIATE_TEST_SUITE_P(Every, FamilyLaws, testing::ValuesIn(allSystems()),
                         [](const auto& info) { return systemName(info.param); });

}  // namespace
}  // namespace marey
