// The processes that a launcher started together, over MPI.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "base/ranks.h"

namespace boost::mpi {
class communicator;
class environment;
}  // namespace boost::mpi

namespace marey {

/// How a rank fared, and how a call ended for all.
struct RankFault {
  enum class Kind { None, Cancelled, Usage, Other };
  Kind kind = Kind::None;
  int rank = 0;
  std::string text;
};

/// How it works: a share runs on the main thread while a thread beside it minds the messages
/// (progress, requests to stop), so that these are prompt whatever the share is at. Every call ends
/// in an agreement: each rank tells the first one how it fared, and the first one tells all how the
/// call ended for all. One thread at a time calls MPI.
class MpiRanks final : public Ranks {
 public:
  /// Throws UsageError unless MPI knows of `processes` ranks and serves threads.
  explicit MpiRanks(int processes);
  /// Waits for all ranks; where one did not answer, ends them all.
  ~MpiRanks() override;

  int rank() const override;
  int size() const override;
  std::vector<std::string> gather(size_t items, const Share& work, Progress& progress) override;
  std::string fromFirst(const std::function<std::string()>& make) override;
  void together(const std::function<void()>& body) override;
  void whenStopped(const std::function<void()>& say) override;

 private:
  struct Call;  ///< what is known of the call under way

  void mindMessages(Progress& progress);
  void mindAtFirst(Progress& progress);
  void mindElsewhere(Progress& progress);
  void stopAll();
  /// Waits until every rank has said how it fared; how the call ended for all.
  RankFault agree(const RankFault& own, Progress& progress);
  RankFault outcome(const RankFault& own) const;
  void throwIfFailed(const RankFault& outcome) const;
  std::vector<std::string> collect(size_t items, std::vector<std::string> own);

  std::unique_ptr<boost::mpi::environment> m_environment;
  std::unique_ptr<boost::mpi::communicator> m_world;
  std::unique_ptr<Call> m_call;
  bool m_broken = false;  ///< a rank does not answer
  bool m_ended = false;   ///< all have agreed that the run has failed
};

}  // namespace marey
