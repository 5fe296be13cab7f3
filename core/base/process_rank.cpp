#include "base/process_rank.h"

#include <charconv>
#include <cstdlib>
#include <string_view>

#include "base/error.h"

namespace marey {
namespace {

int numberIn(const char* name, int lowest) {
  const char* value = std::getenv(name);
  if (value == nullptr) throw InputError({.path = name}, "a number in the environment", "nothing");
  const std::string_view text = value;
  int number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size() || number < lowest)
    throwInput({.path = name}, fmt::format("a whole number from {} up", lowest), "'{}'", text);
  return number;
}

}  // namespace

ProcessRank processRank() {
  constexpr const char* kPairs[][2] = {{"OMPI_COMM_WORLD_RANK", "OMPI_COMM_WORLD_SIZE"},
                                       {"PMI_RANK", "PMI_SIZE"},
                                       {"RANK", "WORLD_SIZE"}};
  for (const auto& [rank, size] : kPairs) {
    if (std::getenv(rank) == nullptr && std::getenv(size) == nullptr) continue;
    const ProcessRank out{numberIn(rank, 0), numberIn(size, 1)};
    if (out.rank >= out.size)
      throwInput({.path = rank}, fmt::format("below {} ({})", out.size, size), "{}", out.rank);
    return out;
  }
  return {};
}

}  // namespace marey
