// Signs of a player, drawn in an ink: a style's own ones are black on a dark window too.
#pragma once

#include <QColor>
#include <QIcon>

namespace marey::gui {

enum class Transport { Start, Back, Play, Pause, Forward, End };

QIcon transportIcon(Transport sign, const QColor& ink);

}  // namespace marey::gui
