#include "pickle/names.h"

#include <algorithm>
#include <array>

namespace marey::pickle {
namespace {

constexpr std::array kDictionaries = std::to_array<std::string_view>(
    {"collections.defaultdict", "collections.Counter", "easydict.EasyDict", "munch.Munch",
     "addict.addict.Dict", "pytorch_lightning.utilities.parsing.AttributeDict",
     "lightning.pytorch.utilities.parsing.AttributeDict",
     "lightning_fabric.utilities.data.AttributeDict",
     "lightning.fabric.utilities.data.AttributeDict"});

constexpr std::array kOpaque = std::to_array<std::string_view>(
    {// Python
     "argparse.Namespace", "types.SimpleNamespace", "pathlib.Path", "pathlib.PurePath",
     "pathlib.PosixPath", "pathlib.PurePosixPath", "pathlib.WindowsPath", "pathlib.PureWindowsPath",
     "pathlib._local.PosixPath", "pathlib._local.WindowsPath", "datetime.datetime", "datetime.date",
     "datetime.time", "datetime.timedelta", "datetime.timezone", "decimal.Decimal",
     "fractions.Fraction", "uuid.UUID", "collections.deque", "copyreg._reconstructor",
     "copy_reg._reconstructor",
     // NumPy
     "numpy.ndarray", "numpy.core.multiarray._reconstruct", "numpy._core.multiarray._reconstruct",
     "numpy.core.numeric._frombuffer", "numpy._core.numeric._frombuffer", "numpy.bool_",
     "numpy.bool", "numpy.int8", "numpy.int16", "numpy.int32", "numpy.int64", "numpy.uint8",
     "numpy.uint16", "numpy.uint32", "numpy.uint64", "numpy.float16", "numpy.float32",
     "numpy.float64",
     // PyTorch
     "torch.device", "torch.float16", "torch.float32", "torch.float64", "torch.bfloat16",
     "torch.half", "torch.float", "torch.double", "torch.uint8", "torch.int8", "torch.int16",
     "torch.int32", "torch.int64", "torch.short", "torch.int", "torch.long", "torch.bool",
     "torch.complex64", "torch.complex128", "torch.strided", "torch.contiguous_format",
     "torch.channels_last", "torch.preserve_format", "torch.serialization._get_layout",
     "torch.torch_version.TorchVersion", "torch.cuda.amp.grad_scaler.GradScaler",
     "torch.amp.grad_scaler.GradScaler"});

/// Modules of settings and of training state.
constexpr std::array kOpaqueModules = std::to_array<std::string_view>(
    {"numpy.random.", "torch.optim.", "pytorch_lightning.", "lightning.", "lightning_fabric.",
     "omegaconf.", "yacs.config.", "ml_collections.", "typing."});

/// Types of Python itself, and how some of its versions store a member of an enumeration: the
/// class, which is judged by its own name, and the member's. Other functions are not among them.
constexpr std::array kBuiltinTypes = std::to_array<std::string_view>(
    {"set", "frozenset", "complex", "slice", "range", "xrange", "bytearray", "object", "int",
     "long", "float", "str", "unicode", "bool", "list", "tuple", "dict", "bytes", "getattr"});

/// Modules whose functions reach beyond the process.
constexpr std::array kSystemModules = std::to_array<std::string_view>(
    {"os.",        "posix.",      "nt.",          "subprocess.", "sys.",       "shutil.",
     "socket.",    "builtins.",   "__builtin__.", "runpy.",      "importlib.", "pty.",
     "commands.",  "webbrowser.", "code.",        "ctypes.",     "pickle.",    "_pickle.",
     "marshal.",   "operator.",   "_operator.",   "functools.",  "asyncio.",   "multiprocessing.",
     "threading.", "urllib.",     "requests.",    "tempfile.",   "platform."});

template <typename List>
bool has(const List& list, std::string_view name) {
  return std::find(list.begin(), list.end(), name) != list.end();
}

template <typename List>
bool beginsWithOne(std::string_view name, const List& list) {
  return std::any_of(list.begin(), list.end(),
                     [&](std::string_view prefix) { return name.starts_with(prefix); });
}

}  // namespace

bool isDictionaryName(std::string_view qualifiedName) {
  return has(kDictionaries, qualifiedName);
}

bool isOpaqueName(std::string_view qualifiedName) {
  for (const std::string_view module : {"builtins.", "__builtin__."})
    if (qualifiedName.starts_with(module))
      return has(kBuiltinTypes, qualifiedName.substr(module.size()));
  return has(kOpaque, qualifiedName) || beginsWithOne(qualifiedName, kOpaqueModules);
}

std::string adviceFor(std::string_view qualifiedName) {
  if (beginsWithOne(qualifiedName, kSystemModules))
    return "no checkpoint needs it: do not load this file in Python unless you trust its maker";
  return "load the file where it was made and save the weights alone: "
         "torch.save(model.state_dict(), 'weights.pt')";
}

}  // namespace marey::pickle
