// The RNN baseline as a family: one recurrent layer from control to poses, trained on squared error
// (Henter et al. 2020, Sec. 4.3). It draws nothing: equal control always gives the same motion.
#pragma once

#include "model/model_family.h"

namespace marey::rnn {

ModelFamily family();

}  // namespace marey::rnn
