#include "nn/processes/gloo_group.h"

#include <functional>
#include <thread>

#include <torch/csrc/distributed/c10d/ProcessGroupGloo.hpp>
#include <torch/csrc/distributed/c10d/TCPStore.hpp>

#include "base/error.h"

namespace marey::nn {
namespace {

using torch::Tensor;
using namespace std::chrono_literals;

constexpr auto kMeetWithin = 60s;
/// Those who noticed that one is missing wait so long for each other.
constexpr auto kRollCall = 3s;

std::vector<uint8_t> bytesOf(const std::string& text) {
  return {text.begin(), text.end()};
}

class GlooGroup : public ProcessGroup {
 public:
  GlooGroup(ProcessRank rank, const MeetingPoint& point)
      : ProcessGroup(rank), m_place(fmt::format("{}:{}", point.host, point.port)) {
    try {
      c10d::TCPStoreOptions options;
      options.port = static_cast<uint16_t>(point.port);
      options.isServer = leads();
      options.numWorkers = static_cast<size_t>(rank.size);
      options.timeout = kMeetWithin;
      m_store = c10::make_intrusive<c10d::TCPStore>(point.host, options);
      auto gloo = c10d::ProcessGroupGloo::Options::create(kMeetWithin);
      const bool here = point.host == "127.0.0.1" || point.host == "localhost";
      gloo->devices.push_back(here ? c10d::ProcessGroupGloo::createDeviceForHostname("127.0.0.1")
                                   : c10d::ProcessGroupGloo::createDefaultDevice());
      gloo->timeout = kAnswerWithin;
      m_group = c10::make_intrusive<c10d::ProcessGroupGloo>(m_store, rank.rank, rank.size, gloo);
    } catch (const std::exception& e) {
      throw Error(fmt::format("process {} of {} did not meet the others at {} within {} s: {}",
                              rank.rank, rank.size, m_place, kMeetWithin.count(), firstLine(e)));
    }
    m_store->setTimeout(5s);
  }

  void sum(Tensor& values) override {
    const torch::NoGradGuard guard;
    together([&] {
      std::vector<Tensor> here{values.detach().cpu().contiguous()};
      m_group->allreduce(here)->wait();
      values.copy_(here[0]);
    });
  }

  double largest(double value) override {
    std::vector<Tensor> here{torch::full({1}, value, torch::kFloat64)};
    c10d::AllreduceOptions options;
    options.reduceOp = c10d::ReduceOp::MAX;
    together([&] { m_group->allreduce(here, options)->wait(); });
    return here[0].item<double>();
  }

  void spread(Tensor& values) override {
    const torch::NoGradGuard guard;
    together([&] {
      std::vector<Tensor> here{values.detach().cpu().contiguous()};
      m_group->broadcast(here)->wait();
      values.copy_(here[0]);
    });
  }

  void requireSame(const std::string& name, const std::string& text) override {
    std::string other = text;
    together([&] {
      if (leads()) m_store->set("same/" + name, bytesOf(text));
      largest(0.0);
      const auto stored = m_store->get("same/" + name);
      other.assign(stored.begin(), stored.end());
    });
    // All of them end: nobody waits for one that has left.
    const bool differs = largest(other == text ? 0.0 : 1.0) > 0.0;
    if (other != text)
      throw InputError({.path = fmt::format("process {}", rank().rank), .item = name}, other, text);
    if (differs) throw Error("another process has another " + name + " (it says which)");
  }

  void abandon(const std::string& why) noexcept override {
    try {
      m_store->set("last words", bytesOf(fmt::format("process {}: {}", rank().rank, why)));
      m_group.reset();
      if (leads()) waitForAll();
    } catch (const std::exception&) {
      // The leading process, which keeps the store, has gone before.
    }
  }

 private:
  static std::string firstLine(const std::exception& e) {
    const std::string text = e.what();
    return text.substr(0, text.find('\n'));
  }

  /// What needs every process. Throws Error naming the one that did not come.
  void together(const std::function<void()>& work) {
    try {
      work();
    } catch (const marey::Error&) {
      throw;
    } catch (const std::exception& e) {
      throw Error(fmt::format("process {} of {}: {} ({})", rank().rank, rank().size, whoIsMissing(),
                              firstLine(e)));
    }
  }

  static std::string noticed(int rank) { return fmt::format("noticed/{}", rank); }

  /// The store ends with the leading process: the others are given time to read in it.
  void waitForAll() {
    m_store->set(noticed(rank().rank), bytesOf("1"));
    for (const auto until = std::chrono::steady_clock::now() + kRollCall;
         std::chrono::steady_clock::now() < until && !missing().empty();)
      std::this_thread::sleep_for(50ms);
  }

  /// Numbers of the processes that have noticed nothing yet.
  std::string missing() const {
    std::string out;
    for (int r = 0; r < rank().size; ++r)
      if (!m_store->check({noticed(r)})) out += fmt::format(" {}", r);
    return out;
  }

  std::string whoIsMissing() const {
    try {
      m_store->set(noticed(rank().rank), bytesOf("1"));
      std::string absent;
      for (const auto until = std::chrono::steady_clock::now() + kRollCall;
           std::chrono::steady_clock::now() < until; std::this_thread::sleep_for(50ms)) {
        if (m_store->check({"last words"})) {
          const auto words = m_store->get("last words");
          return "ended because of another: " + std::string(words.begin(), words.end());
        }
        absent = missing();
        if (absent.empty()) return "the connection between the processes broke";
      }
      return "no answer from process" + absent;
    } catch (const std::exception&) {
      return "no answer from process 0, which has ended or cannot be reached at " + m_place;
    }
  }

  std::string m_place;
  c10::intrusive_ptr<c10d::TCPStore> m_store;
  c10::intrusive_ptr<c10d::ProcessGroupGloo> m_group;
};

}  // namespace

std::unique_ptr<ProcessGroup> joinByGloo(ProcessRank rank, const MeetingPoint& point) {
  return std::make_unique<GlooGroup>(rank, point);
}

}  // namespace marey::nn
