// How motions are called wherever they are shown.
#pragma once

#include <QString>

#include "experiment/motions.h"

namespace marey::gui {

/// Its name, or its number in the group, and what is known of it; `index` is that number.
QString motionLabel(const MotionGroup& group, int index);

}  // namespace marey::gui
