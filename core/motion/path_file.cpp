// Path files, and what stands in them without effect.
#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/file_kind.h"
#include "motion/path.h"

namespace marey {
namespace {

constexpr double kRadians = std::numbers::pi / 180.0;
constexpr const char* kForms =
    "JSON {\"waypoints\": [{\"x\": 0, \"z\": 0}, ...]} or a table with the columns time,x,z";

/// Degrees that read back as exactly this angle, where there are any (as for every angle that was
/// read from degrees): a path that is saved and opened again gives the same motion.
double degreesOf(double radians) {
  const double nearest = radians / kRadians;
  double low = nearest, high = nearest;
  for (int ulp = 0; ulp < 4; ++ulp) {
    if (kRadians * low == radians) return low;
    if (kRadians * high == radians) return high;
    low = std::nextafter(low, -std::numeric_limits<double>::infinity());
    high = std::nextafter(high, std::numeric_limits<double>::infinity());
  }
  return nearest;
}

/// Rows of a table with line ends of any system, without a byte-order mark.
std::vector<std::string> linesOf(std::string text) {
  if (text.starts_with("\xEF\xBB\xBF")) text.erase(0, 3);
  std::vector<std::string> out(1);
  for (size_t i = 0; i < text.size(); ++i) {
    const bool end = text[i] == '\n' || text[i] == '\r';
    if (text[i] == '\r' && i + 1 < text.size() && text[i + 1] == '\n') ++i;
    if (end)
      out.emplace_back();
    else
      out.back() += text[i];
  }
  return out;
}

std::string trimmed(const std::string& text) {
  const size_t first = text.find_first_not_of(" \t\"");
  if (first == std::string::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\"") - first + 1);
}

std::vector<std::string> fieldsOf(const std::string& line, char separator) {
  std::vector<std::string> out;
  for (size_t begin = 0; begin <= line.size();) {
    const size_t end = std::min(line.find(separator, begin), line.size());
    out.push_back(trimmed(line.substr(begin, end - begin)));
    begin = end + 1;
  }
  return out;
}

/// "Time_s" -> "time".
std::string columnName(std::string name) {
  std::transform(name.begin(), name.end(), name.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  for (const char* unit : {"_s", "_m", " (s)", " (m)", "[s]", "[m]"})
    if (name.ends_with(unit)) name.resize(name.size() - std::string_view(unit).size());
  name = trimmed(name);
  return name == "t" || name == "seconds" ? "time" : name;
}

class TableReader {
 public:
  TableReader(const std::filesystem::path& file, std::string text)
      : m_origin(file.string()), m_lines(linesOf(std::move(text))) {}

  std::vector<WayPoint> read() {
    size_t at = 0;
    while (at < m_lines.size() && isRemark(m_lines[at])) ++at;
    if (at == m_lines.size()) throw InputError({.path = m_origin}, kForms, "an empty file");
    readHeader(at);
    std::vector<WayPoint> out;
    for (++at; at < m_lines.size(); ++at)
      if (!isRemark(m_lines[at])) out.push_back(pointAt(at));
    return out;
  }

 private:
  static bool isRemark(const std::string& line) {
    const std::string text = trimmed(line);
    return text.empty() || text.starts_with('#');
  }

  Place place(size_t line, const std::string& item = {}) const {
    return {.path = m_origin, .line = static_cast<int64_t>(line) + 1, .item = item};
  }

  void readHeader(size_t line) {
    for (const char separator : {',', ';', '\t'})
      if (m_lines[line].find(separator) != std::string::npos) {
        m_separator = separator;
        break;
      }
    const std::vector<std::string> names = fieldsOf(m_lines[line], m_separator);
    m_width = names.size();
    for (size_t i = 0; i < names.size(); ++i) m_columns.try_emplace(columnName(names[i]), i);
    if (m_columns.contains("x") && m_columns.contains("z")) return;
    const bool motion = m_lines[line].starts_with("HIERARCHY");
    throw InputError(place(line), kForms,
                     quotedStart(m_lines[line]) + (motion ? " (a motion file is clip:FILE)" : ""));
  }

  std::optional<double> numberAt(const std::vector<std::string>& fields, const std::string& column,
                                 size_t line) const {
    const auto at = m_columns.find(column);
    if (at == m_columns.end() || fields[at->second].empty()) return std::nullopt;
    const std::string& text = fields[at->second];
    double value = 0.0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value))
      throw InputError(place(line, "column '" + column + "'"), "a finite number",
                       quotedStart(text));
    return value;
  }

  WayPoint pointAt(size_t line) const {
    const std::vector<std::string> fields = fieldsOf(m_lines[line], m_separator);
    if (fields.size() != m_width)
      throwInput(place(line), fmt::format("{} columns", m_width), "{}", fields.size());
    const auto x = numberAt(fields, "x", line), z = numberAt(fields, "z", line);
    if (!x || !z) throw InputError(place(line), "numbers for x and z", quotedStart(m_lines[line]));
    WayPoint out{.x = *x,
                 .z = *z,
                 .timeS = numberAt(fields, "time", line),
                 .speedMS = numberAt(fields, "speed", line),
                 .facing = numberAt(fields, "facing_deg", line)};
    if (out.facing) out.facing = kRadians * *out.facing;
    return out;
  }

  std::string m_origin;
  std::vector<std::string> m_lines;
  char m_separator = ',';
  size_t m_width = 0;
  std::map<std::string, size_t> m_columns;
};

}  // namespace

std::vector<WayPoint> wayPointsFromJson(const Json& value, const std::string& origin,
                                        const std::string& prefix) {
  JsonReader reader(value, origin, prefix);
  const std::string facing = reader.optional<std::string>("facing", "path");
  if (facing != "path" && facing != "fixed")
    throw InputError(reader.place("facing"), "'path' or 'fixed'", "'" + facing + "'");
  const Json& list = reader.raw("waypoints");
  reader.finish();
  if (!list.is_array()) throw InputError(reader.place("waypoints"), "an array", list.type_name());
  std::vector<WayPoint> points;
  for (const Json& item : list) {
    JsonReader one(item, origin, fmt::format("{}waypoints[{}].", prefix, points.size()));
    WayPoint p{.x = one.required<double>("x"),
               .z = one.required<double>("z"),
               .timeS = {},
               .speedMS = {},
               .facing = {}};
    if (one.has("time")) p.timeS = one.required<double>("time");
    if (one.has("speed")) p.speedMS = one.required<double>("speed");
    if (one.has("facing_deg")) p.facing = kRadians * one.required<double>("facing_deg");
    one.finish();
    // A fixed facing is that of the way-point before; at the start it is +Z.
    if (facing == "fixed" && !p.facing) p.facing = points.empty() ? 0.0 : *points.back().facing;
    points.push_back(p);
  }
  return points;
}

Json toJson(const std::vector<WayPoint>& points) {
  Json list = Json::array();
  for (const WayPoint& p : points) {
    Json one = {{"x", p.x}, {"z", p.z}};
    if (p.timeS) one["time"] = *p.timeS;
    if (p.speedMS) one["speed"] = *p.speedMS;
    if (p.facing) one["facing_deg"] = degreesOf(*p.facing);
    list.push_back(one);
  }
  return {{"waypoints", list}};
}

std::vector<WayPoint> readPathFile(const std::filesystem::path& file) {
  std::string text = readFile(file);
  const size_t first = text.find_first_not_of("\xEF\xBB\xBF \t\r\n");
  if (first != std::string::npos && text[first] == '[')
    throw InputError({.path = file.string()}, kForms, "a JSON list");
  if (first != std::string::npos && text[first] == '{')
    return wayPointsFromJson(readJson(file), file.string());
  return TableReader(file, std::move(text)).read();
}

void writePathFile(const std::filesystem::path& file, const std::vector<WayPoint>& points) {
  writeJson(file, toJson(points));
}

std::vector<std::string> pathRemarks(const std::vector<WayPoint>& points) {
  std::vector<std::string> out;
  for (size_t i = 0; i < points.size(); ++i) {
    if (!points[i].speedMS) continue;
    // It holds up to the next way-point that has a speed, where no time says otherwise.
    bool used = false;
    for (size_t k = i + 1; k < points.size() && !used; ++k) {
      used = !points[k].timeS;
      if (points[k].speedMS) break;
    }
    if (!used)
      out.push_back(
          fmt::format("the speed of way-point {} ({:g} m/s) has no effect: no stretch "
                      "without a time of its own follows; a speed is that of leaving",
                      i + 1, *points[i].speedMS));
  }
  return out;
}

}  // namespace marey
