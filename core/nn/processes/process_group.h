// The processes of one training run, which add up their gradients. Internal (libtorch types).
//
// Every process calls the same functions in the same order. A process that does not come is an
// error of the others within kAnswerWithin, or at once where its connection breaks.
#pragma once

#include <chrono>
#include <memory>
#include <string>

#include "base/process_rank.h"
#include "nn/torch/torch.h"

namespace marey::nn {

constexpr std::chrono::minutes kAnswerWithin{10};

/// Where the processes meet.
struct MeetingPoint {
  std::string host = "127.0.0.1";
  int port = 0;
};
/// MASTER_ADDR and MASTER_PORT of the environment; without them this machine, and a port made from
/// `name`. Throws InputError for a port that is none.
MeetingPoint meetingPoint(const std::string& name);

class ProcessGroup {
 public:
  virtual ~ProcessGroup() = default;
  ProcessRank rank() const { return m_rank; }
  bool leads() const { return m_rank.rank == 0; }

  /// Adds up float tensors of one shape, in place.
  virtual void sum(torch::Tensor& values) = 0;
  /// The largest of every process's number.
  virtual double largest(double value) = 0;
  /// Everyone gets what the leading process has.
  virtual void spread(torch::Tensor& values) = 0;
  /// Throws InputError where the others have another text under this name.
  virtual void requireSame(const std::string& name, const std::string& text) = 0;
  /// Lets the others know why this process ends.
  virtual void abandon(const std::string& why) noexcept = 0;

 protected:
  explicit ProcessGroup(ProcessRank rank) : m_rank(rank) {}

 private:
  ProcessRank m_rank;
};

/// Of one process: does nothing. Of several: connects them through Gloo; throws Error where they do
/// not meet, and UsageError where this libtorch has no Gloo.
std::unique_ptr<ProcessGroup> joinProcesses(ProcessRank rank, const MeetingPoint& point);

}  // namespace marey::nn
