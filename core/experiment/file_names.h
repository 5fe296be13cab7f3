// Names of files that are made from names of people.
#pragma once

#include <string>

namespace marey {

/// ASCII letters, digits, '-' and '_'; runs of anything else become one '_'. Never empty.
std::string safeName(const std::string& text);

}  // namespace marey
