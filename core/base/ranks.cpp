#include "base/ranks.h"

#include <algorithm>

namespace marey {

std::pair<size_t, size_t> shareOf(size_t items, int rank, int size) {
  const auto begin = [&](int r) {
    const auto part = static_cast<size_t>(r), parts = static_cast<size_t>(size);
    return items / parts * part + std::min(part, items % parts);
  };
  return {begin(rank), begin(rank + 1)};
}

std::vector<std::string> Ranks::gather(size_t items, const Share& work, Progress& progress) {
  return work(0, items, progress);
}

std::string Ranks::fromFirst(const std::function<std::string()>& make) {
  return make();
}

void Ranks::whenStopped(const std::function<void()>&) {}

void Ranks::together(const std::function<void()>& body) {
  body();
}

}  // namespace marey
