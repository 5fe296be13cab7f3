#include "nn/processes/process_group.h"

#include <charconv>
#include <cstdlib>

#include "base/error.h"
#include "nn/processes/gloo_group.h"

namespace marey::nn {
namespace {

class OneProcess : public ProcessGroup {
 public:
  OneProcess() : ProcessGroup({}) {}
  void sum(torch::Tensor&) override {}
  double largest(double value) override { return value; }
  void spread(torch::Tensor&) override {}
  void requireSame(const std::string&, const std::string&) override {}
  void abandon(const std::string&) noexcept override {}
};

}  // namespace

MeetingPoint meetingPoint(const std::string& name) {
  constexpr uint32_t kFirstPort = 20000, kPorts = 10000;
  MeetingPoint out;
  if (const char* host = std::getenv("MASTER_ADDR")) out.host = host;
  const char* port = std::getenv("MASTER_PORT");
  if (port == nullptr) {
    uint32_t hash = 2166136261u;  // FNV-1a: the same in every process
    for (const char c : name) hash = (hash ^ static_cast<unsigned char>(c)) * 16777619u;
    out.port = static_cast<int>(kFirstPort + hash % kPorts);
    return out;
  }
  const std::string_view text = port;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), out.port);
  if (error != std::errc() || end != text.data() + text.size() || out.port < 1 || out.port > 65535)
    throwInput({.path = "MASTER_PORT"}, "a port from 1 to 65535", "'{}'", text);
  return out;
}

std::unique_ptr<ProcessGroup> joinProcesses(ProcessRank rank, const MeetingPoint& point) {
  if (rank.size == 1) return std::make_unique<OneProcess>();
  return joinByGloo(rank, point);
}

}  // namespace marey::nn
