#include "task/commands_file.h"

#include <cmath>
#include <numbers>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/text_table.h"

namespace marey {
namespace {

constexpr double kRadians = std::numbers::pi / 180.0;
constexpr const char* kForms =
    "a table with the columns time and, of forward, sideways (m/s), turn_deg, facing_deg and type, "
    "those that are known";

struct TimedCommand {
  double timeS = 0.0;
  LiveCommand command;
};

class CommandTable {
 public:
  CommandTable(const std::string& text, const std::string& origin) : m_table(text, origin, kForms) {
    for (const std::string& column : m_table.columns())
      if (column != "time" && column != "forward" && column != "sideways" && column != "turn_deg" &&
          column != "facing_deg" && column != "type")
        throw InputError({.path = origin, .line = m_table.firstLine()}, kForms, "'" + column + "'");
    if (!m_table.find("time"))
      throw InputError({.path = origin, .line = m_table.firstLine()}, kForms, "no column 'time'");
  }

  std::vector<TimedCommand> read() const {
    std::vector<TimedCommand> out;
    for (const TextTable::Row& row : m_table.rows()) {
      TimedCommand one{.timeS = value(row, "time"), .command = commandOf(row)};
      if (!out.empty() && one.timeS <= out.back().timeS)
        throwInput(m_table.place(row), fmt::format("a time after {} s", out.back().timeS), "{} s",
                   one.timeS);
      out.push_back(std::move(one));
    }
    if (out.size() < 2)
      throwInput({.path = m_table.origin()}, "at least two rows, to know how long a command holds",
                 "{}", out.size());
    return out;
  }

 private:
  double value(const TextTable::Row& row, const std::string& column) const {
    const auto at = m_table.find(column);
    return at ? m_table.number(row, *at).value_or(0.0) : 0.0;
  }
  LiveCommand commandOf(const TextTable::Row& row) const {
    LiveCommand out{.forwardMS = value(row, "forward"),
                    .sidewaysMS = value(row, "sideways"),
                    .turnRadS = kRadians * value(row, "turn_deg"),
                    .facingRad = kRadians * value(row, "facing_deg")};
    if (const auto type = m_table.find("type")) out.type = row.fields[*type];
    return out;
  }

  TextTable m_table;
};

Steering fromTable(const std::vector<TimedCommand>& commands, double fps) {
  const double begin = commands.front().timeS;
  const double last = commands.back().timeS - commands[commands.size() - 2].timeS;
  const auto frames =
      static_cast<size_t>(std::lround((commands.back().timeS + last - begin) * fps));
  Steering out{.options = {.begin = commands.front().command}, .commands = {}};
  size_t now = 0;
  for (size_t t = 0; t < frames; ++t) {
    const double time = begin + static_cast<double>(t) / fps + 1e-9;
    while (now + 1 < commands.size() && commands[now + 1].timeS <= time) ++now;
    out.commands.push_back(commands[now].command);
  }
  return out;
}

}  // namespace

Steering readCommands(const std::filesystem::path& path, double fps) {
  const std::string text = readFile(path);
  const size_t first = text.find_first_not_of("\xEF\xBB\xBF \t\r\n");
  if (first != std::string::npos && text[first] == '{')
    return steeringFromJson(readJson(path), path.string(), "");
  return fromTable(CommandTable(text, path.string()).read(), fps);
}

}  // namespace marey
