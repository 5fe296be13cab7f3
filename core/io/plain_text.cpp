#include "io/plain_text.h"

#include <algorithm>
#include <cstdint>
#include <optional>

#include <fmt/format.h>

namespace marey::io {
namespace {

constexpr std::string_view kMark = "\xEF\xBB\xBF";

enum class Order { Little, Big };

/// The byte order of UTF-16, by its mark or, in a text without one, by the zeros of its letters.
std::optional<Order> utf16Order(std::string_view bytes) {
  if (bytes.starts_with("\xFF\xFE")) return Order::Little;
  if (bytes.starts_with("\xFE\xFF")) return Order::Big;
  constexpr size_t kLooked = 64;
  const std::string_view head = bytes.substr(0, kLooked);
  if (head.size() < 8) return std::nullopt;
  size_t zeros[2] = {0, 0};
  for (size_t i = 0; i < head.size(); ++i) zeros[i % 2] += head[i] == '\0' ? 1 : 0;
  const size_t most = head.size() / 2 - head.size() / 16;
  if (zeros[1] >= most && zeros[0] == 0) return Order::Little;
  if (zeros[0] >= most && zeros[1] == 0) return Order::Big;
  return std::nullopt;
}

void appendUtf8(std::string& out, uint32_t code) {
  const auto byte = [&out](uint32_t value) { out += static_cast<char>(value); };
  if (code < 0x80) {
    byte(code);
  } else if (code < 0x800) {
    byte(0xC0 | (code >> 6));
    byte(0x80 | (code & 0x3F));
  } else if (code < 0x10000) {
    byte(0xE0 | (code >> 12));
    byte(0x80 | ((code >> 6) & 0x3F));
    byte(0x80 | (code & 0x3F));
  } else {
    byte(0xF0 | (code >> 18));
    byte(0x80 | ((code >> 12) & 0x3F));
    byte(0x80 | ((code >> 6) & 0x3F));
    byte(0x80 | (code & 0x3F));
  }
}

uint32_t unitAt(std::string_view bytes, size_t at, Order order) {
  const auto a = static_cast<unsigned char>(bytes[at]);
  const auto b = static_cast<unsigned char>(bytes[at + 1]);
  return order == Order::Little ? a | (static_cast<uint32_t>(b) << 8)
                                : b | (static_cast<uint32_t>(a) << 8);
}

std::string utf8Of(std::string_view bytes, Order order) {
  constexpr uint32_t kReplacement = 0xFFFD;
  std::string out;
  out.reserve(bytes.size() / 2);
  for (size_t at = 0; at + 1 < bytes.size(); at += 2) {
    uint32_t code = unitAt(bytes, at, order);
    if (code >= 0xD800 && code < 0xE000) {
      const uint32_t low = at + 3 < bytes.size() ? unitAt(bytes, at + 2, order) : 0;
      const bool pair = code < 0xDC00 && low >= 0xDC00 && low < 0xE000;
      code = pair ? 0x10000 + ((code - 0xD800) << 10) + (low - 0xDC00) : kReplacement;
      if (pair) at += 2;
    }
    appendUtf8(out, code);
  }
  return out;
}

bool isPadding(char c) {
  constexpr char kEndOfDosText = '\x1A';
  return c == '\0' || c == kEndOfDosText;
}

}  // namespace

PlainText::PlainText(std::string_view bytes) : m_text(bytes) {
  decodeUtf16();
  if (m_text.starts_with(kMark)) m_text.remove_prefix(kMark.size());
  trimEnd();
  dropNuls();
  endLines();
}

void PlainText::decodeUtf16() {
  const std::optional<Order> order = utf16Order(m_text);
  if (!order) return;
  m_own = utf8Of(m_text, *order);
  m_text = m_own;
  m_notes.push_back(
      fmt::format("the text is UTF-16 ({} endian)", *order == Order::Little ? "little" : "big"));
}

/// Padding after the text, as old systems and broken copies leave it.
void PlainText::trimEnd() {
  size_t end = m_text.size();
  while (end > 0 && isPadding(m_text[end - 1])) --end;
  if (end == m_text.size()) return;
  m_notes.push_back(
      fmt::format("{} bytes of padding at the end are left out", m_text.size() - end));
  m_text = m_text.substr(0, end);
}

void PlainText::dropNuls() {
  const auto nuls = std::count(m_text.begin(), m_text.end(), '\0');
  if (nuls == 0) return;
  std::string out(m_text);
  std::replace(out.begin(), out.end(), '\0', ' ');
  m_own = std::move(out);
  m_text = m_own;
  m_notes.push_back(fmt::format("{} NUL bytes are read as blanks", nuls));
}

/// CR not followed by LF ends a line; CR CR LF, of text that was converted twice, ends one.
void PlainText::endLines() {
  constexpr auto npos = std::string_view::npos;
  const auto endOfRun = [this](size_t at) { return m_text.find_first_not_of('\r', at); };
  const auto isAlone = [&](size_t at) {
    return endOfRun(at) == npos || m_text[endOfRun(at)] != '\n';
  };
  size_t first = m_text.find('\r');
  while (first != npos && !isAlone(first)) first = m_text.find('\r', endOfRun(first));
  if (first == npos) return;
  std::string out(m_text.substr(0, first));
  out.reserve(m_text.size());
  for (size_t at = first; at < m_text.size();) {
    if (m_text[at] != '\r') {
      const size_t next = std::min(m_text.find('\r', at), m_text.size());
      out += m_text.substr(at, next - at);
      at = next;
      continue;
    }
    const size_t end = std::min(endOfRun(at), m_text.size());
    if (isAlone(at)) out.append(end - at, '\n');
    at = end;
  }
  m_own = std::move(out);
  m_text = m_own;
  m_notes.push_back("lines end with CR alone");
}

}  // namespace marey::io
