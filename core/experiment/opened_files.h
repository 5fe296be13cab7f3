// What files are that somebody opens or drops, by what they hold.
#pragma once

#include <string>
#include <vector>

namespace marey {

struct OpenedFiles {
  std::vector<std::string> documents, paths, models;
  std::vector<std::string> motions;  ///< all others: files, folders and lists
};

/// A JSON file with way-points is a path, any other one a document (whose reader says what it
/// lacks). Never throws: what cannot be read is told by whoever opens it.
OpenedFiles sortOpened(const std::vector<std::string>& files);

}  // namespace marey
