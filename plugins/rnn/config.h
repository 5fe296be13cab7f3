// Hyper-parameters of the RNN baseline (Henter et al. 2020, Sec. 4.3).
#pragma once

#include <string>

#include "base/json.h"

namespace marey::rnn {

struct Config {
  int poseDim = 63;
  int controlDim = 3;
  int past = 0;       ///< frames of control before the present one that each frame sees
  int lookahead = 0;  ///< frames of control after it
  int hidden = 512;
  int layers = 1;
  std::string cell = "lstm";  ///< lstm, gru
  bool feedback = false;      ///< whether each frame also sees the pose of the one before

  int controlInputs() const { return (past + 1 + lookahead) * controlDim; }
  int inputs() const { return controlInputs() + (feedback ? poseDim : 0); }
  int64_t parameters() const;
};

/// From a configuration or its "model" object. Strict: throws InputError naming the key.
Config configFromJson(const Json& value, const std::string& origin);
Json toJson(const Config& config);

}  // namespace marey::rnn
