// Files that are kept say in which version of their format they were written, so that a program
// does not misread what a newer one wrote.
#pragma once

#include "base/json.h"

namespace marey {

/// The key "version" of an object; 1 where it has none, as files had before there was a second.
/// Throws InputError naming the place, the newest version that is known and the one that was found.
int readFormatVersion(JsonReader& reader, int newest);

}  // namespace marey
