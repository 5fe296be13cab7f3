// Memory of this process.
#pragma once

namespace marey {

/// Most memory that the process has held at once, in units of 10^6 bytes; 0 where the system does
/// not say.
double peakMemoryMb();

}  // namespace marey
