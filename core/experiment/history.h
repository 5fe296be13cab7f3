// Undo and redo by snapshots: every state of a document is kept whole, with the name of the edit
// that led to it.
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace marey {

/// States are values; `State` has ==, so that an edit that changes nothing leaves no trace.
template <typename State>
class History {
 public:
  explicit History(State first, std::string label = "Start")
      : m_entries{{std::move(label), std::move(first), {}}} {}

  const State& state() const { return m_entries[m_at].state; }
  /// Forgets what was undone. Returns false, without an entry, where nothing changes. `place` names
  /// what the edit changes, for amend.
  bool commit(State next, std::string label, std::string place = {}) {
    if (next == state()) return false;
    m_entries.resize(m_at + 1, m_entries.front());
    m_entries.push_back({std::move(label), std::move(next), std::move(place)});
    if (m_entries.size() > kMostEntries) m_entries.erase(m_entries.begin());
    m_at = m_entries.size() - 1;
    m_sealed = false;
    return true;
  }
  /// As commit, but an edit with the label of the last one, at its place or inside it, goes into
  /// that entry: one entry for a drag. Nothing goes into an entry before seal() or an undo.
  bool amend(State next, const std::string& label, const std::string& place) {
    const Entry& last = m_entries[m_at];
    if (m_at == 0 || m_at + 1 != m_entries.size() || m_sealed || last.label != label ||
        !isInside(place, last.place))
      return commit(std::move(next), label, place);
    if (next == state()) return false;
    m_entries[m_at].state = std::move(next);
    return true;
  }
  /// Edits that follow get entries of their own.
  void seal() { m_sealed = true; }
  bool canUndo() const { return m_at > 0; }
  bool canRedo() const { return m_at + 1 < m_entries.size(); }
  void undo() { goTo(m_at - (canUndo() ? 1 : 0)); }
  void redo() { goTo(m_at + 1); }
  /// Nothing happens where `index` is not below size().
  void goTo(size_t index) {
    m_at = index < m_entries.size() ? index : m_at;
    m_sealed = true;
  }
  size_t index() const { return m_at; }
  size_t size() const { return m_entries.size(); }
  const std::string& label(size_t index) const { return m_entries[index].label; }

 private:
  struct Entry {
    std::string label;
    State state;
    std::string place;
  };
  static bool isInside(const std::string& place, const std::string& whole) {
    return place == whole || (place.starts_with(whole) && place[whole.size()] == '/');
  }
  static constexpr size_t kMostEntries = 1000;
  std::vector<Entry> m_entries;
  size_t m_at = 0;
  bool m_sealed = false;
};

}  // namespace marey
