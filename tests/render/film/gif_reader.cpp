#include "render/film/gif_reader.h"

#include <algorithm>
#include <stdexcept>

namespace marey::render {
namespace {

using Palette = std::vector<std::array<uint8_t, 3>>;

class Bytes {
 public:
  explicit Bytes(const std::string& all) : m_all(all) {}
  int byte() { return static_cast<unsigned char>(m_all.at(m_at++)); }
  int word() {
    const int low = byte();
    return low + 256 * byte();
  }
  std::string text(size_t count) {
    m_at += count;
    return m_all.substr(m_at - count, count);
  }
  /// Data sub-blocks up to the empty one.
  std::string blocks() {
    std::string out;
    for (int size = byte(); size != 0; size = byte()) out += text(static_cast<size_t>(size));
    return out;
  }
  Palette palette(int flags) {
    Palette out((flags & 0x80) != 0 ? size_t{2} << (flags & 7) : 0);
    for (auto& colour : out)
      for (uint8_t& c : colour) c = static_cast<uint8_t>(byte());
    return out;
  }

 private:
  const std::string& m_all;
  size_t m_at = 0;
};

/// Variable-length-code LZW (appendix F).
std::vector<uint8_t> decompress(const std::string& data, int bits) {
  const int clear = 1 << bits, end = clear + 1;
  std::vector<std::string> table;
  int width = 0;
  const auto restart = [&] {
    table.assign(static_cast<size_t>(end + 1), {});
    for (int i = 0; i < clear; ++i) table[static_cast<size_t>(i)] = {static_cast<char>(i)};
    width = bits + 1;
  };
  restart();
  std::string out, last;
  uint32_t held = 0;
  int count = 0;
  for (const char c : data) {
    held |= static_cast<uint32_t>(static_cast<unsigned char>(c)) << count;
    count += 8;
    while (count >= width) {
      const int code = static_cast<int>(held & ((1U << width) - 1U));
      held >>= width;
      count -= width;
      if (code == end) return {out.begin(), out.end()};
      if (code == clear) {
        restart();
        last.clear();
        continue;
      }
      const auto at = static_cast<size_t>(code);
      if (at > table.size() || (at == table.size() && last.empty()))
        throw std::runtime_error("a code that is not in the table");
      const std::string entry = at < table.size() ? table[at] : last + last[0];
      if (!last.empty() && table.size() < 4096) table.push_back(last + entry[0]);
      if (static_cast<int>(table.size()) == 1 << width && width < 12) ++width;
      out += entry;
      last = entry;
    }
  }
  throw std::runtime_error("no end code");
}

struct Control {
  int disposal = 0, transparent = -1, delay = 0;
};

void readFrame(Bytes& in, const Palette& global, const Control& control, Image& canvas, Gif& gif) {
  const int left = in.word(), top = in.word(), width = in.word(), height = in.word(),
            flags = in.byte();
  if ((flags & 0x40) != 0) throw std::runtime_error("interlaced frames are not expected here");
  const Palette own = in.palette(flags);
  const Palette& palette = own.empty() ? global : own;
  const int bits = in.byte();
  const std::vector<uint8_t> indices = decompress(in.blocks(), bits);
  if (indices.size() != static_cast<size_t>(width) * static_cast<size_t>(height) ||
      left + width > gif.width || top + height > gif.height)
    throw std::runtime_error("a frame of another size than it says");
  const Image before = canvas;
  for (size_t i = 0; i < indices.size(); ++i) {
    if (indices[i] == control.transparent) continue;
    uint8_t* pixel =
        canvas.at(left + static_cast<int>(i) % width, top + static_cast<int>(i) / width);
    std::copy_n(palette.at(indices[i]).data(), 3, pixel);
    pixel[3] = 255;
  }
  gif.frames.push_back(canvas);
  gif.hundredths.push_back(control.delay);
  if (control.disposal == 3) canvas = before;
  for (int y = top; control.disposal == 2 && y < top + height; ++y)
    std::fill_n(canvas.at(left, y), 4 * width, uint8_t{0});
}

}  // namespace

Gif readGif(const std::string& bytes) {
  Bytes in(bytes);
  if (in.text(6) != "GIF89a") throw std::runtime_error("not a GIF89a");
  Gif gif;
  gif.width = in.word();
  gif.height = in.word();
  const int flags = in.byte();
  in.text(2);  // background and aspect
  const Palette global = in.palette(flags);
  Image canvas(gif.width, gif.height, {0, 0, 0, 0});
  Control control;
  for (int kind = in.byte(); kind != 0x3b; kind = in.byte()) {
    if (kind == 0x2c) {
      readFrame(in, global, control, canvas, gif);
      control = {};
      continue;
    }
    if (kind != 0x21) throw std::runtime_error("neither a frame nor an extension");
    const int label = in.byte();
    const std::string data = in.blocks();
    const auto at = [&](size_t i) { return static_cast<unsigned char>(data.at(i)); };
    if (label == 0xf9)
      control = {at(0) >> 2 & 7, (at(0) & 1) != 0 ? at(3) : -1, at(1) + 256 * at(2)};
    if (label == 0xff && data.starts_with("NETSCAPE2.0")) gif.endless = at(12) + 256 * at(13) == 0;
  }
  return gif;
}

}  // namespace marey::render
