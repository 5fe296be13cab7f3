#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <unordered_set>

#include "io/bvh.h"
#include "io/euler_order.h"
#include "io/normalise.h"
#include "io/text.h"
#include "motion/rotation.h"

namespace marey::io {
namespace {

/// Of one joint: three positions and up to six turns; no writer has more.
constexpr size_t kMostChannels = 9;

struct Channel {
  int axis = 0;
  bool rotation = false;
};

/// The tree and what each column of a frame's line means.
struct Hierarchy {
  Skeleton skeleton;
  std::vector<std::vector<Channel>> channels;  ///< per joint
  std::vector<std::string> notes;

  size_t channelCount() const {
    size_t out = 0;
    for (const auto& c : channels) out += c.size();
    return out;
  }
};

class HierarchyParser {
 public:
  explicit HierarchyParser(LineReader& lines) : m_lines(lines) {}

  /// Reads up to and including the line MOTION.
  Hierarchy parse() {
    expectFirstLine();
    while (!m_done) {
      const auto line = m_lines.nextFilled();
      if (!line)
        throw InputError(m_lines.place(), "MOTION after the hierarchy", "the end of the file");
      m_rest = *line;
      for (std::string_view word = takeWord(m_rest); !word.empty(); word = takeWord(m_rest))
        handle(word);
    }
    finish();
    return std::move(m_out);
  }

 private:
  static constexpr int kEndSite = -2;  ///< on the stack: an end site in place of a joint

  void expectFirstLine() {
    const auto line = m_lines.nextFilled();
    std::string_view text = line ? trim(*line) : std::string_view();
    if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
    if (!sameIgnoringCase(text, "HIERARCHY"))
      throw InputError(m_lines.place(), "HIERARCHY as the first line of a BVH file", excerpt(text));
  }

  void handle(std::string_view word) {
    if (word == "{") return open();
    if (word == "}") return close();
    if (m_pending) throw InputError(m_lines.place(), "'{'", excerpt(word));
    if (sameIgnoringCase(word, "ROOT")) return startJoint(true);
    if (sameIgnoringCase(word, "JOINT")) return startJoint(false);
    if (sameIgnoringCase(word, "End")) return startEndSite();
    if (sameIgnoringCase(word, "OFFSET")) return readOffset();
    if (sameIgnoringCase(word, "CHANNELS")) return readChannels();
    if (sameIgnoringCase(word, "MOTION") && m_stack.empty()) {
      m_done = true;
      return;
    }
    throw InputError(m_lines.place(), "JOINT, End Site, OFFSET, CHANNELS, a brace or MOTION",
                     excerpt(word));
  }

  void open() {
    if (!m_pending) throw InputError(m_lines.place(), "a joint before '{'", "none");
    m_stack.push_back(*m_pending);
    m_pending.reset();
  }

  void close() {
    if (m_pending || m_stack.empty())
      throw InputError(m_lines.place(), "an open joint before '}'", "none");
    m_stack.pop_back();
  }

  /// The name is the rest of the line (names may hold blanks), without an opening brace.
  std::string takeName() {
    std::string_view name = trim(m_rest);
    m_rest = {};
    if (name.ends_with('{')) {
      m_rest = name.substr(name.size() - 1);
      name = trim(name.substr(0, name.size() - 1));
    }
    if (name.empty()) throw InputError(m_lines.place(), "the name of a joint", "none");
    return std::string(name);
  }

  void startJoint(bool root) {
    Skeleton& s = m_out.skeleton;
    if (root && s.jointCount() > 0) throw InputError(m_lines.place(), "one ROOT", "a second one");
    if (!root && (m_stack.empty() || m_stack.back() == kEndSite))
      throw InputError(m_lines.place(), "JOINT inside another joint", "it elsewhere");
    s.names.push_back(uniqueName(takeName()));
    s.parents.push_back(root ? -1 : m_stack.back());
    s.offsets.push_back(Vec3::Zero());
    m_out.channels.emplace_back();
    m_pending = s.jointCount() - 1;
  }

  std::string uniqueName(const std::string& name) {
    std::string out = name;
    for (int n = 2; !m_names.insert(out).second; ++n) out = fmt::format("{}_{}", name, n);
    if (out != name)
      m_out.notes.push_back(
          fmt::format("line {}: a second joint '{}' is called '{}'", m_lines.line(), name, out));
    return out;
  }

  void startEndSite() {
    const std::string_view word = takeWord(m_rest);
    if (!sameIgnoringCase(word, "Site"))
      throw InputError(m_lines.place(), "End Site", "End " + std::string(word));
    if (m_stack.empty() || m_stack.back() == kEndSite)
      throw InputError(m_lines.place(), "End Site inside a joint", "it elsewhere");
    m_out.skeleton.endSites.push_back({.parent = m_stack.back()});
    m_pending = kEndSite;
    const std::string_view rest = trim(m_rest);  // some writers name the site
    if (!rest.starts_with('{')) m_rest = {};
  }

  void readOffset() {
    if (m_stack.empty()) throw InputError(m_lines.place(), "OFFSET inside a joint", "it elsewhere");
    Vec3 offset;
    for (int i = 0; i < 3; ++i) {
      double value = 0.0;
      if (takeNumber(m_rest, value) != NumberResult::Number)
        throw InputError(m_lines.place("OFFSET"), "three finite numbers", excerpt(trim(m_rest)));
      offset[i] = static_cast<float>(value);
    }
    Skeleton& s = m_out.skeleton;
    if (m_stack.back() == kEndSite)
      s.endSites.back().offset = offset;
    else
      s.offsets[static_cast<size_t>(m_stack.back())] = offset;
  }

  void readChannels() {
    if (m_stack.empty() || m_stack.back() == kEndSite)
      throw InputError(m_lines.place(), "CHANNELS inside a joint", "it elsewhere");
    auto& channels = m_out.channels[static_cast<size_t>(m_stack.back())];
    if (!channels.empty()) throw InputError(m_lines.place(), "CHANNELS once per joint", "it twice");
    const std::string_view countWord = takeWord(m_rest);
    const std::optional<double> count = parseNumber(countWord);
    if (!count || *count < 0.0 || *count > static_cast<double>(kMostChannels) ||
        *count != std::floor(*count))
      throw InputError(m_lines.place("CHANNELS"), "a number of channels from 0 to 9",
                       excerpt(countWord));
    for (int i = 0; i < static_cast<int>(*count); ++i) channels.push_back(takeChannel());
  }

  Channel takeChannel() {
    const std::string_view word = takeWord(m_rest);
    for (int axis = 0; axis < 3; ++axis) {
      const char letter = "XYZ"[axis];
      if (sameIgnoringCase(word, std::string{letter} + "position")) return {axis, false};
      if (sameIgnoringCase(word, std::string{letter} + "rotation")) return {axis, true};
    }
    throw InputError(m_lines.place("CHANNELS"),
                     "Xposition, ..., Zposition, Xrotation, ..., Zrotation",
                     word.empty() ? "fewer channels than their number says" : excerpt(word));
  }

  void finish() const {
    if (m_out.skeleton.jointCount() == 0)
      throw InputError(m_lines.place(), "a ROOT joint before MOTION", "none");
    if (m_out.channelCount() == 0)
      throw InputError(m_lines.place(), "a joint with channels", "none in the whole hierarchy");
  }

  LineReader& m_lines;
  Hierarchy m_out;
  std::string_view m_rest;
  std::vector<int> m_stack;
  std::optional<int> m_pending;  ///< a joint or end site that waits for its '{'
  std::unordered_set<std::string> m_names;
  bool m_done = false;
};

struct MotionHeader {
  size_t frames = 0;
  SnappedRate rate;
  std::string frameTime;
};

/// The text after "KEY:" on the next line.
std::string_view valueAfter(LineReader& lines, std::string_view key) {
  const auto line = lines.nextFilled();
  const std::string expected = fmt::format("'{}:' with a number", key);
  if (!line) throw InputError(lines.place(), expected, "the end of the file");
  const size_t colon = line->find(':');
  if (colon == std::string_view::npos || !sameIgnoringCase(trim(line->substr(0, colon)), key))
    throw InputError(lines.place(), expected, excerpt(trim(*line)));
  return trim(line->substr(colon + 1));
}

MotionHeader readMotionHeader(LineReader& lines) {
  MotionHeader out;
  const std::string_view countText = valueAfter(lines, "Frames");
  const std::optional<double> count = parseNumber(countText);
  if (!count || *count < 0.0 || *count != std::floor(*count) || *count > 1e15)
    throw InputError(lines.place(), "a whole number of frames", excerpt(countText));
  if (*count == 0.0) throw InputError(lines.place(), "at least one frame", "zero frames");
  out.frames = static_cast<size_t>(*count);
  const std::string_view timeText = valueAfter(lines, "Frame Time");
  const std::optional<double> time = parseNumber(timeText);
  if (!time || !(*time > 1e-6) || *time > 1e6)
    throw InputError(lines.place(), "a positive frame time in seconds", excerpt(timeText));
  out.frameTime = std::string(timeText);
  out.rate = rateOfFrameTime(timeText);
  return out;
}

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

/// The numbers of one frame's line into one local transform per joint.
class RowReader {
 public:
  RowReader(const Hierarchy& hierarchy, const std::vector<std::vector<size_t>>& turns,
            const LineReader& lines)
      : m_hierarchy(hierarchy),
        m_turns(turns),
        m_lines(lines),
        m_expected(hierarchy.channelCount()) {}

  void read(std::string_view row, int64_t frame, JointTransforms& out) const {
    size_t found = 0;
    const Skeleton& s = m_hierarchy.skeleton;
    for (size_t j = 0; j < s.names.size(); ++j) {
      Quatd rotation = Quatd::Identity();
      Vec3 translation = s.offsets[j];
      const std::vector<Channel>& channels = m_hierarchy.channels[j];
      std::array<double, kMostChannels> values{};
      for (size_t c = 0; c < channels.size(); ++c) {
        values[c] = take(row, frame, found++);
        if (!channels[c].rotation) translation[channels[c].axis] = static_cast<float>(values[c]);
      }
      for (const size_t c : m_turns[j]) turn(rotation, channels[c].axis, values[c]);
      out.rotations.push_back(rotation.cast<float>().normalized());
      out.translations.push_back(translation);
    }
    double extra = 0.0;
    while (takeNumber(row, extra) == NumberResult::Number) ++found;
    if (found != m_expected || !trim(row).empty()) wrongLength(frame, found);
  }

 private:
  double take(std::string_view& row, int64_t frame, size_t found) const {
    double value = 0.0;
    const NumberResult result = takeNumber(row, value);
    if (result == NumberResult::End) wrongLength(frame, found);
    if (result == NumberResult::Bad)
      throw InputError(place(frame), "a finite number", excerpt(takeWord(row)));
    return value;
  }

  Place place(int64_t frame) const {
    return {.path = m_lines.origin(), .line = m_lines.line(), .frame = frame};
  }

  [[noreturn]] void wrongLength(int64_t frame, size_t found) const {
    throwInput(place(frame), fmt::format("{} numbers", m_expected), "{}", found);
  }

  const Hierarchy& m_hierarchy;
  const std::vector<std::vector<size_t>>& m_turns;
  const LineReader& m_lines;
  size_t m_expected;
};

JointTransforms readRows(LineReader& lines, const Hierarchy& hierarchy,
                         const std::vector<std::vector<size_t>>& turns,
                         const MotionHeader& header) {
  // A header may promise anything: memory is taken for what the rest of the file can hold.
  const size_t shortestRow = std::max<size_t>(2 * hierarchy.channelCount(), 1);
  const size_t room = std::min(header.frames, lines.bytesLeft() / shortestRow + 1);
  JointTransforms out;
  out.rotations.reserve(room * hierarchy.skeleton.names.size());
  out.translations.reserve(room * hierarchy.skeleton.names.size());
  const RowReader rows(hierarchy, turns, lines);
  size_t frames = 0;
  while (const auto line = lines.nextFilled()) {
    if (frames == header.frames)
      throw InputError(lines.place(), fmt::format("the end after {} frames", header.frames),
                       "more lines: " + excerpt(trim(*line)));
    rows.read(*line, static_cast<int64_t>(++frames), out);
  }
  if (frames != header.frames)
    throwInput(lines.place(), fmt::format("{} frames, as the header says", header.frames),
               "the end of the file after {}", frames);
  return out;
}

std::vector<int> turnAxes(const std::vector<Channel>& channels) {
  std::vector<int> out;
  for (const Channel& channel : channels) out.push_back(channel.rotation ? channel.axis : -1);
  return out;
}

}  // namespace

SnappedRate rateOfFrameTime(std::string_view text) {
  const double time = parseNumber(text).value_or(0.0);
  const double fps = 1.0 / time;
  if (std::abs(fps - std::round(fps)) < 1e-9 * fps) return {std::round(fps), false};
  const size_t dot = text.find('.');
  const size_t exponent = text.find_first_of("eE");
  if (dot == std::string_view::npos || exponent != std::string_view::npos) return {fps, false};
  const double unit = std::pow(10.0, -static_cast<double>(text.size() - dot - 1));
  static constexpr double rates[] = {
      30.0,  60.0,  120.0,        24.0,         90.0,         48.0,         240.0,
      15.0,  75.0,  144.0,        72.0,         12.0,         360.0,        480.0,
      180.0, 300.0, 30.0 / 1.001, 60.0 / 1.001, 24.0 / 1.001, 120.0 / 1.001};
  for (const double rate : rates) {
    const double exact = 1.0 / rate;
    // Rounded or cut off: less than one unit of the last digit above, half a one below.
    const double miss = (exact - time) / unit;
    const bool close = std::abs(exact - time) < 5e-3 * exact;
    if (close && miss > -0.5 - 1e-6 && miss < 1.0)
      return {rate, std::abs(exact - time) > 1e-9 * exact};
  }
  return {fps, false};
}

int canReadBvh(std::string_view head) {
  if (head.starts_with("\xEF\xBB\xBF")) head.remove_prefix(3);
  LineReader lines(head, {});
  const auto line = lines.nextFilled();
  return line && sameIgnoringCase(trim(*line), "HIERARCHY") ? 100 : 0;
}

Clip parseBvh(std::string_view bytes, const std::string& origin, const ReadOptions& options) {
  LineReader lines(bytes, origin);
  Hierarchy hierarchy = HierarchyParser(lines).parse();
  const MotionHeader header = readMotionHeader(lines);
  Clip clip;
  clip.name = std::filesystem::path(origin).stem().string();
  std::vector<std::vector<size_t>> turns;
  for (const auto& channels : hierarchy.channels) {
    const std::vector<int> axes = turnAxes(channels);
    turns.push_back(turnsInOrder(axes, options.eulerOrder));
    clip.source.eulerOrders.push_back(orderText(axes, turns.back()));
  }
  clip.transforms = readRows(lines, hierarchy, turns, header);
  clip.fps = header.rate.fps;
  clip.source.path = origin;
  clip.source.format = "bvh";
  clip.source.fps = 1.0 / parseNumber(header.frameTime).value_or(1.0);
  clip.source.notes = std::move(hierarchy.notes);
  if (!options.eulerOrder.empty())
    clip.source.notes.push_back("Euler order " + options.eulerOrder + " as given");
  if (header.rate.snapped)
    clip.source.notes.push_back(
        fmt::format("frame time {} is read as 1/{:.6g} s", header.frameTime, header.rate.fps));
  clip.skeleton = std::make_shared<const Skeleton>(std::move(hierarchy.skeleton));
  return normalised(std::move(clip), {}, options);
}

std::vector<Clip> readBvh(std::string_view bytes, const std::filesystem::path& path,
                          const ReadOptions& options) {
  return {parseBvh(bytes, path.string(), options)};
}

}  // namespace marey::io
