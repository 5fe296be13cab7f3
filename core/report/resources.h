// Files of resources/report, built into the program.
#pragma once

#include <string>

namespace marey::report {

extern const std::string templateText;  ///< report.mustache
extern const std::string styleText;     ///< report.css

}  // namespace marey::report
