#include "ranks/mpi_ranks.h"

#include <atomic>
#include <chrono>
#include <cmath>
#include <mutex>
#include <optional>
#include <stop_token>
#include <thread>
#include <utility>

#include <boost/mpi/collectives/broadcast.hpp>
#include <boost/mpi/communicator.hpp>
#include <boost/mpi/environment.hpp>
#include <boost/serialization/string.hpp>
#include <boost/serialization/utility.hpp>

#include "base/error.h"

namespace marey {
namespace {

namespace mpi = boost::mpi;
using Clock = std::chrono::steady_clock;

enum Tag { kProgress = 1, kFared, kEnded, kStop, kResult };

/// Between two looks at the messages: far below what a person notices, and no load on the core.
constexpr std::chrono::milliseconds kPause(5);
/// How long the others may take to stop after a failure. mpirun kills a second after it was told to
/// end, or after a rank has died: what there is to say must be said before.
constexpr std::chrono::milliseconds kPatience(400);
/// Progress smaller than this is not sent.
constexpr double kLeastProgress = 0.002;

RankFault currentFault(int rank) {
  try {
    throw;
  } catch (const CancelledError& e) {
    return {RankFault::Kind::Cancelled, rank, e.what()};
  } catch (const UsageError& e) {
    return {RankFault::Kind::Usage, rank, e.what()};
  } catch (const std::exception& e) {
    return {RankFault::Kind::Other, rank, e.what()};
  }
}

using FaultMessage = std::pair<int, std::pair<int, std::string>>;

FaultMessage packed(const RankFault& fault) {
  return {static_cast<int>(fault.kind), {fault.rank, fault.text}};
}

RankFault unpacked(const FaultMessage& message) {
  return {static_cast<RankFault::Kind>(message.first), message.second.first, message.second.second};
}

}  // namespace

struct MpiRanks::Call {
  int number = 0;
  size_t items = 0;
  std::atomic<double> own{0.0};  ///< progress of this rank's share
  double sent = 0.0;
  bool stopSent = false;
  std::stop_source stop;
  std::function<void()> whenStopped;
  std::optional<Clock::time_point> stopped;
  // At the first rank, of every rank.
  std::vector<double> progress;
  std::vector<std::optional<RankFault>> fared;

  void begin(size_t count, int ranks) {
    ++number;
    items = count;
    own = sent = 0.0;
    progress.assign(static_cast<size_t>(ranks), 0.0);
  }
  /// A rank that fails between two calls is heard in the next one.
  void forgetAnswers(int ranks) { fared.assign(static_cast<size_t>(ranks), std::nullopt); }
  void requestStop() {
    stop.request_stop();
    if (!stopped) stopped = Clock::now();
  }
};

MpiRanks::MpiRanks(int processes)
    : m_environment(std::make_unique<mpi::environment>(mpi::threading::serialized, false)),
      m_world(std::make_unique<mpi::communicator>()),
      m_call(std::make_unique<Call>()) {
  if (mpi::environment::thread_level() < mpi::threading::serialized)
    throw UsageError("MPI: expected one that serves several threads, found one that does not");
  if (m_world->size() != processes)
    throw UsageError(
        fmt::format("MPI: expected the {} processes that the environment tells of, found {}: were "
                    "they started by the mpirun, or srun --mpi=pmix, of the MPI that marey uses?",
                    processes, m_world->size()));
  m_call->begin(0, size());
  m_call->forgetAnswers(size());
}

MpiRanks::~MpiRanks() {
  if (m_broken) mpi::environment::abort(1);
}

int MpiRanks::rank() const {
  return m_world->rank();
}

int MpiRanks::size() const {
  return m_world->size();
}

void MpiRanks::stopAll() {
  m_call->requestStop();
  if (std::exchange(m_call->stopSent, true)) return;
  if (!first()) {
    // One that has done its share and waits would not be heard otherwise.
    m_world->send(0, kStop);
    return;
  }
  for (int r = 1; r < size(); ++r)
    // Those that have said how they fared wait for the outcome alone.
    if (!m_call->fared[static_cast<size_t>(r)]) m_world->isend(r, kStop);
}

void MpiRanks::mindAtFirst(Progress& progress) {
  while (const auto message = m_world->iprobe(mpi::any_source, kProgress)) {
    std::pair<int, double> told;
    m_world->recv(message->source(), kProgress, told);
    if (told.first == m_call->number)
      m_call->progress[static_cast<size_t>(message->source())] = told.second;
  }
  while (const auto message = m_world->iprobe(mpi::any_source, kFared)) {
    FaultMessage told;
    m_world->recv(message->source(), kFared, told);
    const RankFault fault = unpacked(told);
    m_call->fared[static_cast<size_t>(message->source())] = fault;
    if (fault.kind != RankFault::Kind::None) stopAll();
  }
  while (const auto message = m_world->iprobe(mpi::any_source, kStop)) {
    m_world->recv(message->source(), kStop);
    stopAll();
  }
  if (m_call->items == 0) return;
  m_call->progress[0] = m_call->own;
  double sum = 0.0;
  for (int r = 0; r < size(); ++r) {
    const auto [begin, end] = shareOf(m_call->items, r, size());
    sum += m_call->progress[static_cast<size_t>(r)] * static_cast<double>(end - begin);
  }
  progress.report(sum / static_cast<double>(m_call->items), fmt::format("{} processes", size()));
}

void MpiRanks::mindElsewhere(Progress&) {
  if (m_world->iprobe(0, kStop)) {
    m_world->recv(0, kStop);
    m_call->requestStop();
  }
  const double own = m_call->own;
  if (m_call->items == 0 || own < m_call->sent + kLeastProgress) return;
  m_call->sent = own;
  m_world->send(0, kProgress, std::pair<int, double>(m_call->number, own));
}

void MpiRanks::mindMessages(Progress& progress) {
  if (progress.cancelled()) {
    if (first() && m_call->whenStopped) std::exchange(m_call->whenStopped, {})();
    stopAll();
  }
  if (first())
    mindAtFirst(progress);
  else
    mindElsewhere(progress);
}

RankFault MpiRanks::outcome(const RankFault& own) const {
  RankFault out = own;
  std::string silent;
  for (int r = 1; r < size(); ++r) {
    const auto& fared = m_call->fared[static_cast<size_t>(r)];
    if (!fared)
      silent += fmt::format("{}{}", silent.empty() ? "" : ", ", r);
    else if (fared->kind > RankFault::Kind::Cancelled ? out.kind <= RankFault::Kind::Cancelled
                                                      : out.kind < fared->kind)
      out = *fared;
  }
  if (!silent.empty() && out.kind == RankFault::Kind::Cancelled)
    out = {RankFault::Kind::Other, 0,
           fmt::format("stopped; no answer from rank {} of {} processes: killed, or at work still",
                       silent, size())};
  return out;
}

RankFault MpiRanks::agree(const RankFault& own, Progress& progress) {
  RankFault out;
  if (first()) {
    if (own.kind != RankFault::Kind::None) stopAll();
    const auto waiting = [this] {
      for (int r = 1; r < size(); ++r)
        if (!m_call->fared[static_cast<size_t>(r)]) return true;
      return false;
    };
    for (mindMessages(progress); waiting() && !m_broken; mindMessages(progress)) {
      std::this_thread::sleep_for(kPause);
      m_broken = m_call->stopped && Clock::now() - *m_call->stopped > kPatience;
    }
    m_broken = m_broken && waiting();
    out = outcome(own);
    for (int r = 1; r < size(); ++r)
      if (m_call->fared[static_cast<size_t>(r)]) m_world->send(r, kEnded, packed(out));
    m_call->forgetAnswers(size());
  } else {
    m_world->send(0, kFared, packed(own));
    while (!m_world->iprobe(0, kEnded)) {
      mindMessages(progress);
      std::this_thread::sleep_for(kPause);
    }
    FaultMessage told;
    m_world->recv(0, kEnded, told);
    out = unpacked(told);
  }
  m_ended = m_ended || out.kind != RankFault::Kind::None;
  return out;
}

void MpiRanks::throwIfFailed(const RankFault& outcome) const {
  if (outcome.kind == RankFault::Kind::None) return;
  if (!first()) throw EndedElsewhere();
  if (outcome.kind == RankFault::Kind::Cancelled) throw CancelledError();
  const std::string text = outcome.rank == 0 ? outcome.text
                                             : fmt::format("rank {} of {} processes: {}",
                                                           outcome.rank, size(), outcome.text);
  if (outcome.kind == RankFault::Kind::Usage) throw UsageError(text);
  throw Error(text);
}

std::vector<std::string> MpiRanks::collect(size_t items, std::vector<std::string> own) {
  if (!first()) {
    for (const std::string& result : own) m_world->send(0, kResult, result);
    return {};
  }
  own.reserve(items);
  for (int r = 1; r < size(); ++r) {
    const auto [begin, end] = shareOf(items, r, size());
    for (size_t i = begin; i < end; ++i) m_world->recv(r, kResult, own.emplace_back());
  }
  return own;
}

std::vector<std::string> MpiRanks::gather(size_t items, const Share& work, Progress& progress) {
  m_call->begin(items, size());
  const auto [begin, end] = shareOf(items, rank(), size());
  Progress share([this](double fraction, std::string_view) { m_call->own = fraction; },
                 m_call->stop.get_token());
  std::vector<std::string> own;
  {
    const std::jthread minding([&](const std::stop_token& done) {
      for (; !done.stop_requested(); std::this_thread::sleep_for(kPause)) mindMessages(progress);
    });
    if (begin < end) own = work(begin, end, share);
    m_call->own = 1.0;
  }
  throwIfFailed(agree({}, progress));
  return collect(items, std::move(own));
}

std::string MpiRanks::fromFirst(const std::function<std::string()>& make) {
  m_call->begin(0, size());
  std::string text;
  if (first()) text = make();
  Progress none;
  throwIfFailed(agree({}, none));
  mpi::broadcast(*m_world, text, 0);
  return text;
}

void MpiRanks::whenStopped(const std::function<void()>& say) {
  m_call->whenStopped = say;
}

void MpiRanks::together(const std::function<void()>& body) {
  Progress none;
  try {
    body();
    m_call->begin(0, size());
    throwIfFailed(agree({}, none));
  } catch (...) {
    if (m_ended) throw;
    const RankFault own = currentFault(rank());
    const RankFault all = agree(own, none);
    if (first() && all.kind == own.kind && all.rank == 0) throw;
    throwIfFailed(all);
  }
}

}  // namespace marey
