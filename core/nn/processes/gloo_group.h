// Internal to the process group: the implementation that CMake found to be possible.
#pragma once

#include "nn/processes/process_group.h"

namespace marey::nn {

std::unique_ptr<ProcessGroup> joinByGloo(ProcessRank rank, const MeetingPoint& point);

}  // namespace marey::nn
