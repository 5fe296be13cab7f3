// Values as bytes, for results that processes of one run hand to each other: exact, in the form of
// the machine, never stored.
#pragma once

#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "base/error.h"

namespace marey {

class Packer {
 public:
  template <typename T>
  requires std::is_arithmetic_v<T> Packer& add(T value) {
    m_bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
    return *this;
  }
  template <typename T>
  Packer& add(std::span<const T> values) {
    static_assert(std::is_trivially_copyable_v<T>);
    add(values.size());
    m_bytes.append(reinterpret_cast<const char*>(values.data()), values.size_bytes());
    return *this;
  }
  template <typename T>
  Packer& add(const std::vector<T>& values) {
    return add(std::span<const T>(values));
  }
  Packer& add(const std::string& text) {
    return add(std::span<const char>(text.data(), text.size()));
  }
  std::string take() { return std::move(m_bytes); }

 private:
  std::string m_bytes;
};

/// Reads in the order of writing. Throws Error where there is less than was asked for.
class Unpacker {
 public:
  explicit Unpacker(std::string_view bytes) : m_rest(bytes) {}

  template <typename T>
  requires std::is_arithmetic_v<T> T number() {
    T out;
    copy(&out, sizeof out);
    return out;
  }
  template <typename T>
  std::vector<T> list() {
    std::vector<T> out(count(sizeof(T)));
    copy(out.data(), out.size() * sizeof(T));
    return out;
  }
  std::string text() {
    std::string out(count(1), '\0');
    copy(out.data(), out.size());
    return out;
  }
  bool done() const { return m_rest.empty(); }

 private:
  size_t count(size_t size) {
    const auto values = number<size_t>();
    if (values > m_rest.size() / size) fail(values);
    return values;
  }
  void copy(void* to, size_t size) {
    if (size > m_rest.size()) fail(size);
    if (size > 0) std::memcpy(to, m_rest.data(), size);
    m_rest.remove_prefix(size);
  }
  [[noreturn]] void fail(size_t wanted) const {
    throw Error(fmt::format("packed result: expected {} more values, found {} bytes", wanted,
                            m_rest.size()));
  }

  std::string_view m_rest;
};

}  // namespace marey
