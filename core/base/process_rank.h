// Which of several processes of one job this is.
#pragma once

namespace marey {

struct ProcessRank {
  int rank = 0;
  int size = 1;
};

/// What the launcher set in the environment: OMPI_COMM_WORLD_RANK and _SIZE (Open MPI), PMI_RANK
/// and PMI_SIZE (MPICH, Slurm), RANK and WORLD_SIZE (torchrun); the first pair that is there.
/// Without any, one process alone. Throws InputError naming the variable for a half of a pair or
/// anything but 0 <= rank < size.
ProcessRank processRank();

}  // namespace marey
