// Which processes a launcher started together.
#pragma once

#include <memory>

#include "base/ranks.h"

namespace marey {

/// How many processes mpirun or srun started together, by the environment that it left; 1 where
/// this process was started alone.
int launchedProcesses();

/// Cores for this process: those that it may run on, shared with its neighbours on the machine
/// where the launcher has not dealt them out itself.
int coresOfThisProcess();

/// The ranks of this run; MPI is initialised only where there are several, so that a plain start
/// costs nothing. Call it once, and keep the result until everything has been printed: the other
/// ranks end when it does. Throws UsageError where there are several and this build has no MPI.
std::unique_ptr<Ranks> startRanks();

}  // namespace marey
