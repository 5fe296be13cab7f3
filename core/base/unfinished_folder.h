// An output folder in the making that outlives a broken run, so that the run can be resumed.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/json.h"

namespace marey {

/// Files of a run lie in TARGET.partial (inside the target, as TARGET/.partial, where that is
/// there: its parent may be closed to the user, or lie on another file system) until the whole run
/// has ended. The run is made of numbered parts; a part has a record once all its files are
/// written. Several processes may write to it: one opens and ends it, the others name its place.
class UnfinishedFolder {
 public:
  /// What tells one run from another ("model_hash", "seed", ...), and notes that a resumed run
  /// takes from the first start ("command").
  struct Run {
    Json identity = Json::object();
    Json notes = Json::object();
    size_t parts = 0;
  };

  /// Begins a run. Without `resume`, throws InputError where an unfinished one with a part or more
  /// is there; with it, unless there is one of the same identity (naming the key and both values).
  /// A run that is resumed has its own notes.
  static UnfinishedFolder open(const std::filesystem::path& target, const Run& run, bool resume);
  /// The same folder in another process.
  static UnfinishedFolder join(const std::filesystem::path& target,
                               const std::filesystem::path& place, Run run);

  const std::filesystem::path& place() const { return m_place; }
  const Run& run() const { return m_run; }
  /// Numbers of the parts that have no record yet.
  std::vector<size_t> missing() const;
  /// Says that all files of a part are there. Thread-safe.
  void record(size_t part, const Json& facts) const;
  /// Throws FileError or InputError where the part has none.
  Json recordOf(size_t part) const;
  /// Puts the files (names within the folder) into the target, replacing those of the same name,
  /// and ends the run. Throws FileError, before the first is moved where one has no place.
  void commit(const std::vector<std::string>& files) const;
  /// After a failure: removes a run of which no part is finished. How many are.
  size_t abandon() const;

 private:
  UnfinishedFolder(std::filesystem::path target, std::filesystem::path place, Run run);
  std::filesystem::path recordPath(size_t part) const;
  void adopt(const Run& wanted);
  void begin(const Run& run);

  std::filesystem::path m_target, m_place;
  Run m_run;
};

/// "0..3, 7": numbers in rising order as ranges.
std::string rangesText(const std::vector<size_t>& numbers);

}  // namespace marey
