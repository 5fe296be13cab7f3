#include "nn/torch/machine_limits.h"

#include <algorithm>
#include <chrono>

#include "nn/engine/kernels/kernels.h"
#include "nn/engine/team.h"
#include "nn/torch/torch.h"

namespace marey::nn {
namespace {

constexpr long kRun = 512;                                   ///< inputs of a panel
constexpr size_t kPair = 2 * kRun * kPanel * sizeof(float);  ///< bytes of two panels

double seconds(std::chrono::steady_clock::time_point begin) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

}  // namespace

double measureSgemm() {
  constexpr int64_t kSize = 1536;
  const c10::InferenceMode guard;
  const auto a = torch::ones({kSize, kSize}), b = torch::ones({kSize, kSize});
  auto out = torch::empty({kSize, kSize});
  torch::mm_out(out, a, b);
  double best = 1e9;
  for (int i = 0; i < 3; ++i) {
    const auto begin = std::chrono::steady_clock::now();
    torch::mm_out(out, a, b);
    best = std::min(best, seconds(begin));
  }
  return 2.0 * kSize * kSize * kSize / best * 1e-9;
}

ReadSpeed::ReadSpeed(size_t bytes) : m_values((bytes + kPair - 1) / kPair * kPair / sizeof(float)) {
  // Pages that nobody has written are all the same one.
  std::fill_n(m_values.data(), m_values.size(), 1.f);
}

double ReadSpeed::measure() const {
  const Kernels& k = kernels();
  const auto* memory = reinterpret_cast<const std::byte*>(m_values.data());
  const size_t bytes = m_values.size() * sizeof(float);
  double best = 1e9;
  for (int i = 0; i < 3; ++i) {
    const auto begin = std::chrono::steady_clock::now();
    runTeam(teamThreads(), [&](Team team) {
      const auto [first, last] = team.share(static_cast<long>(bytes / kPair));
      // Products of one row read their weights once and do hardly anything else.
      alignas(64) float sums[2 * kPanel] = {};
      alignas(64) float ones[kRun];
      std::fill(ones, ones + kRun, 1.f);
      const Inputs run{ones, kRun, kRun};
      for (long pair = first; pair < last; ++pair) {
        const std::byte* panels = memory + static_cast<size_t>(pair) * kPair;
        k.product({.inputs = &run,
                   .runs = 1,
                   .panel = panels,
                   .panels = 2,
                   .panelBytes = static_cast<long>(kPair / 2),
                   .next = panels,
                   .start = sums,
                   .out = sums,
                   .outStride = 2 * kPanel,
                   .rows = 1});
      }
    });
    best = std::min(best, seconds(begin));
  }
  return static_cast<double>(bytes) / best * 1e-9;
}

}  // namespace marey::nn
