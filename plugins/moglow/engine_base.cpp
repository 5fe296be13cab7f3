#include "moglow/engine_base.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>

#include "moglow/base_tensors.h"
#include "moglow/engine_kinematic.h"
#include "moglow/engine_linear.h"
#include "nn/engine/team.h"

namespace marey::moglow {
namespace {

/// Rows that a thread takes up at once: little to wait for at the end, and few atomic operations.
constexpr long kRowsTogether = 4;

/// Calls work(row) for every row, on whichever thread is free.
template <typename Work>
void forRows(long rows, const Work& work) {
  std::atomic<long> next = 0;
  std::exception_ptr error;
  std::mutex mutex;
  const long parts = (rows + kRowsTogether - 1) / kRowsTogether;
  nn::runTeam(static_cast<int>(std::min<long>(nn::teamThreads(), parts)), [&](nn::Team) {
    try {
      for (long begin; (begin = next.fetch_add(kRowsTogether)) < rows;)
        for (long row = begin; row < std::min(begin + kRowsTogether, rows); ++row) work(row);
    } catch (...) {
      const std::lock_guard lock(mutex);
      error = std::current_exception();
    }
  });
  if (error) std::rethrow_exception(error);
}

}  // namespace

EngineBase::EngineBase(const Config& c)
    : m_poseDim(c.poseDim),
      m_historyWidth(static_cast<long>(c.tau) * c.poseDim),
      m_controlWidth(static_cast<long>(c.tau + 1 + c.lookahead) * c.controlDim) {}

void EngineBase::foresee(long rows, const float* history, const float* control, float* features,
                         long stride, std::vector<RowForesight>& seen) const {
  seen.resize(static_cast<size_t>(rows));
  forRows(rows, [&](long row) {
    foreseeRow(history + row * m_historyWidth, control + row * m_controlWidth,
               features + row * stride, seen[static_cast<size_t>(row)]);
  });
}

void EngineBase::toPose(std::span<const RowForesight> seen, const float* innovation,
                        float* pose) const {
  forRows(static_cast<long>(seen.size()), [&](long row) {
    toPoseRow(seen[static_cast<size_t>(row)], innovation + row * m_poseDim, pose + row * m_poseDim);
  });
}

void EngineBase::toInnovation(std::span<const RowForesight> seen, const float* pose,
                              float* innovation, double* logDet) const {
  forRows(static_cast<long>(seen.size()), [&](long row) {
    logDet[row] = toInnovationRow(seen[static_cast<size_t>(row)], pose + row * m_poseDim,
                                  innovation + row * m_poseDim);
  });
}

std::unique_ptr<const EngineBase> makeEngineBase(const Config& config, const BodyFacts& body,
                                                 const TensorFile& file, const std::string& name) {
  const BaseTensors stored(file, name);
  if (config.poseBase == "linear") return std::make_unique<const EngineLinear>(config, stored);
  if (config.poseBase == "kinematic")
    return std::make_unique<const EngineKinematic>(config, body, stored);
  return nullptr;
}

}  // namespace marey::moglow
