// The errors of Marey. `main` catches `Error` once: message on stderr, exit status 1
// (2 for UsageError). Every message names the place, what was expected and what was found.
#pragma once

#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include <fmt/format.h>

namespace marey {

class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Where in an input a fault was found. `line` and `frame` are 1-based for people.
struct Place {
  std::string path;
  std::optional<int64_t> line = std::nullopt;
  std::optional<int64_t> frame = std::nullopt;
  std::string item = {};  ///< joint, tensor, JSON key, ...

  std::string text() const;
};

/// The content of a file or argument is wrong.
class InputError : public Error {
 public:
  using Error::Error;
  /// Message: "PLACE: expected EXPECTED, found FOUND".
  InputError(const Place& place, const std::string& expected, const std::string& found);
};

/// A file cannot be opened, read or written (missing, no permission, full disk).
class FileError : public Error {
 public:
  using Error::Error;
};

/// The command line is wrong; exit status 2.
class UsageError : public Error {
 public:
  using Error::Error;
};

/// A computation left the range where its result means anything (NaN, singular matrix).
class NumericError : public Error {
 public:
  using Error::Error;
};

/// The user asked to stop.
class CancelledError : public Error {
 public:
  CancelledError() : Error("cancelled") {}
};

/// throwInput(place, "21 joints", "{} joints", n): an InputError with a formatted 'found'.
template <typename... Args>
[[noreturn]] void throwInput(const Place& place, const std::string& expected,
                             fmt::format_string<Args...> found, Args&&... args) {
  throw InputError(place, expected, fmt::format(found, std::forward<Args>(args)...));
}

}  // namespace marey
