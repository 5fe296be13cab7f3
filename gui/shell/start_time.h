// How long the program has been running, to say how long a start took.
#pragma once

namespace marey::gui {

/// Seconds since the process was started, the loading of its libraries included; 0 where the
/// system does not tell.
double secondsSinceStart();

}  // namespace marey::gui
