#include <algorithm>
#include <cmath>

#include "io/bvh.h"
#include "io/bvh_rows.h"
#include "io/euler_order.h"
#include "io/normalise.h"
#include "io/plain_text.h"
#include "io/text.h"

namespace marey::io {
namespace {

std::vector<int> turnAxes(const std::vector<BvhChannel>& channels) {
  std::vector<int> out;
  for (const BvhChannel& channel : channels) out.push_back(channel.rotation ? channel.axis : -1);
  return out;
}

/// Something that a person carries, or a marker of the stage: a quarter of the joints at most.
bool isProp(const BvhTree& tree, size_t mostJoints) {
  return 4 * tree.skeleton.names.size() <= mostJoints;
}

/// One HIERARCHY with its MOTION; `words` is left after its last row.
class BodyReader {
 public:
  BodyReader(WordReader& words, const ReadOptions& options) : m_words(words), m_options(options) {}

  std::vector<Clip> read() {
    m_hierarchy = readBvhHierarchy(m_words);
    std::vector<std::vector<size_t>> turns;
    for (const BvhTree& tree : m_hierarchy.trees)
      for (const auto& channels : tree.channels)
        turns.push_back(turnsInOrder(turnAxes(channels), m_options.eulerOrder));
    m_motion = readBvhMotion(m_words, m_hierarchy, turns, m_options.wholeRows);
    if (m_words.comments() > 0)
      m_notes.push_back(fmt::format("{} remarks are not read", m_words.comments()));
    m_words = WordReader(m_motion.rest, m_words.origin(), m_motion.restBefore);
    takeRate();
    size_t most = 0;
    for (const BvhTree& tree : m_hierarchy.trees) most = std::max(most, tree.skeleton.names.size());
    for (const BvhTree& tree : m_hierarchy.trees)
      if (isProp(tree, most))
        m_notes.push_back(fmt::format("ROOT '{}' (line {}, {} joints of {}) is left out: no body",
                                      tree.skeleton.names[0], tree.line, tree.skeleton.names.size(),
                                      most));
    std::vector<Clip> out;
    size_t joint = 0;
    for (size_t k = 0; k < m_hierarchy.trees.size(); ++k) {
      const size_t count = m_hierarchy.trees[k].skeleton.names.size();
      if (!isProp(m_hierarchy.trees[k], most))
        out.push_back(clipOf(k, {turns.begin() + static_cast<long>(joint),
                                 turns.begin() + static_cast<long>(joint + count)}));
      joint += count;
    }
    return out;
  }

 private:
  void takeRate() {
    m_notes.insert(m_notes.end(), m_hierarchy.notes.begin(), m_hierarchy.notes.end());
    m_notes.insert(m_notes.end(), m_motion.notes.begin(), m_motion.notes.end());
    if (!m_options.eulerOrder.empty())
      m_notes.push_back("Euler order " + m_options.eulerOrder + " as given");
    if (m_motion.frameTime.empty()) {
      if (!m_options.fps)
        throw InputError(m_words.place(), "'Frame Time:' with a number (or --source-fps)", "none");
      m_rate.fps = *m_options.fps;
      m_notes.push_back("the file states no frame time");
      return;
    }
    m_rate = rateOfFrameTime(m_motion.frameTime);
    if (m_rate.snapped)
      m_notes.push_back(
          fmt::format("frame time {} is read as 1/{:.6g} s", m_motion.frameTime, m_rate.fps));
  }

  Clip clipOf(size_t index, const std::vector<std::vector<size_t>>& turns) {
    BvhTree& tree = m_hierarchy.trees[index];
    const std::string& root = tree.skeleton.names[0];
    Clip clip;
    clip.name = std::filesystem::path(m_words.origin()).stem().string();
    for (size_t j = 0; j < turns.size(); ++j)
      clip.source.eulerOrders.push_back(orderText(turnAxes(tree.channels[j]), turns[j]));
    clip.transforms = std::move(m_motion.trees[index]);
    clip.fps = m_rate.fps;
    clip.source.path = m_words.origin();
    clip.source.format = "bvh";
    clip.source.fps = m_motion.frameTime.empty()
                          ? m_rate.fps
                          : 1.0 / parseNumber(m_motion.frameTime).value_or(1.0);
    clip.source.notes = m_notes;
    if (m_hierarchy.trees.size() > 1)
      clip.source.notes.push_back(fmt::format("ROOT {} of {} in the file: '{}'", index + 1,
                                              m_hierarchy.trees.size(), root));
    clip.skeleton = std::make_shared<const Skeleton>(tree.skeleton);
    return clip;
  }

  WordReader& m_words;
  const ReadOptions& m_options;
  BvhHierarchy m_hierarchy;
  BvhMotion m_motion;
  SnappedRate m_rate;
  std::vector<std::string> m_notes;
};

/// Names of several clips of one file: the file's and the root's; repeated ones are numbered.
void nameClips(std::vector<Clip>& clips) {
  if (clips.size() < 2) return;
  std::vector<std::string> taken;
  for (Clip& clip : clips) {
    const std::string wanted = clip.name + "_" + clip.skeleton->names[0];
    clip.name = wanted;
    for (int n = 2; std::find(taken.begin(), taken.end(), clip.name) != taken.end(); ++n)
      clip.name = fmt::format("{}_{}", wanted, n);
    taken.push_back(clip.name);
  }
}

/// Another motion after the first: BVH files that were put together.
bool anotherBegins(WordReader words) {
  const std::string_view next = words.next();
  if (sameIgnoringCase(next, "MOTION"))
    throw InputError(words.place(), "one MOTION per HIERARCHY", "a second one: split the file");
  return sameIgnoringCase(next, "HIERARCHY");
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
  const PlainText plain(head);
  WordReader words(plain.text(), {});
  if (sameIgnoringCase(words.next(), "HIERARCHY")) return 100;
  // A remark of another kind may stand before it.
  LineReader lines(plain.text(), {});
  while (const auto line = lines.nextFilled()) {
    if (!sameIgnoringCase(trim(*line), "HIERARCHY")) continue;
    WordReader after(lines.rest(), {});
    return sameIgnoringCase(after.next(), "ROOT") ? 60 : 0;
  }
  return 0;
}

std::vector<Clip> parseBvhClips(std::string_view bytes, const std::string& origin,
                                const ReadOptions& options) {
  const PlainText plain(bytes);
  WordReader words(plain.text(), origin);
  std::vector<Clip> out;
  do {
    for (Clip& clip : BodyReader(words, options).read()) out.push_back(std::move(clip));
  } while (anotherBegins(words));
  std::vector<std::string> notes = plain.notes();
  if (const std::string_view rest = words.next(); !rest.empty())
    notes.push_back(fmt::format("text after the last row (line {}) is not read: {}", words.line(),
                                excerpt(rest)));
  nameClips(out);
  for (Clip& clip : out) {
    clip.source.notes.insert(clip.source.notes.begin(), notes.begin(), notes.end());
    clip = normalised(std::move(clip), {}, options);
  }
  return out;
}

Clip parseBvh(std::string_view bytes, const std::string& origin, const ReadOptions& options) {
  std::vector<Clip> clips = parseBvhClips(bytes, origin, options);
  if (clips.size() != 1) throwInput({.path = origin}, "one clip", "{} clips", clips.size());
  return std::move(clips.front());
}

std::vector<Clip> readBvh(std::string_view bytes, const std::filesystem::path& path,
                          const ReadOptions& options) {
  return parseBvhClips(bytes, path.string(), options);
}

}  // namespace marey::io
