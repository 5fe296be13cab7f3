#include "base/npy.h"

#include "unit/base/support.h"
#include <gtest/gtest.h>

#include "base/archive.h"

namespace marey {
namespace {

using test::messageOf;
using test::slurp;
using test::TempFolder;

constexpr const char* kWriteArrays = R"(
import numpy as np
a = np.arange(24).reshape(2, 3, 4)
np.savez('plain.npz', f4=(a / 8).astype('<f4'), f8=a / 7, f2=(a / 16).astype('<f2'),
         i8=a.astype('<i8') - 5, i4=a.astype('<i4'), u1=a.astype('u1'), flag=a % 2 == 0,
         scalar=np.float64(2.5), empty=np.zeros((0, 3)), one=np.array([7.0]),
         fortran=np.asfortranarray(a / 2.0))
np.savez_compressed('packed.npz', clips=np.tile(a / 3, (50, 1, 1)))
np.savez('objects.npz', x=np.array([{'a': 1}], dtype=object))
np.savez('big.npz', x=np.arange(3, dtype='>f8'))
np.savez('text.npz', x=np.array(['a', 'b']))
)";

TEST(NpzFiles, FromNumpyHaveNumpysValues) {
  MAREY_NEED_PYTHON("numpy");
  const TempFolder folder;
  ASSERT_TRUE(test::runPython(folder.path(), kWriteArrays)) << slurp(folder / "python.log");
  const auto arrays = readNpz(folder / "plain.npz");
  ASSERT_EQ(arrays.size(), 11u);
  for (int i = 0; i < 24; ++i) {
    const auto at = static_cast<size_t>(i);
    EXPECT_EQ(arrays.at("f4").toFloats()[at], static_cast<float>(i) / 8);
    EXPECT_EQ(arrays.at("f8").toDoubles()[at], i / 7.0);
    EXPECT_EQ(arrays.at("f2").toFloats()[at], static_cast<float>(i) / 16);
    EXPECT_EQ(arrays.at("i8").toInt64()[at], i - 5);
    EXPECT_EQ(arrays.at("i4").toInt64()[at], i);
    EXPECT_EQ(arrays.at("u1").toInt64()[at], i);
    EXPECT_EQ(arrays.at("flag").toInt64()[at], i % 2 == 0);
    EXPECT_EQ(arrays.at("fortran").toDoubles()[at], i / 2.0) << "row-major in spite of its order";
  }
  EXPECT_EQ(arrays.at("f4").shape, (std::vector<int64_t>{2, 3, 4}));
  EXPECT_TRUE(arrays.at("scalar").shape.empty());
  EXPECT_EQ(arrays.at("scalar").toDoubles(), std::vector<double>{2.5});
  EXPECT_EQ(arrays.at("empty").shape, (std::vector<int64_t>{0, 3}));
  EXPECT_EQ(arrays.at("one").shape, std::vector<int64_t>{1});
  EXPECT_EQ(readNpz(folder / "packed.npz").at("clips").toDoubles()[25], 1 / 3.0);
}

TEST(NpzFiles, WithPicklesOtherByteOrdersOrTextAreRefused) {
  MAREY_NEED_PYTHON("numpy");
  const TempFolder folder;
  ASSERT_TRUE(test::runPython(folder.path(), kWriteArrays)) << slurp(folder / "python.log");
  for (const char* file : {"objects.npz", "big.npz", "text.npz"}) {
    const auto message = messageOf<InputError>([&] { readNpz(folder / file); });
    EXPECT_NE(message.find("array 'x'"), std::string::npos) << message;
    EXPECT_NE(message.find("number type"), std::string::npos) << message;
  }
}

TEST(NpzFiles, AreReadByNumpy) {
  MAREY_NEED_PYTHON("numpy");
  const TempFolder folder;
  const float floats[] = {0.5f, 1.f, 1.5f, 2.f, 2.5f, 3.f};
  const int64_t ints[] = {-1, 1};
  writeNpz(folder / "ours.npz", {{"clips", Tensor::fromFloats({2, 3}, floats)},
                                 {"half", Tensor::fromFloats({3, 2}, floats).as(DType::F16)},
                                 {"ints", Tensor::fromInt64({2}, ints)},
                                 {"scalar", Tensor::fromFloats({}, floats)},
                                 {"empty", Tensor::fromFloats({0, 2}, nullptr)},
                                 {"recipe", textTensor("{\"seed\": 1}")}});
  EXPECT_TRUE(test::runPython(folder.path(), R"(
import numpy as np
z = np.load('ours.npz', allow_pickle=False)
assert z['clips'].dtype == np.float32 and (z['clips'] == [[.5, 1, 1.5], [2, 2.5, 3]]).all()
assert z['half'].dtype == np.float16 and (z['half'] == [[.5, 1], [1.5, 2], [2.5, 3]]).all()
assert z['ints'].dtype == np.int64 and (z['ints'] == [-1, 1]).all()
assert z['scalar'].shape == () and z['scalar'] == .5
assert z['empty'].shape == (0, 2)
assert z['recipe'].tobytes() == b'{"seed": 1}'
)")) << slurp(folder / "python.log");
  EXPECT_EQ(tensorText(readNpz(folder / "ours.npz").at("recipe")), "{\"seed\": 1}");
}

TEST(NpyArrays, CutAtAnyLengthAreRefused) {
  const float floats[] = {1, 2, 3};
  const std::string bytes = serialiseNpy(Tensor::fromFloats({3}, floats));
  EXPECT_EQ(bytes.size() % 4, 0u);
  EXPECT_EQ((bytes.size() - 12) % 64, 0u);  // the format wants its data aligned to 64 bytes
  EXPECT_EQ(parseNpy(bytes, "a").toFloats(), (std::vector<float>{1, 2, 3}));
  for (size_t length = 0; length < bytes.size(); ++length)
    EXPECT_THROW(parseNpy(std::string_view(bytes).substr(0, length), "a"), InputError) << length;
}

std::string npy(const std::string& header, const std::string& data, int version = 1) {
  std::string out = "\x93NUMPY";
  out += static_cast<char>(version);
  out += '\0';
  const auto size = static_cast<uint32_t>(header.size());
  out.append(reinterpret_cast<const char*>(&size), version == 1 ? 2 : 4);
  return out + header + data;
}

TEST(NpyArrays, OfLaterVersionsAndWithoutBlanksAreRead) {
  const std::string data(8, '\0');
  EXPECT_NO_THROW(
      parseNpy(npy("{'descr':'<f8','fortran_order':False,'shape':(1,)}", data, 2), "a"));
  EXPECT_NO_THROW(
      parseNpy(npy("{'shape': (), 'fortran_order': True, 'descr': '<f8'}\n", data, 3), "a"));
}

TEST(NpyArrays, WithAWrongHeaderAreRefused) {
  const std::string data(8, '\0');
  const std::string wrong[] = {
      "",
      "{'descr': '<f8', 'fortran_order': False}",
      "{'descr': '<f8', 'fortran_order': 0, 'shape': (1,)}",
      "{'descr': '<f8', 'fortran_order': False, 'shape': (1,",
      "{'descr': '<f8', 'fortran_order': False, 'shape': (-1,)}",
      "{'descr': '<f8', 'fortran_order': False, 'shape': (2,)}",
      "{'descr': '<f8', 'fortran_order': False, 'shape': (99999999999999999999,)}",
      "{'descr': '<f8', 'fortran_order': False, 'shape': (1099511627776, 1099511627776)}",
      "{'descr': [('a', '<f8')], 'fortran_order': False, 'shape': (1,)}",
      "{'descr': '|O', 'fortran_order': False, 'shape': (1,)}",
  };
  for (const auto& header : wrong)
    EXPECT_THROW(parseNpy(npy(header, data), "a"), InputError) << header;
  EXPECT_THROW(parseNpy("PK and more bytes", "a"), InputError);
}

TEST(NpyArrays, WithAVeryLongHeaderDoNotExhaustTheStack) {
  const std::string header = "{'descr': '" + std::string(900'000, 'a') + "'";
  EXPECT_THROW(parseNpy(npy(header, "", 2), "a"), InputError);
  const std::string shape =
      "{'descr': '<f8', 'fortran_order': False, 'shape': (" + std::string(900'000, ' ') + "1,)}";
  EXPECT_EQ(parseNpy(npy(shape, std::string(8, '\0'), 2), "a").count(), 1);
}

}  // namespace
}  // namespace marey
