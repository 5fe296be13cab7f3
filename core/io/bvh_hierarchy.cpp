#include "io/bvh_hierarchy.h"

#include <cmath>
#include <optional>
#include <unordered_set>

namespace marey::io {
namespace {

class HierarchyParser {
 public:
  explicit HierarchyParser(WordReader& words) : m_words(words) {}

  BvhHierarchy parse() {
    expectFirstWord();
    while (!m_done) {
      const std::string_view word = m_words.next();
      if (word.empty())
        throw InputError(m_words.place(), "MOTION after the hierarchy", "the end of the file");
      handle(word);
    }
    finish();
    return std::move(m_out);
  }

 private:
  static constexpr int kEndSite = -2;  ///< on the stack: an end site in place of a joint

  void expectFirstWord() {
    const int64_t before = m_words.line();
    std::string_view word = m_words.next();
    const std::string_view first = word;
    while (!word.empty() && !sameIgnoringCase(word, "HIERARCHY")) word = m_words.next();
    if (word.empty())
      throw InputError({.path = m_words.origin(), .line = before},
                       "HIERARCHY as the first word of a BVH file", excerpt(first));
    if (word.data() != first.data())
      m_out.notes.push_back(fmt::format("what stands before HIERARCHY (line {}) is not read: {}",
                                        m_words.line(), excerpt(first)));
  }

  void handle(std::string_view word) {
    if (word == "{") return open();
    if (word == "}") return close();
    if (m_pending) throw InputError(m_words.place(), "'{'", excerpt(word));
    if (sameIgnoringCase(word, "ROOT")) return startTree();
    if (sameIgnoringCase(word, "JOINT")) return startJoint();
    if (sameIgnoringCase(word, "End")) return startEndSite();
    if (sameIgnoringCase(word, "OFFSET")) return readOffset();
    if (sameIgnoringCase(word, "CHANNELS")) return readChannels();
    if (sameIgnoringCase(word, "MOTION") && m_stack.empty()) {
      m_done = true;
      return;
    }
    throw InputError(m_words.place(), "JOINT, End Site, OFFSET, CHANNELS, a brace or MOTION",
                     excerpt(word));
  }

  void open() {
    if (!m_pending) throw InputError(m_words.place(), "a joint before '{'", "none");
    m_stack.push_back(*m_pending);
    m_pending.reset();
  }

  void close() {
    if (m_pending || m_stack.empty())
      throw InputError(m_words.place(), "an open joint before '}'", "none");
    m_stack.pop_back();
  }

  BvhTree& tree() { return m_out.trees.back(); }

  void startTree() {
    if (!m_stack.empty()) throw InputError(m_words.place(), "ROOT outside of joints", "it inside");
    m_out.trees.push_back({.skeleton = {}, .channels = {}, .line = m_words.line()});
    m_names.clear();
    addJoint(-1);
  }

  void startJoint() {
    if (m_stack.empty() || m_stack.back() == kEndSite)
      throw InputError(m_words.place(), "JOINT inside another joint", "it elsewhere");
    addJoint(m_stack.back());
  }

  void addJoint(int parent) {
    const std::string_view name = m_words.nameBeforeBrace();
    if (name.empty()) throw InputError(m_words.place(), "the name of a joint", "none");
    Skeleton& s = tree().skeleton;
    s.names.push_back(uniqueName(std::string(name)));
    s.parents.push_back(parent);
    s.offsets.push_back(Eigen::Vector3f::Zero());
    tree().channels.emplace_back();
    m_pending = s.jointCount() - 1;
  }

  std::string uniqueName(const std::string& name) {
    std::string out = name;
    for (int n = 2; !m_names.insert(out).second; ++n) out = fmt::format("{}_{}", name, n);
    if (out != name)
      m_out.notes.push_back(
          fmt::format("line {}: a second joint '{}' is called '{}'", m_words.line(), name, out));
    return out;
  }

  void startEndSite() {
    const std::string_view word = m_words.next();
    if (!sameIgnoringCase(word, "Site"))
      throw InputError(m_words.place(), "End Site", "End " + std::string(word));
    if (m_stack.empty() || m_stack.back() == kEndSite)
      throw InputError(m_words.place(), "End Site inside a joint", "it elsewhere");
    tree().skeleton.endSites.push_back({.parent = m_stack.back()});
    m_pending = kEndSite;
    m_words.nameBeforeBrace();  // some writers name the site
  }

  void readOffset() {
    if (m_stack.empty()) throw InputError(m_words.place(), "OFFSET inside a joint", "it elsewhere");
    Eigen::Vector3f offset;
    for (int i = 0; i < 3; ++i) {
      const std::string_view word = m_words.next();
      const std::optional<double> value = parseNumber(word);
      if (!value) throw InputError(m_words.place("OFFSET"), "three finite numbers", excerpt(word));
      offset[i] = static_cast<float>(*value);
    }
    Skeleton& s = tree().skeleton;
    if (m_stack.back() == kEndSite)
      s.endSites.back().offset = offset;
    else
      s.offsets[static_cast<size_t>(m_stack.back())] = offset;
  }

  void readChannels() {
    const std::string_view countWord = m_words.next();
    const std::optional<double> count = parseNumber(countWord);
    if (!count || *count < 0.0 || *count > static_cast<double>(kMostBvhChannels) ||
        *count != std::floor(*count))
      throw InputError(m_words.place("CHANNELS"), "a number of channels from 0 to 9",
                       excerpt(countWord));
    if (*count == 0.0) return;  // also on end sites
    if (m_stack.empty() || m_stack.back() == kEndSite)
      throw InputError(m_words.place(), "CHANNELS inside a joint", "it elsewhere");
    auto& channels = tree().channels[static_cast<size_t>(m_stack.back())];
    if (!channels.empty()) throw InputError(m_words.place(), "CHANNELS once per joint", "it twice");
    for (int i = 0; i < static_cast<int>(*count); ++i) channels.push_back(takeChannel());
  }

  BvhChannel takeChannel() {
    const std::string_view word = m_words.next();
    for (int axis = 0; axis < 3; ++axis) {
      const char letter = "XYZ"[axis];
      if (sameIgnoringCase(word, std::string{letter} + "position")) return {axis, false};
      if (sameIgnoringCase(word, std::string{letter} + "rotation")) return {axis, true};
    }
    throw InputError(m_words.place("CHANNELS"),
                     "as many of Xposition, ..., Zposition, Xrotation, ..., Zrotation as their "
                     "number says",
                     word.empty() ? "the end of the file" : excerpt(word));
  }

  void finish() const {
    if (m_out.trees.empty())
      throw InputError(m_words.place(), "a ROOT joint before MOTION", "none");
    if (m_out.channelCount() == 0)
      throw InputError(m_words.place(), "a joint with channels", "none in the whole hierarchy");
  }

  WordReader& m_words;
  BvhHierarchy m_out;
  std::vector<int> m_stack;
  std::optional<int> m_pending;             ///< a joint or end site that waits for its '{'
  std::unordered_set<std::string> m_names;  ///< of the tree that is read
  bool m_done = false;
};

}  // namespace

size_t BvhTree::channelCount() const {
  size_t out = 0;
  for (const auto& c : channels) out += c.size();
  return out;
}

size_t BvhHierarchy::channelCount() const {
  size_t out = 0;
  for (const BvhTree& tree : trees) out += tree.channelCount();
  return out;
}

size_t BvhHierarchy::jointCount() const {
  size_t out = 0;
  for (const BvhTree& tree : trees) out += tree.skeleton.names.size();
  return out;
}

BvhHierarchy readBvhHierarchy(WordReader& words) {
  return HierarchyParser(words).parse();
}

}  // namespace marey::io
