// The state dicts of a checkpoint: sets of weights with the names of one network, wherever they lie
// and whatever wrappers put before the names. A file may hold several (a model and the average of
// its weights, the two networks of a GAN): then the caller must say which, for no order of names or
// of the file decides it.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "pickle/torch_checkpoint.h"

namespace marey {

/// Where the network's own name of a weight begins within a key ("module.flow.0.bias" -> 7), or
/// npos for a key that is none of its own.
using OwnNameStart = std::function<size_t(std::string_view key)>;

struct StateDict {
  /// Where it lies: the dictionaries that lead to it, then the prefix of its keys, joined by '/':
  /// "graph", "state_dict/model", "." for a file that is the state dict.
  std::string name;
  std::map<std::string, Tensor> tensors;  ///< by the network's own names
  /// What else the file holds, for people: "optim (24 tensors)", "discriminator/a".
  std::vector<std::string> leftOut;
};

/// The only state dict, or the one that `wanted` names ("" for none). The state of optimisers is
/// none. Prefixes of wrappers (module., _orig_mod., model., net. and their like, in any order) are
/// no part of a name; of other prefixes only one that `wanted` names is taken. Throws InputError
/// naming the state dicts there are, or one key that was found and `example`, one that is expected.
StateDict chooseStateDict(TorchCheckpoint checkpoint, const OwnNameStart& ownName,
                          const std::string& example, const std::string& wanted,
                          const std::string& origin);

/// For readTorchCheckpoint: only tensors with names of the network are copied out.
TorchTensorFilter stateDictFilter(const OwnNameStart& ownName);

}  // namespace marey
