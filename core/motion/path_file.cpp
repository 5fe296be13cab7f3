// Path files, and what stands in them without effect.
#include <cmath>
#include <limits>
#include <numbers>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/file_kind.h"
#include "base/text_table.h"
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

/// Where its columns stand.
struct PathColumns {
  size_t x, z;
  std::optional<size_t> time, speed, facing, type;
};

PathColumns columnsOf(const TextTable& table, const std::string& text) {
  const auto x = table.find("x"), z = table.find("z");
  if (x && z)
    return {*x,
            *z,
            table.find("time"),
            table.find("speed"),
            table.find("facing_deg"),
            table.find("type")};
  const bool motion = text.starts_with("HIERARCHY");
  throw InputError({.path = table.origin(), .line = table.firstLine()}, kForms,
                   quotedStart(text) + (motion ? " (a motion file is clip:FILE)" : ""));
}

WayPoint pointOf(const TextTable& table, const TextTable::Row& row, const PathColumns& columns) {
  const auto numberAt = [&](const std::optional<size_t>& column) {
    return column ? table.number(row, *column) : std::nullopt;
  };
  const auto x = numberAt(columns.x), z = numberAt(columns.z);
  if (!x || !z) throw InputError(table.place(row), "numbers for x and z", "an empty field");
  WayPoint out{.x = *x,
               .z = *z,
               .timeS = numberAt(columns.time),
               .speedMS = numberAt(columns.speed),
               .facing = numberAt(columns.facing)};
  if (out.facing) out.facing = kRadians * *out.facing;
  if (columns.type) out.type = row.fields[*columns.type];
  return out;
}

std::vector<WayPoint> readTable(const std::string& text, const std::string& origin) {
  const TextTable table(text, origin, kForms);
  const PathColumns columns = columnsOf(table, text);
  std::vector<WayPoint> out;
  for (const TextTable::Row& row : table.rows()) out.push_back(pointOf(table, row, columns));
  return out;
}

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
    p.type = one.optional<std::string>("type", "");
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
    if (!p.type.empty()) one["type"] = p.type;
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
  return readTable(text, file.string());
}

void writePathFile(const std::filesystem::path& file, const std::vector<WayPoint>& points) {
  writeJson(file, toJson(points));
}

std::vector<std::string> pathRemarks(const std::vector<WayPoint>& points) {
  std::vector<std::string> out;
  if (!points.empty() && !points.back().type.empty() &&
      (points.size() < 2 || points[points.size() - 2].type != points.back().type))
    out.push_back(
        fmt::format("the type of the last way-point ('{}') has no effect: no stretch "
                    "follows; a type is that of leaving",
                    points.back().type));
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
