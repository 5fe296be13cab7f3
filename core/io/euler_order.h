// The order in which the turns of a joint are put together, where a reader is told another one than
// its file lists.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace marey::io {

/// Numbers of a joint's turning channels in the order of intrinsic turns. `axes` has the axis of
/// every channel as its file lists them, first turn first; -1 for shifts. `order` is "" (as listed)
/// or three different axes ("ZYX"): values keep their axes, and only their order changes. A joint
/// that turns twice about one axis stays as listed.
/// Throws UsageError for another order.
std::vector<size_t> turnsInOrder(std::span<const int> axes, std::string_view order);

/// "ZXY" of the channels in that order.
std::string orderText(std::span<const int> axes, std::span<const size_t> turns);

}  // namespace marey::io
