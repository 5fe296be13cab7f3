#include "io/bvh_rows.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <numbers>
#include <optional>

#include "motion/rotation.h"

namespace marey::io {
namespace {

struct MotionHeader {
  std::optional<size_t> frames;
  std::string frameTime;
};

/// "Frames: 31", "FRAMES 31", "Frame Time:0.05", "FrameTime : 0.05", on one line or several.
class HeaderReader {
 public:
  explicit HeaderReader(WordReader& words) : m_words(words) {}

  MotionHeader read() {
    while (startsHeader(m_words.peek())) {
      std::string_view word = m_words.next();
      std::string key = takeKey(word);
      if (sameIgnoringCase(key, "frame") && word.empty()) {
        word = m_words.next();
        key += takeKey(word);
      }
      if (word.starts_with(':')) word.remove_prefix(1);
      if (word.empty() && m_words.peek().starts_with(':')) {
        word = m_words.next();
        word.remove_prefix(1);
      }
      take(key, word.empty() ? m_words.next() : word);
    }
    return std::move(m_out);
  }

 private:
  static bool startsHeader(std::string_view word) {
    return sameIgnoringCase(word.substr(0, 5), "frame") ||
           sameIgnoringCase(word.substr(0, 4), "time");
  }

  /// Letters at the start of the word, which are taken off.
  static std::string takeKey(std::string_view& word) {
    const auto isLetter = [](unsigned char c) { return std::isalpha(c) != 0; };
    const auto end = std::find_if_not(word.begin(), word.end(), isLetter) - word.begin();
    std::string key(word.substr(0, static_cast<size_t>(end)));
    word.remove_prefix(static_cast<size_t>(end));
    return key;
  }

  void take(const std::string& key, std::string_view value) {
    if (sameIgnoringCase(key, "frames") && !m_out.frames)
      m_out.frames = frameCount(value);
    else if (sameIgnoringCase(key, "frametime") && m_out.frameTime.empty())
      m_out.frameTime = frameTime(value);
    else
      throw InputError(m_words.place(), "'Frames:' and 'Frame Time:', each once, with a number",
                       excerpt(key));
  }

  size_t frameCount(std::string_view text) const {
    const std::optional<double> count = parseNumber(text);
    if (!count || *count < 0.0 || *count != std::floor(*count) || *count > 1e15)
      throw InputError(m_words.place(), "a whole number of frames", excerpt(text));
    if (*count == 0.0) throw InputError(m_words.place(), "at least one frame", "zero frames");
    return static_cast<size_t>(*count);
  }

  std::string frameTime(std::string_view text) const {
    const std::optional<double> time = parseNumber(text);
    if (!time || !(*time > 1e-6) || *time > 1e6)
      throw InputError(m_words.place(), "a positive frame time in seconds", excerpt(text));
    return std::string(text);
  }

  WordReader& m_words;
  MotionHeader m_out;
};

/// q times a turn about one coordinate axis, without the products by zero.
void turn(Quatd& q, int axis, double degrees) {
  if (degrees == 0.0) return;
  const double half = degrees * (std::numbers::pi / 360.0);
  const double s = std::sin(half), c = std::cos(half);
  const int next = axis == 2 ? 0 : axis + 1, last = axis == 0 ? 2 : axis - 1;
  auto& v = q.coeffs();
  const double along = v[axis], w = v[3], a = v[next], b = v[last];
  v[axis] = along * c + w * s;
  v[3] = w * c - along * s;
  v[next] = a * c + b * s;
  v[last] = b * c - a * s;
}

/// Whether a word is meant as a number, right or wrong: digits, nan, inf.
bool meansNumber(std::string_view word) {
  while (!word.empty() && (word.front() == '+' || word.front() == '-')) word.remove_prefix(1);
  const auto isDigit = [](unsigned char c) { return std::isdigit(c) != 0; };
  if (word.size() > 1 && word.front() == '.') word.remove_prefix(1);
  return (!word.empty() && isDigit(word.front())) || sameIgnoringCase(word.substr(0, 3), "nan") ||
         sameIgnoringCase(word.substr(0, 3), "inf");
}

class RowReader {
 public:
  RowReader(const BvhHierarchy& hierarchy, const std::vector<std::vector<size_t>>& turns,
            const MotionHeader& header, LineReader& lines, bool wholeRows)
      : m_hierarchy(hierarchy),
        m_turns(turns),
        m_header(header),
        m_lines(lines),
        m_wholeRows(wholeRows),
        m_width(hierarchy.channelCount()) {
    // A header may promise anything: memory is taken for what the rest of the file can hold.
    const size_t room =
        std::min(header.frames.value_or(SIZE_MAX), lines.bytesLeft() / (2 * m_width) + 1);
    for (const BvhTree& tree : hierarchy.trees) {
      m_out.trees.emplace_back();
      m_out.trees.back().rotations.reserve(room * tree.skeleton.names.size());
      m_out.trees.back().translations.reserve(room * tree.skeleton.names.size());
    }
  }

  BvhMotion read() {
    m_out.rest = m_lines.rest();
    m_out.restBefore = m_lines.line();
    while (const auto line = m_lines.nextFilled()) {
      if (isComment(trim(*line))) {
        ++m_comments;
      } else if (m_row.empty() && m_rows + 1 >= m_header.frames.value_or(0) && m_rows > 0 &&
                 !meansNumber(words(*line).front())) {
        break;  // what follows is no motion
      } else {
        takeLine(*line);
      }
      m_out.rest = m_lines.rest();
      m_out.restBefore = m_lines.line();
    }
    finish();
    return std::move(m_out);
  }

 private:
  /// How lines and rows go together, as far as the lines up to here tell.
  enum class Layout { Unknown, RowPerLine, LinesPerRow, Stream };

  void takeLine(std::string_view line) {
    if (m_cutLine) wrongLength(*m_cutLine, m_cutCount);
    size_t count = 0;
    double value = 0.0;
    NumberResult result = NumberResult::Number;
    while ((result = takeNumber(line, value)) == NumberResult::Number) {
      if (m_row.empty() && count > 0 && m_layout != Layout::Stream) crossLine();
      ++count;
      m_row.push_back(value);
      if (m_row.size() == m_width && m_layout == Layout::RowPerLine && !trim(line).empty())
        wrongLength(m_lines.line(), count + words(line).size());
      if (m_row.size() == m_width) emitRow();
    }
    if (result == NumberResult::Bad)
      throw InputError(place(m_lines.line()), "a finite number", excerpt(takeWord(line)));
    if (m_layout == Layout::Unknown)
      m_layout = count == m_width ? Layout::RowPerLine : Layout::LinesPerRow;
    if (m_layout == Layout::RowPerLine && count != m_width) {
      m_cutLine = m_lines.line();
      m_cutCount = count;
    }
  }

  /// A row begins inside a line.
  void crossLine() {
    m_layout = Layout::Stream;
    m_crossedLine = m_lines.line();
  }

  void emitRow() {
    size_t joint = 0, at = 0;
    for (size_t k = 0; k < m_hierarchy.trees.size(); ++k) {
      const BvhTree& tree = m_hierarchy.trees[k];
      for (size_t j = 0; j < tree.channels.size(); ++j, ++joint)
        at = emitJoint(tree.channels[j], m_turns[joint], tree.skeleton.offsets[j], at,
                       m_out.trees[k]);
    }
    m_row.clear();
    ++m_rows;
  }

  /// Returns where the numbers of the next joint begin.
  size_t emitJoint(const std::vector<BvhChannel>& channels, const std::vector<size_t>& turns,
                   Vec3 translation, size_t at, JointTransforms& out) const {
    Quatd rotation = Quatd::Identity();
    for (size_t c = 0; c < channels.size(); ++c)
      if (!channels[c].rotation) translation[channels[c].axis] = static_cast<float>(m_row[at + c]);
    for (const size_t c : turns) turn(rotation, channels[c].axis, m_row[at + c]);
    out.rotations.push_back(rotation.cast<float>().normalized());
    out.translations.push_back(translation);
    return at + channels.size();
  }

  void finish() {
    if (m_rows == 0 && m_row.empty())
      throw InputError(place(m_lines.line()),
                       m_header.frames
                           ? fmt::format("{} frames, as the header says", *m_header.frames)
                           : "at least one frame",
                       "none");
    if (m_rows == 0) wrongLength(m_lines.line(), m_row.size());
    if (m_layout == Layout::Stream)
      checkStream();
    else
      checkRows();
    if (!m_row.empty())
      m_out.notes.push_back(
          fmt::format("line {}: the last row has {} of {} numbers and is left out",
                      m_cutLine.value_or(m_lines.line()), m_row.size(), m_width));
    if (m_layout == Layout::LinesPerRow)
      m_out.notes.push_back("rows are broken over several lines");
    if (m_layout == Layout::Stream)
      m_out.notes.push_back(
          fmt::format("rows do not begin where lines begin (line {})", m_crossedLine));
    if (m_comments > 0)
      m_out.notes.push_back(fmt::format("{} remarks among the rows are not read", m_comments));
  }

  /// Without lines to hold on to, only the exact number of numbers tells that none is missing.
  void checkStream() const {
    if (m_row.empty() && m_rows == m_header.frames.value_or(m_rows)) return;
    const size_t found = m_rows * m_width + m_row.size();
    throwInput({.path = m_lines.origin(), .line = m_crossedLine},
               m_header.frames ? fmt::format("{} numbers in every row, {} in {} rows", m_width,
                                             m_width * *m_header.frames, *m_header.frames)
                               : fmt::format("whole rows of {} numbers", m_width),
               "{}, and rows that do not begin where lines begin", found);
  }

  void checkRows() {
    if (!m_header.frames) {
      m_out.notes.push_back(fmt::format("the header has no line 'Frames:': {} are there", m_rows));
      return;
    }
    const size_t told = *m_header.frames;
    if (m_rows == told) return;
    const size_t miss = m_rows > told ? m_rows - told : told - m_rows;
    if (miss > 1 && !m_wholeRows)
      throwInput({.path = m_lines.origin(), .line = m_lines.line()},
                 fmt::format("{} frames, as the header says", told),
                 "the end of the file after {} whole rows{} (--whole-rows reads those)", m_rows,
                 m_row.empty() ? std::string() : fmt::format(" and {} numbers", m_row.size()));
    m_out.notes.push_back(fmt::format("the header says {} frames, the file has {}: {} are read",
                                      told, m_rows, m_rows));
  }

  Place place(int64_t line) const {
    return {.path = m_lines.origin(), .line = line, .frame = static_cast<int64_t>(m_rows) + 1};
  }

  [[noreturn]] void wrongLength(int64_t line, size_t found) const {
    throwInput(place(line), fmt::format("{} numbers", m_width), "{}", found);
  }

  const BvhHierarchy& m_hierarchy;
  const std::vector<std::vector<size_t>>& m_turns;
  const MotionHeader& m_header;
  LineReader& m_lines;
  bool m_wholeRows;
  size_t m_width;
  Layout m_layout = Layout::Unknown;
  std::vector<double> m_row;  ///< numbers of the row that is not whole yet
  size_t m_rows = 0;
  std::optional<int64_t> m_cutLine;  ///< a line of too few numbers, allowed at the end only
  size_t m_cutCount = 0;
  int64_t m_crossedLine = 0;
  int m_comments = 0;
  BvhMotion m_out;
};

}  // namespace

BvhMotion readBvhMotion(WordReader& words, const BvhHierarchy& hierarchy,
                        const std::vector<std::vector<size_t>>& turns, bool wholeRows) {
  const MotionHeader header = HeaderReader(words).read();
  const std::string_view first = words.peek();
  if (!first.empty() && !meansNumber(first))
    throw InputError(words.place(), "'Frames:' and 'Frame Time:', then rows of numbers",
                     excerpt(first));
  LineReader lines(words.rest(), words.origin(), words.line() - 1);
  BvhMotion out = RowReader(hierarchy, turns, header, lines, wholeRows).read();
  out.frameTime = header.frameTime;
  return out;
}

}  // namespace marey::io
