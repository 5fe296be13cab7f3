// A program without a display says so in one line; Qt alone writes a page about reinstalling and
// aborts.
#pragma once

namespace marey::gui {

/// While it lives (around the making of the application), a failure of Qt to reach a window system
/// ends the program with a line on stderr and exit status 1. Other messages of that time come after
/// it, as usual.
class NoDisplayGuard {
 public:
  NoDisplayGuard();
  ~NoDisplayGuard();
  NoDisplayGuard(const NoDisplayGuard&) = delete;
  NoDisplayGuard& operator=(const NoDisplayGuard&) = delete;
};

}  // namespace marey::gui
