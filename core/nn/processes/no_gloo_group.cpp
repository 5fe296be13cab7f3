#include "base/error.h"
#include "nn/processes/gloo_group.h"

namespace marey::nn {

std::unique_ptr<ProcessGroup> joinByGloo(ProcessRank rank, const MeetingPoint&) {
  throw UsageError(fmt::format(
      "training in {} processes: this build has no Gloo. On Debian 12 install libgloo-dev and "
      "configure again",
      rank.size));
}

}  // namespace marey::nn
