#include "gui/shell/start_time.h"

#include <algorithm>
#include <ctime>
#include <fstream>
#include <sstream>
#include <string>

#include <unistd.h>

namespace marey::gui {

double secondsSinceStart() {
  std::ifstream file("/proc/self/stat");
  std::string text;
  std::getline(file, text);
  // The name, in brackets, may hold blanks; the start is the 20th field after it, in ticks.
  const size_t name = text.rfind(')');
  if (name == std::string::npos) return 0.0;
  std::istringstream fields(text.substr(name + 1));
  std::string skipped;
  for (int field = 0; field < 19; ++field) fields >> skipped;
  double ticks = 0.0;
  timespec now{};
  if (!(fields >> ticks) || clock_gettime(CLOCK_BOOTTIME, &now) != 0) return 0.0;
  const double started = ticks / static_cast<double>(sysconf(_SC_CLK_TCK));
  return std::max(0.0, static_cast<double>(now.tv_sec) + 1e-9 * now.tv_nsec - started);
}

}  // namespace marey::gui
