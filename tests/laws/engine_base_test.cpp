// Models with a base below the flow ('MG+') on the engine: as the plain path has them, and the same
// bits for any batch, position in it, company and number of threads.
#include <algorithm>
#include <map>
#include <string>

#include "laws/engine_support.h"
#include <gtest/gtest.h>

#include "base/random.h"
#include "model/gradient/model_bench.h"
#include "moglow/family.h"
#include "nn/torch/threads.h"

namespace marey {
namespace {

/// Few: a base picks regimes and holds feet by thresholds, and once two paths differ in such a
/// choice they are two motions.
constexpr int kFrames = 8;
constexpr uint32_t kWatched = 7;  ///< the sample that appears in every batch

/// The base's tensors are zero until they are fitted: here they move every pose.
TensorFile linearFile() {
  TensorFile file = randomModel({{"pose_dim", 12},
                                 {"tau", 4},
                                 {"steps", 2},
                                 {"hidden", 20},
                                 {"pose_base", "linear"},
                                 {"observation_floor_mm", 0}},
                                "linear", moglow::family(), 1);
  for (const char* name : {"weights/base.weight", "weights/base.bias"}) {
    Tensor& tensor = file.tensors.at(name);
    auto values = tensor.toFloats();
    fillNormal({.seed = 8, .stage = RandomStage::Test}, values);
    for (float& v : values) v *= 0.05f;
    tensor = Tensor::fromFloats(tensor.shape, values.data());
  }
  return file;
}

TensorFile fileOf(const std::string& name) {
  if (name == "linear") return linearFile();
  const std::string resources = MAREY_SOURCE_DIR "/resources/";
  return readTensorFile(resources +
                        (name == "demo" ? "demo/demo.marey" : "models/moglow-plus-small.marey"));
}

std::unique_ptr<MotionModel> modelOf(const std::string& name, Execution execution) {
  return moglow::family().load(fileOf(name), name, {.execution = execution});
}

/// Noise around the control that the model was trained on.
void fillControl(const ModelInfo& info, uint32_t sample, uint32_t frame, std::span<float> out) {
  fillNormal({.seed = 3, .sample = sample, .frame = frame, .stage = RandomStage::Test}, out);
  const Standardiser& s = info.standardiser;
  if (s.empty()) return;
  for (size_t i = 0; i < out.size(); ++i) {
    const size_t j = i % s.controlMean.size();
    out[i] = s.controlMean[j] + 0.5f * s.controlStd[j] * out[i];
  }
}

/// What a sample gets depends on its number alone.
std::vector<Matrix> rollout(const MotionModel& model, const std::vector<uint32_t>& samples,
                            int frames = kFrames) {
  const ModelInfo& info = model.info();
  const auto rows = static_cast<long>(samples.size());
  RolloutState state = model.rollout()->start(static_cast<int>(rows), {});
  std::vector<Matrix> out;
  for (uint32_t t = 0; t < static_cast<uint32_t>(frames); ++t) {
    Matrix control(rows, (info.context + 1L + info.lookahead) * info.controlDim),
        latent(rows, info.poseDim);
    for (long b = 0; b < rows; ++b) {
      const uint32_t sample = samples[static_cast<size_t>(b)];
      fillControl(info, sample, t, {control.row(b).data(), static_cast<size_t>(control.cols())});
      fillNormal({.seed = 4, .sample = sample, .frame = t, .stage = RandomStage::Test},
                 {latent.row(b).data(), static_cast<size_t>(latent.cols())});
    }
    out.push_back(model.rollout()->sampleFrame(state, control, latent));
  }
  return out;
}

std::vector<uint32_t> samplesWith(uint32_t count, size_t place) {
  std::vector<uint32_t> out(count);
  for (uint32_t i = 0; i < count; ++i) out[i] = 100 + i;
  out[place] = kWatched;
  return out;
}

/// Poses that the model itself made, and a control.
std::vector<Sequence> sequencesOf(const MotionModel& model, const std::vector<uint32_t>& samples) {
  const ModelInfo& info = model.info();
  const auto frames = rollout(model, samples);
  std::vector<Sequence> out;
  for (size_t b = 0; b < samples.size(); ++b) {
    const long length = kFrames - static_cast<long>(b % 3);
    Sequence s{Matrix(length, info.poseDim),
               Matrix(length + info.context + info.lookahead, info.controlDim)};
    for (long t = 0; t < length; ++t)
      s.poses.row(t) = frames[static_cast<size_t>(t)].row(static_cast<long>(b));
    fillControl(info, samples[b], 1000,
                {s.controls.data(), static_cast<size_t>(s.controls.size())});
    out.push_back(std::move(s));
  }
  return out;
}

/// Sets the threads and puts one per core back.
class Threads {
 public:
  explicit Threads(int count) { nn::configureThreads(count, true); }
  ~Threads() { nn::configureThreads(0, true); }
};

class Bases : public testing::TestWithParam<std::string> {};

/// Rows of which rounding alone may decide which regime or how firm a foot: where one draw of the
/// truth goes another way than the truth, by more than a millimetre. They say nothing of an engine.
class Undecided {
 public:
  static constexpr float kApart = 1e-3f;

  /// Whether a row whose limit is known decides.
  bool decides(float limit) {
    ++m_rows;
    if (limit < kApart) return true;
    ++m_undecided;
    return false;
  }
  double share() const { return static_cast<double>(m_undecided) / m_rows; }

 private:
  int m_rows = 0, m_undecided = 0;
};

TEST_P(Bases, SamplesAsThePlainPathDoes) {
  const Threads set(1);
  const auto fast = modelOf(GetParam(), Execution::Engine);
  const Truth truth(fileOf(GetParam()));
  const auto samples = samplesWith(12, 5);
  const auto got = rollout(*fast, samples), wanted = rollout(truth.exact(), samples);
  std::vector<std::vector<Matrix>> draws(kFrames);
  for (uint32_t draw = 1; draw <= Truth::kDraws; ++draw) {
    const auto rolled = rollout(truth.changed(draw), samples);
    for (size_t t = 0; t < draws.size(); ++t) draws[t].push_back(rolled[t]);
  }
  Undecided undecided;
  for (size_t t = 0; t < got.size(); ++t) {
    ASSERT_TRUE(wanted[t].allFinite());
    const Eigen::VectorXf limits = rowLimits(wanted[t], draws[t]);
    for (long b = 0; b < limits.size(); ++b)
      if (undecided.decides(limits(b))) {
        EXPECT_LE((got[t].row(b) - wanted[t].row(b)).cwiseAbs().maxCoeff(), limits(b))
            << "frame " << t << ", sample " << b;
      }
  }
  EXPECT_LE(undecided.share(), 0.05);
  EXPECT_GT((wanted.back().row(0) - wanted.back().row(1)).cwiseAbs().maxCoeff(), 1e-3f)
      << "samples are all the same";
}

/// From the plain path's past, so that a choice in which the two once differ does not go on: every
/// frame alone has to be the same.
TEST_P(Bases, MakesEveryOfFiftyFramesFromThePlainPathsPast) {
  constexpr long kRows = 50;
  const Threads set(1);
  const auto fast = modelOf(GetParam(), Execution::Engine);
  const Truth truth(fileOf(GetParam()));
  const ModelInfo& info = fast->info();
  const long past = info.context, d = info.poseDim;
  const auto made = rollout(truth.exact(), {1}, static_cast<int>(kRows + past));
  Matrix history(kRows, past * d), control(kRows, (past + 1 + info.lookahead) * info.controlDim),
      latent(kRows, d);
  for (long t = 0; t < kRows; ++t) {
    for (long lag = 0; lag < past; ++lag)
      history.block(t, lag * d, 1, d) = made[static_cast<size_t>(t + lag)];
    fillControl(info, 1, static_cast<uint32_t>(t + past),
                {control.row(t).data(), static_cast<size_t>(control.cols())});
  }
  fillNormal({.seed = 6, .stage = RandomStage::Test},
             {latent.data(), static_cast<size_t>(latent.size())});
  const auto next = [&](const MotionModel& model) {
    RolloutState state = model.rollout()->start(kRows, history);
    return model.rollout()->sampleFrame(state, control, latent);
  };
  const Matrix got = next(*fast), wanted = next(truth.exact());
  ASSERT_TRUE(wanted.allFinite());
  std::vector<Matrix> draws;
  for (uint32_t draw = 1; draw <= Truth::kDraws; ++draw) draws.push_back(next(truth.changed(draw)));
  const Eigen::VectorXf limits = rowLimits(wanted, draws);
  Undecided undecided;
  for (long t = 0; t < kRows; ++t)
    if (undecided.decides(limits(t))) {
      EXPECT_LE((got.row(t) - wanted.row(t)).cwiseAbs().maxCoeff(), limits(t)) << "frame " << t;
    }
  EXPECT_LE(undecided.share(), 0.05);
}

TEST_P(Bases, ScoresAsThePlainPathDoes) {
  const Threads set(1);
  const auto fast = modelOf(GetParam(), Execution::Engine);
  const Truth truth(fileOf(GetParam()));
  const auto sequences = sequencesOf(*fast, samplesWith(9, 0));
  const auto got = scoresOf(*fast, sequences), wanted = scoresOf(truth.exact(), sequences);
  const auto draws = scoreDrawsOf(truth, sequences);
  std::vector<double> limits;
  for (size_t b = 0; b < got.size(); ++b)
    for (size_t t = 0; t < wanted[b].loglikNats.size(); ++t) {
      const double nats = wanted[b].loglikNats[t], limit = natsLimit(wanted, draws, b, t);
      EXPECT_LE(std::abs(got[b].loglikNats[t] - nats), limit)
          << "sequence " << b << ", frame " << t;
      limits.push_back(limit / std::max(100.0, std::abs(nats)));
    }
  std::nth_element(limits.begin(), limits.begin() + static_cast<long>(limits.size() / 2),
                   limits.end());
  EXPECT_LT(limits[limits.size() / 2], 0.1) << "limits that everything keeps";
}

TEST_P(Bases, ASampleIsTheSameBitsInAnyBatchAtAnyPlaceForAnyNumberOfThreads) {
  const auto model = modelOf(GetParam(), Execution::Engine);
  const auto alone = rollout(*model, {kWatched});
  for (const int threads : {1, 2, 4}) {
    const Threads set(threads);
    for (const uint32_t batch : {3u, 33u, 70u})
      for (const size_t place : {size_t{0}, size_t{batch} - 1}) {
        const auto together = rollout(*model, samplesWith(batch, place));
        for (size_t t = 0; t < alone.size(); ++t)
          ASSERT_EQ(Matrix(together[t].row(static_cast<long>(place))), alone[t])
              << batch << " samples, place " << place << ", frame " << t << ", threads " << threads;
      }
  }
}

TEST_P(Bases, AScoreIsTheSameBitsInAnyCompanyForAnyNumberOfThreads) {
  const auto model = modelOf(GetParam(), Execution::Engine);
  const auto company = sequencesOf(*model, samplesWith(41, 10));
  const auto alone = scoresOf(*model, {company[10]}).front();
  for (const int threads : {1, 2, 4}) {
    const Threads set(threads);
    const auto among = scoresOf(*model, company)[10];
    EXPECT_EQ(among.latent, alone.latent) << threads << " threads";
    EXPECT_EQ(among.loglikNats, alone.loglikNats) << threads << " threads";
  }
}

INSTANTIATE_TEST_SUITE_P(Engine, Bases, testing::Values("linear", "demo", "plus_small"));

}  // namespace
}  // namespace marey
