#include "cli/near_miss.h"

#include <algorithm>
#include <numeric>
#include <string_view>

#include <fmt/format.h>

#include "base/error.h"

namespace marey::cli {
namespace {

/// Letters to insert, remove, replace or swap with their neighbour until `a` is `b` (Damerau and
/// Levenshtein, each letter moved once).
size_t distance(std::string_view a, std::string_view b) {
  std::vector<std::vector<size_t>> rows(a.size() + 1, std::vector<size_t>(b.size() + 1));
  std::iota(rows[0].begin(), rows[0].end(), size_t{0});
  for (size_t i = 1; i <= a.size(); ++i) {
    rows[i][0] = i;
    for (size_t j = 1; j <= b.size(); ++j) {
      rows[i][j] = std::min({rows[i - 1][j] + 1, rows[i][j - 1] + 1,
                             rows[i - 1][j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1)});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        rows[i][j] = std::min(rows[i][j], rows[i - 2][j - 2] + 1);
    }
  }
  return rows[a.size()][b.size()];
}

std::string nearest(std::string_view word, const std::vector<std::string>& names) {
  return *std::min_element(names.begin(), names.end(), [&](const auto& a, const auto& b) {
    return distance(word, a) < distance(word, b);
  });
}

std::vector<std::string> commandsOf(const CLI::App& app) {
  std::vector<std::string> out;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
    out.push_back(command->get_name());
  return out;
}

}  // namespace

void requireKnownCommand(const CLI::App& app, const std::vector<std::string>& words) {
  const CLI::App* at = &app;
  for (const std::string& word : words) {
    const auto names = commandsOf(*at);
    if (names.empty()) return;
    if (word.starts_with('-')) continue;  // where commands follow there are flags alone
    if (std::find(names.begin(), names.end(), word) == names.end()) {
      const std::string parent = at == &app ? "" : at->get_name() + " ";
      throw UsageError(fmt::format("unknown command '{0}{1}'; did you mean '{0}{2}'?", parent, word,
                                   nearest(word, names)));
    }
    at = at->get_subcommand(word);
  }
}

std::string nearestOptions(const CLI::App& app) {
  const CLI::App* command = &app;
  while (!command->get_subcommands().empty()) command = command->get_subcommands().front();
  std::vector<std::string> known;
  for (const CLI::Option* option : command->get_options())
    for (const std::string& name : option->get_lnames()) known.push_back("--" + name);
  std::string out;
  for (std::string word : app.remaining(true)) {
    if (!word.starts_with("--") || known.empty()) continue;
    word = word.substr(0, word.find('='));
    out += fmt::format("{}unknown option '{}'; did you mean '{}'?", out.empty() ? "" : "\n", word,
                       nearest(word, known));
  }
  return out;
}

}  // namespace marey::cli
