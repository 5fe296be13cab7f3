// Reads PyTorch checkpoints (torch.save: the zip container of PyTorch 1.6 and later, and the
// legacy stream before it) without libtorch and without running anything: the pickle inside is
// interpreted by a small stack machine that knows containers, numbers, text and the few names
// below, and refuses every other name.
//
// Names that make something: collections.OrderedDict and other dictionaries, torch.Size,
// torch._utils._rebuild_tensor, _rebuild_tensor_v2 and _rebuild_parameter, the storages of PyTorch
// (bfloat16 is widened to float32), and numpy scalars. Values of the usual classes of training
// state (paths, dates, devices, NumPy arrays, schedulers, settings; pickle_names.cpp) are kept as
// the name of their class. Safetensors files are read too.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "base/json.h"
#include "base/tensor_file.h"

namespace marey {

/// A checkpoint flattened: nested dictionaries, lists and tuples become paths joined by '/',
/// {'graph': {'flow.layers.0.actnorm.bias': t}} the tensor 'graph/flow.layers.0.actnorm.bias'.
/// Integer keys and list positions appear as decimal numbers.
struct TorchCheckpoint {
  /// Row-major copies, whatever the stored strides. Bool tensors become U8.
  std::map<std::string, Tensor> tensors;
  /// One flat object, path -> value, of everything that is no tensor: numbers, text, true,
  /// false, null, and lists of those as arrays ('optim/param_groups/0/betas': [0.9, 0.999]).
  /// Raw bytes are left out.
  Json scalars = Json::object();
  /// path -> class of the values that are none of these ('args': "argparse.Namespace").
  std::map<std::string, std::string> opaque;
  bool isSafetensors = false;
  std::vector<std::string> skipped;  ///< paths of the tensors that the filter left out
};

/// Which tensors to copy out, by path; an empty function means all of them. The rest (say, the
/// optimiser's moments) is checked to be readable but costs no memory.
using TorchTensorFilter = std::function<bool(const std::string& path)>;

/// Throws FileError, or InputError for anything but a checkpoint of the kinds above: a refused
/// name (it is in the message), a cut or damaged file, sizes that do not add up, a tensor that
/// reaches beyond its storage, nesting deeper than 64, and small files that would unfold to a
/// size out of proportion.
TorchCheckpoint readTorchCheckpoint(const std::filesystem::path& path,
                                    const TorchTensorFilter& filter = {});
/// `origin` names the content in errors.
TorchCheckpoint parseTorchCheckpoint(std::string_view bytes, const std::string& origin,
                                     const TorchTensorFilter& filter = {});

}  // namespace marey
