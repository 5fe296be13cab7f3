#include "moglow/base_blocks.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>

#include "moglow/pose_base.h"
#include "nn/team.h"

namespace marey::moglow {
namespace {

constexpr long kRows = BaseBlocks::kRows;

/// Calls work(block, first row, rows) for every block, on whichever thread is free.
template <typename Work>
void forBlocks(long rows, const Work& work) {
  const long blocks = (rows + kRows - 1) / kRows;
  std::atomic<long> next = 0;
  std::exception_ptr error;
  std::mutex mutex;
  nn::runTeam(static_cast<int>(std::min<long>(nn::teamThreads(), blocks)), [&](nn::Team) {
    try {
      const nn::OneThread alone;
      const c10::InferenceMode guard;
      for (long block; (block = next.fetch_add(1)) < blocks;)
        work(static_cast<size_t>(block), block * kRows, std::min(kRows, rows - block * kRows));
    } catch (...) {
      const std::lock_guard lock(mutex);
      error = std::current_exception();
    }
  });
  if (error) std::rethrow_exception(error);
}

/// Rows of a block, filled up with copies of its last one.
torch::Tensor blockOf(const float* values, long first, long rows, long width) {
  auto out = torch::empty({kRows, width});
  auto* to = out.data_ptr<float>();
  const float* from = values + first * width;
  std::copy(from, from + rows * width, to);
  for (long r = rows; r < kRows; ++r)
    std::copy(from + (rows - 1) * width, from + rows * width, to + r * width);
  return out;
}

void copyRows(const torch::Tensor& block, long first, long rows, float* out, long stride) {
  const auto plain = block.contiguous();
  const long width = plain.size(1);
  const auto* from = plain.data_ptr<float>();
  for (long r = 0; r < rows; ++r)
    std::copy(from + r * width, from + (r + 1) * width, out + (first + r) * stride);
}

}  // namespace

BaseBlocks::BaseBlocks(std::shared_ptr<const PoseBase> base) : m_base(std::move(base)) {}

BaseBlocks::Seen BaseBlocks::foresee(long rows, const float* history, long historyWidth,
                                     const float* control, long controlWidth, float* features,
                                     long stride) const {
  auto blocks =
      std::make_shared<std::vector<Foresight>>(static_cast<size_t>((rows + kRows - 1) / kRows));
  forBlocks(rows, [&](size_t block, long first, long count) {
    Foresight& seen = (*blocks)[block];
    seen = m_base->foresee({blockOf(history, first, count, historyWidth),
                            blockOf(control, first, count, controlWidth),
                            {}});
    copyRows(seen.features, first, count, features, stride);
  });
  return {rows, std::move(blocks)};
}

void BaseBlocks::toPose(const Seen& seen, const float* innovation, float* pose, long width) const {
  forBlocks(seen.rows, [&](size_t block, long first, long count) {
    const auto poses =
        m_base->toPose(blockOf(innovation, first, count, width), (*seen.blocks)[block]);
    copyRows(poses, first, count, pose, width);
  });
}

void BaseBlocks::toInnovation(const Seen& seen, const float* pose, float* innovation, long width,
                              double* logDet) const {
  forBlocks(seen.rows, [&](size_t block, long first, long count) {
    const auto e = m_base->toInnovation(blockOf(pose, first, count, width), (*seen.blocks)[block]);
    copyRows(e.value, first, count, innovation, width);
    const auto dets = e.logDet.to(torch::kFloat64).contiguous();
    std::copy(dets.data_ptr<double>(), dets.data_ptr<double>() + count, logDet + first);
  });
}

}  // namespace marey::moglow
