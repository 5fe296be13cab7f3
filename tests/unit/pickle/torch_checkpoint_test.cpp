// Checkpoints that PyTorch itself writes, against the values that it reads back.
#include "pickle/torch_checkpoint.h"

#include <cmath>

#include "unit/base/support.h"
#include <gtest/gtest.h>

#include "base/npy.h"

namespace marey {
namespace {

namespace fs = std::filesystem;
using test::messageOf;
using test::slurp;
using test::TempFolder;

/// Saves `checkpoint` in every form and, beside it, the tensors that PyTorch itself reads back.
constexpr const char* kSave = R"(
import collections, itertools, numpy as np, torch
torch.manual_seed(1)

def flatten(value, path, out):
    if torch.is_tensor(value):
        out[path] = value.detach().numpy()
    elif isinstance(value, dict):
        for key, item in value.items():
            flatten(item, f'{path}/{key}' if path else str(key), out)
    elif isinstance(value, (list, tuple)):
        for i, item in enumerate(value):
            flatten(item, f'{path}/{i}', out)

def save(name, checkpoint, **options):
    torch.save(checkpoint, name + '.zip.pt', **options)
    torch.save(checkpoint, name + '.legacy.pt', _use_new_zipfile_serialization=False, **options)
    out = {}
    flatten(torch.load(name + '.legacy.pt'), '', out)
    np.savez(name + '.npz', **out)
)";

constexpr const char* kViews = R"(
base = torch.arange(60, dtype=torch.float32).reshape(3, 4, 5) / 7
save('views', {
    'whole': base, 'transposed': base.permute(2, 0, 1), 'row': base[1], 'strided': base[:, 1::2, ::3],
    'scalar': torch.tensor(2.5), 'empty': torch.zeros(0, 3), 'one': torch.ones(1, 1, 1),
    'expanded': torch.tensor([1.0, 2.0]).expand(3, 2), 'parameter': torch.nn.Parameter(base[2, 1:]),
    'double': base.double() / 3, 'half': base.half(), 'long': torch.tensor([-1, 2**40]),
    'int': torch.tensor([-7], dtype=torch.int32), 'byte': torch.tensor([0, 255], dtype=torch.uint8),
    'bool': torch.tensor([True, False, True])})
)";

constexpr const char* kTraining = R"(
model = torch.nn.Sequential(torch.nn.LSTM(3, 4, 2), torch.nn.Linear(4, 2))
optimiser = torch.optim.Adam(model.parameters(), lr=0.002)
model[1](model[0](torch.randn(5, 1, 3))[0]).sum().backward()
optimiser.step()
for protocol in (2, 3, 4): save(f'training{protocol}', {'global_step': 12, 'graph': model.state_dict(), 'optim': optimiser.state_dict(),
    'criterion': {}, 'best': np.float64(-1.25), 'count': np.int64(3), 'note': 'caf\u00e9', 'done': False,
    'none': None, 'shape': torch.Size([2, 3]), 'nested': [{'w': torch.ones(2)}, ('x', 1)],
    'big': 2**80, 'infinite': float('inf')}, pickle_protocol=protocol)
)";

void expectSame(const TorchCheckpoint& read, const fs::path& expected) {
  const auto arrays = readNpz(expected);
  EXPECT_EQ(read.tensors.size(), arrays.size());
  for (const auto& [path, array] : arrays) {
    ASSERT_TRUE(read.tensors.contains(path)) << path;
    const Tensor& tensor = read.tensors.at(path);
    EXPECT_EQ(tensor.dtype, array.dtype) << path;
    EXPECT_EQ(tensor.shape, array.shape) << path;
    EXPECT_EQ(tensor.bytes, array.bytes) << path;
  }
}

TEST(TorchCheckpointFromPyTorch, HasPyTorchsValuesWhateverTheStrides) {
  MAREY_NEED_PYTHON("torch");
  const TempFolder folder;
  ASSERT_TRUE(test::runPython(folder.path(), std::string(kSave) + kViews))
      << slurp(folder / "python.log");
  for (const char* form : {"zip", "legacy"}) {
    SCOPED_TRACE(form);
    expectSame(readTorchCheckpoint(folder / ("views." + std::string(form) + ".pt")),
               folder / "views.npz");
  }
}

TEST(TorchCheckpointFromPyTorch, OfATrainingRunHasTensorsAndScalarsByPath) {
  MAREY_NEED_PYTHON("torch");
  const TempFolder folder;
  ASSERT_TRUE(test::runPython(folder.path(), std::string(kSave) + kTraining))
      << slurp(folder / "python.log");
  for (const std::string protocol : {"2", "3", "4"}) {
    SCOPED_TRACE(protocol);
    for (const char* form : {"zip", "legacy"}) {
      SCOPED_TRACE(form);
      const auto read = readTorchCheckpoint(folder / ("training" + protocol + "." + form + ".pt"));
      expectSame(read, folder / ("training" + protocol + ".npz"));
      EXPECT_TRUE(read.tensors.contains("graph/0.weight_ih_l0"));
      EXPECT_TRUE(read.tensors.contains("optim/state/0/exp_avg"));
      const Json& scalars = read.scalars;
      EXPECT_EQ(scalars.at("global_step"), 12);
      EXPECT_EQ(scalars.at("best"), -1.25);
      EXPECT_EQ(scalars.at("count"), 3);
      EXPECT_EQ(scalars.at("note"), "caf\xc3\xa9");
      EXPECT_EQ(scalars.at("done"), false);
      EXPECT_TRUE(scalars.at("none").is_null());
      EXPECT_EQ(scalars.at("shape"), Json({2, 3}));
      EXPECT_EQ(scalars.at("nested/1"), Json({"x", 1}));
      EXPECT_EQ(scalars.at("optim/param_groups/0/lr"), 0.002);
      EXPECT_EQ(scalars.at("optim/param_groups/0/betas"), Json({0.9, 0.999}));
      EXPECT_TRUE(std::isinf(scalars.at("infinite").get<double>()));
      EXPECT_FALSE(scalars.contains("big"));
    }
  }
}

constexpr const char* kTrainingState = R"(
import argparse, collections, datetime, decimal, fractions, pathlib, random, uuid
w = torch.arange(6.0)
state = {'graph': collections.OrderedDict(w=w), 'args': argparse.Namespace(lr=0.1, out=pathlib.Path('/tmp')),
    'path': pathlib.PurePosixPath('a/b'), 'array': np.arange(3.0), 'big': np.arange(3, dtype='>f8'),
    'fields': np.zeros(2, dtype=[('x', 'f4')]), 'text': np.array(['a']), 'byte': np.uint8(3), 'date64': np.datetime64('2024-01-01'),
    'device': torch.device('cuda', 0), 'dtype': torch.float32, 'size': torch.Size([1, 2]), 'layout': torch.strided,
    'when': datetime.datetime(2024, 1, 2, tzinfo=datetime.timezone.utc), 'took': datetime.timedelta(seconds=3),
    'losses': collections.defaultdict(list, a=[1.0, 2.0]), 'counts': collections.Counter('abca'),
    'window': collections.deque([1.0, 2.0], maxlen=5), 'set': {1, 2}, 'frozen': frozenset({3}), 'complex': 1 + 2j,
    'range': range(3), 'slice': slice(1, 2), 'id': uuid.UUID(int=5), 'decimal': decimal.Decimal('1.5'),
    'fraction': fractions.Fraction(1, 3), 'rng': torch.get_rng_state(), 'numpy_rng': np.random.get_state(),
    'generator': np.random.default_rng(1), 'python_rng': random.getstate(), 'bytes': b'abc', 'array_of_bytes': bytearray(b'abc'),
    'keys': {torch.float32: 1, (0, 'a'): 2}, 'optimiser': torch.optim.SGD([torch.nn.Parameter(w.clone())], lr=1.0, momentum=0.9),
    'short': torch.tensor([-2, 300], dtype=torch.int16), 'char': torch.tensor([-3, 100], dtype=torch.int8),
    'brain': torch.tensor([1.5, -0.25, 3e38], dtype=torch.bfloat16)}
state['scheduler'] = torch.optim.lr_scheduler.StepLR(state['optimiser'], 10)
for protocol in (2, 4):
    torch.save(state, f'state{protocol}.zip.pt', pickle_protocol=protocol)
    torch.save(state, f'state{protocol}.legacy.pt', pickle_protocol=protocol, _use_new_zipfile_serialization=False)
)";

TEST(TorchCheckpointFromPyTorch, WithTrainingStateKeepsItByTheNameOfItsClass) {
  MAREY_NEED_PYTHON("torch");
  const TempFolder folder;
  ASSERT_TRUE(test::runPython(folder.path(), std::string(kSave) + kTrainingState))
      << slurp(folder / "python.log");
  const std::pair<const char*, const char*> classes[] = {{"args", "argparse.Namespace"},
                                                         {"path", "pathlib.PurePosixPath"},
                                                         {"array", "numpy.ndarray"},
                                                         {"big", "numpy.ndarray"},
                                                         {"device", "torch.device"},
                                                         {"dtype", "torch.float32"},
                                                         {"when", "datetime.datetime"},
                                                         {"window", "collections.deque"},
                                                         {"id", "uuid.UUID"},
                                                         {"optimiser", "torch.optim.sgd.SGD"}};
  for (const char* file :
       {"state2.zip.pt", "state4.zip.pt", "state2.legacy.pt", "state4.legacy.pt"}) {
    SCOPED_TRACE(file);
    const auto read = readTorchCheckpoint(folder / file);
    EXPECT_EQ(read.tensors.at("graph/w").toFloats(), (std::vector<float>{0, 1, 2, 3, 4, 5}));
    for (const auto& [path, name] : classes) {
      ASSERT_TRUE(read.opaque.contains(path)) << path;
      EXPECT_EQ(read.opaque.at(path), name);
    }
    EXPECT_EQ(read.scalars.at("losses/a"), Json({1.0, 2.0}));
    EXPECT_EQ(read.scalars.at("counts/a"), 2);
    EXPECT_EQ(read.scalars.at("keys/torch.float32"), 1);
    EXPECT_EQ(read.tensors.at("short").toInt64(), (std::vector<int64_t>{-2, 300}));
    EXPECT_EQ(read.tensors.at("char").toInt64(), (std::vector<int64_t>{-3, 100}));
    const auto brain = read.tensors.at("brain").toFloats();
    EXPECT_EQ(brain[0], 1.5f);
    EXPECT_EQ(brain[1], -0.25f);
    EXPECT_NEAR(brain[2] / 3e38f, 1.0f, 1.0f / 256.0f);
    for (const auto& [path, tensor] : read.tensors)
      EXPECT_FALSE(path.starts_with("optimiser")) << path;
  }
}

TEST(TorchCheckpointFromPyTorch, WithAClassOfItsOwnIsRefusedWithWhatToDo) {
  MAREY_NEED_PYTHON("torch");
  const TempFolder folder;
  ASSERT_TRUE(test::runPython(folder.path(), std::string(kSave) + R"(
import enum
class Mode(enum.Enum): TRAIN = 1
torch.save({'graph': {'w': torch.ones(2)}, 'mode': Mode.TRAIN}, 'mode.pt')
)")) << slurp(folder / "python.log");
  const auto message = messageOf<InputError>([&] { readTorchCheckpoint(folder / "mode.pt"); });
  EXPECT_NE(message.find("'__main__.Mode', which is refused"), std::string::npos) << message;
  EXPECT_NE(message.find("torch.save(model.state_dict()"), std::string::npos) << message;
}

TEST(TorchCheckpointFromPyTorch, CutAtAnyLengthOrChangedAnywhereNeverCrashes) {
  MAREY_NEED_PYTHON("torch");
  const TempFolder folder;
  ASSERT_TRUE(test::runPython(folder.path(),
                              std::string(kSave) + "save('m', {'a': torch.ones(2), 'b': [1]})\n"))
      << slurp(folder / "python.log");
  for (const char* form : {"m.zip.pt", "m.legacy.pt"}) {
    const std::string bytes = slurp(folder / form);
    ASSERT_NO_THROW(parseTorchCheckpoint(bytes, form));
    for (size_t length = 0; length < bytes.size(); ++length)
      EXPECT_THROW(parseTorchCheckpoint(std::string_view(bytes).substr(0, length), form),
                   InputError)
          << form << " cut to " << length;
    for (size_t i = 0; i < bytes.size(); ++i) {
      for (const int change : {0x01, 0x80, 0xff}) {
        std::string other = bytes;
        other[i] = static_cast<char>(other[i] ^ change);
        try {
          parseTorchCheckpoint(other, form);
        } catch (const InputError&) {
        }
      }
    }
  }
}

TEST(TorchCheckpointFromPyTorch, ThatRunsACommandOrHoldsAModuleIsRefused) {
  MAREY_NEED_PYTHON("torch");
  const TempFolder folder;
  ASSERT_TRUE(test::runPython(folder.path(), std::string(kSave) + R"(
import os
class Evil:
    def __reduce__(self):
        return (os.system, ('touch executed',))
for protocol in (2, 4):
    torch.save({'graph': Evil()}, f'evil{protocol}.zip.pt', pickle_protocol=protocol)
    torch.save({'graph': Evil()}, f'evil{protocol}.legacy.pt', pickle_protocol=protocol,
               _use_new_zipfile_serialization=False)
torch.save(torch.nn.Linear(2, 2), 'module.pt')
)")) << slurp(folder / "python.log");
  for (const char* file : {"evil2.zip.pt", "evil4.zip.pt", "evil2.legacy.pt", "evil4.legacy.pt"}) {
    const auto message = messageOf<InputError>([&] { readTorchCheckpoint(folder / file); });
    EXPECT_NE(message.find("'posix.system', which is refused"), std::string::npos) << message;
    EXPECT_EQ(message.find("state_dict()"), std::string::npos)
        << "nobody is told to load it: " << message;
  }
  const auto message = messageOf<InputError>([&] { readTorchCheckpoint(folder / "module.pt"); });
  EXPECT_NE(message.find("'torch.nn.modules.linear.Linear'"), std::string::npos) << message;
  EXPECT_FALSE(fs::exists("executed"));
  EXPECT_FALSE(fs::exists(folder / "executed"));
}

TEST(TorchCheckpointOfThePublishedModel, HoldsItsParameters) {
  const fs::path root = fs::path(MAREY_SHARED_DIR) / "conformance" / "moglow";
  if (!fs::exists(root)) {
    if (std::getenv("CI") != nullptr) FAIL() << root << " is not there";
    GTEST_SKIP() << root << " is not there";
  }
  for (const char* model : {"tiny-lu", "plain-weight", "human-63"}) {
    SCOPED_TRACE(model);
    const auto read = readTorchCheckpoint(root / model / "checkpoint.pkg");
    const Json config = readJson(root / model / "config.json");
    const int64_t dim = config["pose_dim"];
    EXPECT_TRUE(read.scalars.at("global_step").is_number_integer());
    EXPECT_EQ(read.tensors.at("graph/flow.layers.0.actnorm.bias").count(), dim);
    int64_t count = 0;
    for (const auto& [path, tensor] : read.tensors) {
      // Permutations and signs are stored, and are no parameters.
      const bool fixed = path.ends_with("invconv.p") || path.ends_with("invconv.sign_s");
      if (!fixed) count += tensor.count();
      for (const double v : tensor.toDoubles()) ASSERT_TRUE(std::isfinite(v)) << path;
    }
    EXPECT_EQ(count, config["parameters"].get<int64_t>());
  }
}

}  // namespace
}  // namespace marey
