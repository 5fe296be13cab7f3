// Text as a field of comma-separated values (RFC 4180).
#pragma once

#include <string>

namespace marey {

/// In quotes, with quotes inside doubled, where it holds a comma, a quote or a line break.
std::string csvField(const std::string& text);

}  // namespace marey
