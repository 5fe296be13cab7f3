#include "io/euler_order.h"

#include <algorithm>
#include <array>
#include <cctype>

#include "base/error.h"

namespace marey::io {
namespace {

/// Place of every axis in the order.
std::array<size_t, 3> placesIn(std::string_view order) {
  std::string upper(order);
  for (char& c : upper) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  std::array<size_t, 3> places{};
  for (size_t axis = 0; axis < 3; ++axis) {
    places[axis] = upper.find("XYZ"[axis]);
    if (upper.size() != 3 || places[axis] == std::string::npos)
      throw UsageError(
          fmt::format("Euler order: expected three different axes such as ZXY, found '{}'", order));
  }
  return places;
}

}  // namespace

std::vector<size_t> turnsInOrder(std::span<const int> axes, std::string_view order) {
  std::vector<size_t> turns;
  std::array<int, 3> count{};
  for (size_t i = 0; i < axes.size(); ++i) {
    if (axes[i] < 0) continue;
    turns.push_back(i);
    ++count[static_cast<size_t>(axes[i])];
  }
  if (order.empty()) return turns;
  const std::array<size_t, 3> places = placesIn(order);
  if (*std::max_element(count.begin(), count.end()) > 1) return turns;
  std::sort(turns.begin(), turns.end(), [&](size_t a, size_t b) {
    return places[static_cast<size_t>(axes[a])] < places[static_cast<size_t>(axes[b])];
  });
  return turns;
}

std::string orderText(std::span<const int> axes, std::span<const size_t> turns) {
  std::string out;
  for (const size_t turn : turns) out += "XYZ"[axes[turn]];
  return out;
}

}  // namespace marey::io
