#include "ranks/launch.h"

#include <algorithm>
#include <cstdlib>
#include <thread>

#include <sched.h>

#include "base/error.h"
#include "base/process_rank.h"
#ifdef MAREY_MPI
#include "ranks/mpi_ranks.h"
#endif

namespace marey {

int launchedProcesses() {
  const int size = processRank().size;
  // srun with PMIx tells the number only as that of the job step. Slurm sets it in a batch script
  // too, where no process manager stands behind it.
  const char* const step = std::getenv("SLURM_STEP_NUM_TASKS");
  if (size == 1 && step != nullptr && std::getenv("PMIX_RANK") != nullptr)
    return std::max(1, std::atoi(step));
  return size;
}

int coresOfThisProcess() {
  const int machine = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  cpu_set_t allowed;
  const int own =
      sched_getaffinity(0, sizeof allowed, &allowed) == 0 ? CPU_COUNT(&allowed) : machine;
  int neighbours = 1;
  for (const char* variable : {"OMPI_COMM_WORLD_LOCAL_SIZE", "MPI_LOCALNRANKS"})
    if (const char* const text = std::getenv(variable)) neighbours = std::max(1, std::atoi(text));
  return std::clamp(machine / neighbours, 1, std::max(1, own));
}

std::unique_ptr<Ranks> startRanks() {
  const int processes = launchedProcesses();
  if (processes == 1) return std::make_unique<Ranks>();
#ifdef MAREY_MPI
  return std::make_unique<MpiRanks>(processes);
#else
  throw UsageError(fmt::format(
      "{} processes were started together, but this marey was built without MPI: run it alone, or "
      "configure it with -DMAREY_MPI=ON",
      processes));
#endif
}

}  // namespace marey
