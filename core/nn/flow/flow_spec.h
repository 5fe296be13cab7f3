// What a flow is made of. No libtorch type appears here: the layers that train (flow.h) and the
// engine that samples and scores (flow_engine.h) are made of the same.
#pragma once

#include <cstdint>
#include <string>

namespace marey::nn {

/// Which network gives shift and scale of a coupling.
struct CouplingNetSpec {
  std::string cell = "lstm";  ///< "lstm", "gru" or "feedforward"
  int64_t hidden = 512;
  int64_t layers = 2;
};

struct FlowSpec {
  int64_t channels = 0;
  int64_t conditioning = 0;
  int64_t steps = 16;
  bool lu = true;
  CouplingNetSpec net;
};

}  // namespace marey::nn
