#include "toy_family.h"

#include <Eigen/Dense>

#include "base/error.h"
#include "model/data_set.h"
#include "model/model_parts.h"

namespace marey::test {
namespace {

constexpr const char* kFamily = "toy";

int directionsOf(const Json& config, const std::string& origin) {
  const bool whole = config.is_object() && config.contains("model");
  JsonReader reader(whole ? config["model"] : config, origin, "model.");
  const int out = reader.optional("directions", 2);
  reader.finish();
  return out;
}

ModelInfo completed(ModelInfo info, int directions) {
  info.latent = {.width = directions};
  info.optionSchema = {temperatureOption(directions),
                       {.name = "first_direction",
                        .title = "First direction",
                        .about = "Factor on the direction in which poses differ most",
                        .high = 2.0,
                        .count = 1}};
  info.facts = {{"directions", std::to_string(directions)}};
  info.parameters = static_cast<int64_t>(info.poseDim) * (1 + info.controlDim + directions);
  return info;
}

Matrix matrixOf(const TensorFile& file, const std::string& name, long rows, long columns,
                const std::string& origin) {
  const auto values = file.get("weights/" + name, {rows, columns}, origin).toFloats();
  Matrix out = Eigen::Map<const Matrix>(values.data(), rows, columns);
  if (!out.allFinite())
    throw InputError({.path = origin, .item = "tensor '" + name + "'"}, "finite weights",
                     "NaN or infinity");
  return out;
}

Tensor tensorOf(const Matrix& m) {
  return Tensor::fromFloats({m.rows(), m.cols()}, m.data());
}

class Toy : public MotionModel,
            public FrameGenerator,
            public ClipGenerator,
            public MotionCompleter {
 public:
  Toy(ModelInfo info, const TensorFile& file, const std::string& origin)
      : m_info(std::move(info)),
        m_mean(matrixOf(file, "mean", 1, m_info.poseDim, origin)),
        m_control(matrixOf(file, "control", m_info.controlDim, m_info.poseDim, origin)),
        m_latent(matrixOf(file, "latent", m_info.latent.width, m_info.poseDim, origin)) {}

  const ModelInfo& info() const override { return m_info; }
  const FrameGenerator* rollout() const override { return this; }
  const ClipGenerator* wholeClip() const override { return this; }
  const MotionCompleter* completion() const override { return this; }

  RolloutState start(int batch, const Matrix& history) const override {
    if (history.size() > 0) requireShape("history", history, batch, 0);
    return {batch};
  }
  Matrix sampleFrame(RolloutState& state, const Matrix& controls,
                     const Matrix& latents) const override {
    const long rows = std::any_cast<int>(state.value);
    requireShape("control window", controls, rows, m_info.controlDim);
    requireShape("latent", latents, rows, m_info.latent.width);
    return posesOf(controls, latents);
  }
  std::vector<Matrix> generate(std::span<const ClipRequest> requests,
                               const std::function<void()>& between) const override {
    std::vector<Matrix> out;
    for (const ClipRequest& request : requests) {
      between();
      out.push_back(posesOf(request.controls, request.latents));
    }
    return out;
  }
  bool denoises() const override { return true; }
  /// The latents that suit the known values best, and the poses that they give.
  Matrix complete(const CompletionRequest& r, const std::function<void()>& between) const override {
    Matrix out = posesOf(r.controls, r.latents);
    for (long t = 0; t < out.rows(); ++t) {
      between();
      const Eigen::RowVectorXf rest = (r.poses.row(t) - out.row(t)).cwiseProduct(r.known.row(t));
      const Eigen::MatrixXf seen = m_latent * r.known.row(t).asDiagonal();
      const Eigen::MatrixXf gram =
          seen * seen.transpose() +
          (r.noise.empty() ? 1e-3F : static_cast<float>(r.noise[0] * r.noise[0])) *
              Eigen::MatrixXf::Identity(m_latent.rows(), m_latent.rows());
      out.row(t) += (gram.ldlt().solve(seen * rest.transpose())).transpose() * m_latent;
      for (long j = 0; j < out.cols(); ++j)
        if (r.known(t, j) != 0.F && r.noise.empty()) out(t, j) = r.poses(t, j);
    }
    return out;
  }
  TensorFile save() const override {
    TensorFile file;
    file.tensors["weights/mean"] = tensorOf(m_mean);
    file.tensors["weights/control"] = tensorOf(m_control);
    file.tensors["weights/latent"] = tensorOf(m_latent);
    storeCommon(m_info, file);
    return file;
  }

 private:
  /// Sums in a fixed order, whatever other rows are there.
  Matrix posesOf(const Matrix& controls, const Matrix& latents) const {
    Matrix out = m_mean.replicate(controls.rows(), 1);
    for (long t = 0; t < out.rows(); ++t)
      for (long j = 0; j < out.cols(); ++j) {
        for (long c = 0; c < controls.cols(); ++c) out(t, j) += controls(t, c) * m_control(c, j);
        for (long k = 0; k < latents.cols(); ++k) out(t, j) += latents(t, k) * m_latent(k, j);
      }
    return out;
  }

  ModelInfo m_info;
  Matrix m_mean, m_control, m_latent;
};

ModelInfo describe(const Json& config, const std::string& origin) {
  ModelInfo out;
  out.family = kFamily;
  out.poseDim = 63;
  out.controlDim = 3;
  const int directions = directionsOf(config, origin);
  out.config = {{"directions", directions}};
  return completed(std::move(out), directions);
}

std::unique_ptr<MotionModel> load(TensorFile file, const std::string& origin, const LoadOptions&) {
  ModelInfo info = loadCommon(file, origin);
  const int directions = directionsOf(info.config, origin);
  for (const auto& [key, tensor] : file.tensors)
    if (key.starts_with("weights/") && key != "weights/mean" && key != "weights/control" &&
        key != "weights/latent")
      throw InputError({.path = origin, .item = "tensor '" + key + "'"}, "only the model's own",
                       "an extra one");
  return std::make_unique<Toy>(completed(std::move(info), directions), file, origin);
}

TensorFile build(const DataSet& data, const Json& config, const std::string& origin,
                 uint64_t /*seed*/, Progress& progress) {
  const int directions = directionsOf(config, origin);
  long rows = 0;
  for (const auto& s : data.train) rows += s.pose.rows();
  Eigen::MatrixXd x(rows, data.poseDim()), c(rows, data.controlDim());
  for (long at = 0; const auto& s : data.train) {
    progress.throwIfCancelled();
    x.middleRows(at, s.pose.rows()) = s.pose.cast<double>();
    c.middleRows(at, s.pose.rows()) = s.control.cast<double>();
    at += s.pose.rows();
  }
  const Eigen::RowVectorXd mean = x.colwise().mean();
  x.rowwise() -= mean;
  const Eigen::MatrixXd gram =
      c.transpose() * c + 1e-6 * Eigen::MatrixXd::Identity(c.cols(), c.cols());
  const Eigen::MatrixXd weight = gram.ldlt().solve(c.transpose() * x);
  const Eigen::MatrixXd rest = x - c * weight;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(rest.transpose() * rest /
                                                              static_cast<double>(rows));
  Matrix latent(directions, data.poseDim());
  for (int k = 0; k < directions; ++k) {
    const long column = data.poseDim() - 1 - k;
    latent.row(k) = (std::sqrt(std::max(0.0, solver.eigenvalues()(column))) *
                     solver.eigenvectors().col(column).transpose())
                        .cast<float>();
  }
  TensorFile file;
  file.tensors["weights/mean"] = tensorOf(mean.cast<float>());
  file.tensors["weights/control"] = tensorOf(weight.cast<float>());
  file.tensors["weights/latent"] = tensorOf(latent);
  file.metadata = {{"config", {{"directions", directions}}}};
  return file;
}

}  // namespace

ModelFamily toyFamily() {
  return {.name = kFamily,
          .title = "A toy of tests",
          .example = {{"family", kFamily}, {"name", "toy"}, {"model", {{"directions", 2}}}},
          .load = load,
          .describe = describe,
          .build = build};
}

}  // namespace marey::test
