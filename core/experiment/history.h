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
      : m_entries{{std::move(label), std::move(first)}} {}

  const State& state() const { return m_entries[m_at].state; }
  /// Forgets what was undone. Returns false, without an entry, where nothing changes.
  bool commit(State next, std::string label) {
    if (next == state()) return false;
    m_entries.resize(m_at + 1, m_entries.front());
    m_entries.push_back({std::move(label), std::move(next)});
    if (m_entries.size() > kMostEntries) m_entries.erase(m_entries.begin());
    m_at = m_entries.size() - 1;
    return true;
  }
  /// As commit, but an edit with the label of the last one replaces it: one entry for a drag.
  bool amend(State next, const std::string& label) {
    if (m_at == 0 || m_at + 1 != m_entries.size() || m_entries[m_at].label != label)
      return commit(std::move(next), label);
    if (next == state()) return false;
    m_entries[m_at].state = std::move(next);
    return true;
  }
  bool canUndo() const { return m_at > 0; }
  bool canRedo() const { return m_at + 1 < m_entries.size(); }
  void undo() { m_at -= canUndo() ? 1 : 0; }
  void redo() { m_at += canRedo() ? 1 : 0; }
  /// `index` below size().
  void goTo(size_t index) { m_at = index < m_entries.size() ? index : m_at; }
  size_t index() const { return m_at; }
  size_t size() const { return m_entries.size(); }
  const std::string& label(size_t index) const { return m_entries[index].label; }

 private:
  struct Entry {
    std::string label;
    State state;
  };
  static constexpr size_t kMostEntries = 1000;
  std::vector<Entry> m_entries;
  size_t m_at = 0;
};

}  // namespace marey
