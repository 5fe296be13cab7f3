// What an import does with files, without widgets.
#pragma once

#include <filesystem>
#include <vector>

#include "base/job.h"
#include "io/doctor.h"

namespace marey {

struct ImportFile {
  std::string path;
  std::string source;  ///< the file, folder or list that was given and holds it
  io::ReadOptions options;
  std::vector<io::DoctorReport> reports;  ///< one per clip; empty: not examined yet
  bool wanted = true;                     ///< by the user
  bool skipped = false;  ///< its folder or list leaves it out by itself; the report says why

  /// A document names files only, so what their readers should be told has to be carried out.
  bool overridden() const;
  bool readable() const;
  bool taken() const { return wanted && readable(); }
};

struct ImportList {
  std::vector<ImportFile> files;
  std::vector<std::string> remarks;  ///< on files of other formats in folders
};

/// Files of the given files, folders and lists, those that are not read at the end of each. Throws
/// as io::findInputs does.
ImportList importFiles(const std::vector<std::string>& given);
/// Reads overridden files as they should be read and writes their clips as NPZ into `folder`, all
/// or none. Returns the sources to add to a document: written files, files as they are, and whole
/// folders and lists where each of their files is taken as it is.
std::vector<std::string> convertOverridden(const std::vector<ImportFile>& files,
                                           const std::filesystem::path& folder, Progress& progress);

}  // namespace marey
