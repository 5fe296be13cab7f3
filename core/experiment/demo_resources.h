// The demonstration's model and document, inside the program.
#pragma once

#include <string_view>

namespace marey {

std::string_view demoModel();
std::string_view demoExperiment();

}  // namespace marey
