#include "moglow/clusters.h"

#include <algorithm>

#include "base/random.h"

namespace marey::moglow {
namespace {

constexpr int64_t kClusterRows = 40000;  ///< rows that k-means looks at
constexpr int kClusterRounds = 40;

}  // namespace

torch::Tensor nearest(const torch::Tensor& features, const torch::Tensor& centres) {
  return std::get<1>(torch::cdist(features, centres).min(1));
}

torch::Tensor clusterCentres(const torch::Tensor& features, int64_t count) {
  std::vector<int64_t> rows;
  const int64_t total = features.size(0);
  for (int64_t i = 0; i < std::min(kClusterRows, total); ++i)
    rows.push_back(std::min(
        total - 1,
        static_cast<int64_t>(uniformAt({.stage = RandomStage::Weights}, static_cast<uint32_t>(i)) *
                             static_cast<double>(total))));
  const auto sample = features.index_select(0, torch::tensor(rows).to(features.device()));
  auto centres = sample.narrow(0, 0, std::min<int64_t>(count, sample.size(0))).clone();
  for (int round = 0; round < kClusterRounds; ++round) {
    const auto nearest = std::get<1>(torch::cdist(sample, centres).min(1));
    auto sums = torch::zeros_like(centres).index_add_(0, nearest, sample);
    const auto counts =
        torch::zeros({centres.size(0)}, centres.options())
            .index_add_(0, nearest, torch::ones({sample.size(0)}, centres.options()));
    centres =
        torch::where(counts.gt(0).unsqueeze(1), sums / counts.clamp_min(1.0).unsqueeze(1), centres);
  }
  if (centres.size(0) == count) return centres;
  return torch::cat({centres, centres.narrow(0, 0, 1).expand({count - centres.size(0), -1})}, 0);
}

}  // namespace marey::moglow
