// The processes of one run: what mpirun or srun started together, or this process alone.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "base/job.h"

namespace marey {

/// Thrown on the ranks that are to end because of something that the first rank reports.
class EndedElsewhere : public std::exception {
 public:
  const char* what() const noexcept override { return "ended by another process of this run"; }
};

/// A run of one process; core/ranks has the one of many. Every rank makes the same calls in the
/// same order. Work depends on the numbers of its items alone, never on how many ranks there are.
class Ranks {
 public:
  Ranks() = default;
  virtual ~Ranks() = default;
  Ranks(const Ranks&) = delete;
  Ranks& operator=(const Ranks&) = delete;

  virtual int rank() const { return 0; }
  virtual int size() const { return 1; }
  /// The one that speaks: prints, and puts shared output into its place.
  bool first() const { return rank() == 0; }

  /// Works on items [first, last) and returns one result (any bytes) for each.
  using Share =
      std::function<std::vector<std::string>(size_t first, size_t last, Progress& progress)>;
  /// Deals items 0 .. items - 1 out in consecutive shares, one to each rank. All results in the
  /// items' order at the first rank, none elsewhere. `progress` shows all ranks at the first one.
  /// When a rank throws or is asked to stop, all stop.
  virtual std::vector<std::string> gather(size_t items, const Share& work, Progress& progress);
  /// What the first rank makes of `make`, on every rank.
  virtual std::string fromFirst(const std::function<std::string()>& make);
  /// Runs `body`, which makes the calls above, on every rank, until it has ended on all of them.
  /// If it throws on any, the first rank throws that error (of another rank with its number in
  /// front) and the others EndedElsewhere.
  virtual void together(const std::function<void()>& body);
  /// Of several processes: `say` is called at the first one as soon as it is told to stop, on any
  /// thread. A launcher that lost a process may leave no time for more.
  virtual void whenStopped(const std::function<void()>& say);
};

/// Items of one rank's share: consecutive; the first ranks have one more where they cannot all have
/// as many.
std::pair<size_t, size_t> shareOf(size_t items, int rank, int size);

}  // namespace marey
