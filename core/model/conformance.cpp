#include "model/conformance.h"

#include <cmath>

#include "base/error.h"
#include "base/npy.h"

namespace marey {
namespace {

/// Rows of one batch element of a (B, T, F) array.
Matrix element(const Tensor& tensor, int64_t b) {
  const auto values = tensor.toFloats();
  return Eigen::Map<const Matrix>(values.data() + b * tensor.shape[1] * tensor.shape[2],
                                  tensor.shape[1], tensor.shape[2]);
}

Eigen::RowVectorXf rowOr(const std::vector<float>& values, int size, float fallback) {
  if (values.empty()) return Eigen::RowVectorXf::Constant(size, fallback);
  return Eigen::Map<const Eigen::RowVectorXf>(values.data(), size);
}

/// Vectors are standardised; models speak metres where they have a standardiser.
struct Units {
  Eigen::RowVectorXf mean, std;
  Matrix toModel(const Matrix& x) const {
    return ((x.array().rowwise() * std.array()).rowwise() + mean.array()).matrix();
  }
  Matrix toVectors(const Matrix& x) const {
    return ((x.array().rowwise() - mean.array()).rowwise() / std.array()).matrix();
  }
};

Matrix flatRow(const Matrix& m, long first, long rows) {
  return Eigen::Map<const Eigen::RowVectorXf>(m.row(first).data(), rows * m.cols());
}

double worse(double a, double b) {
  return std::isnan(b) ? INFINITY : std::max(a, b);
}

}  // namespace

ConformanceErrors checkConformance(const MotionModel& model, const std::string& path) {
  const ModelInfo& info = model.info();
  const DensityEstimator& density = requireDensity(model);
  const FrameGenerator& generator = requireRollout(model);
  TensorFile file{.tensors = readNpz(path)};
  const auto& x = file.get("x", {-1, -1, info.poseDim}, path);
  const int64_t batch = x.shape[0], frames = x.shape[1] - info.context;
  if (frames < 1)
    throwInput({.path = path, .item = "array 'x'"},
               fmt::format("more than {} frames", info.context), "{}", x.shape[1]);
  const auto& control =
      file.get("control", {batch, x.shape[1] + info.lookahead, info.controlDim}, path);
  const auto& z = file.get("z", {batch, frames, info.latent.width}, path);
  const auto& loglik = file.get("loglik_nats", {batch, frames}, path);
  const auto& zIn = file.get("z_in", {batch, -1, info.latent.width}, path);
  const auto& sampled = file.get("x_sampled", {batch, zIn.shape[1], info.poseDim}, path);
  const auto wantedLoglik = loglik.toDoubles();
  const auto& s = info.standardiser;
  const Units pose{rowOr(s.poseMean, info.poseDim, 0.f), rowOr(s.poseStd, info.poseDim, 1.f)};
  const Units controls{rowOr(s.controlMean, info.controlDim, 0.f),
                       rowOr(s.controlStd, info.controlDim, 1.f)};
  ConformanceErrors out{.frames = static_cast<int>(batch * frames)};
  for (int64_t b = 0; b < batch; ++b) {
    const Matrix poses = pose.toModel(element(x, b)),
                 control_b = controls.toModel(element(control, b));
    RolloutState state = density.start(1, flatRow(poses, 0, info.context));
    const SequenceScore score = density.observe(state, poses.bottomRows(frames), control_b);
    out.latent = worse(out.latent, (score.latent - element(z, b)).cwiseAbs().maxCoeff());
    for (int64_t t = 0; t < frames; ++t)
      out.loglik = worse(out.loglik, std::abs(score.loglikNats[static_cast<size_t>(t)] -
                                              wantedLoglik[static_cast<size_t>(b * frames + t)]));
    RolloutState rollout = generator.start(1, {});
    const Matrix latents = element(zIn, b), wanted = element(sampled, b);
    for (int64_t t = 0; t < latents.rows(); ++t) {
      const Matrix got = pose.toVectors(generator.sampleFrame(
          rollout, flatRow(control_b, t, info.context + 1 + info.lookahead), latents.row(t)));
      out.sample = worse(out.sample, (got - wanted.row(t)).cwiseAbs().maxCoeff());
    }
  }
  return out;
}

namespace {

/// The authors' mirror: left and right joints change places with x negated; x of the joints on
/// the midline stays as it is.
Eigen::RowVectorXf authorsMirror(const Eigen::RowVectorXf& row) {
  Eigen::RowVectorXf out = row;
  for (const auto& [left, right] : {std::pair{1, 5}, std::pair{13, 17}})
    for (int j = 0; j < 4; ++j) {
      out.segment<3>(3 * (left + j)) = row.segment<3>(3 * (right + j));
      out.segment<3>(3 * (right + j)) = row.segment<3>(3 * (left + j));
      out(3 * (left + j)) *= -1.f;
      out(3 * (right + j)) *= -1.f;
    }
  out(63) *= -1.f;
  out(65) *= -1.f;
  return out;
}

}  // namespace

Standardiser standardiserFromArchive(const std::string& npz) {
  constexpr int64_t kWidth = 66, kPose = 63, kValidation = 100;
  const TensorFile file{.tensors = readNpz(npz)};
  const Tensor& clips = file.get("clips", {-1, -1, kWidth}, npz);
  // The authors keep the last 100 clips for validation before they fit.
  const int64_t used = clips.shape[0] > kValidation ? clips.shape[0] - kValidation : clips.shape[0];
  const auto values = clips.toFloats();
  const Eigen::Map<const Matrix> rows(values.data(), used * clips.shape[1], kWidth);
  Eigen::RowVectorXd sum = Eigen::RowVectorXd::Zero(kWidth), squares = sum;
  for (long i = 0; i < rows.rows(); ++i) {
    for (const auto& row : {Eigen::RowVectorXf(rows.row(i)), authorsMirror(rows.row(i))}) {
      Eigen::RowVectorXd forward = row.cast<double>(), backward = forward;
      backward.tail(3) *= -1.0;
      sum += forward + backward;
      squares += forward.cwiseAbs2() + backward.cwiseAbs2();
    }
  }
  const double n = 4.0 * static_cast<double>(rows.rows());
  if (n == 0.0)
    throw InputError({.path = npz, .item = "array 'clips'"}, "at least one frame", "none");
  Standardiser out;
  for (int64_t i = 0; i < kWidth; ++i) {
    const double mean = sum(i) / n, variance = squares(i) / n - mean * mean;
    const float std = variance > 1e-12 ? static_cast<float>(std::sqrt(variance)) : 1.f;
    (i < kPose ? out.poseMean : out.controlMean).push_back(static_cast<float>(mean));
    (i < kPose ? out.poseStd : out.controlStd).push_back(std);
  }
  return out;
}

}  // namespace marey
