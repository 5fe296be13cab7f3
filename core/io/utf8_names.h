// Names for files that are UTF-8 by their format.
#pragma once

#include <string>
#include <vector>

namespace marey::io {

/// The names with U+FFFD for bytes that are no UTF-8 (names out of old motion files); names that
/// would become the same are numbered, so that all differ that did.
std::vector<std::string> utf8Names(const std::vector<std::string>& names);

}  // namespace marey::io
