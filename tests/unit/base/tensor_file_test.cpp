#include "base/tensor_file.h"

#include <cmath>
#include <cstring>
#include <limits>

#include "unit/base/support.h"
#include <gtest/gtest.h>

namespace marey {
namespace {

using test::messageOf;

TensorFile sample() {
  const float floats[] = {1.5f, -2.0f, 3.25f, 4.0f, 5.0f, 6.0f};
  const double doubles[] = {1e-300, -0.1};
  const int64_t ints[] = {-5, int64_t{1} << 40};
  TensorFile file;
  file.tensors["weights"] = Tensor::fromFloats({2, 3}, floats);
  file.tensors["doubles"] = Tensor::fromDoubles({2}, doubles);
  file.tensors["ints"] = Tensor::fromInt64({2, 1}, ints);
  file.tensors["scalar"] = Tensor::fromFloats({}, floats);
  file.tensors["empty"] = Tensor::fromFloats({0, 4}, nullptr);
  file.metadata = {{"family", "moglow"}, {"joints", {"Hips", "Kn\xc3\xa9"}}};
  return file;
}

TEST(TensorFileOnDisk, ReturnsTensorsAndMetadataUnchanged) {
  const test::TempFolder folder;
  const TensorFile file = sample();
  writeTensorFile(folder / "m.marey", file);
  const TensorFile back = readTensorFile(folder / "m.marey");
  EXPECT_EQ(back.metadata, file.metadata);
  ASSERT_EQ(back.tensors.size(), file.tensors.size());
  for (const auto& [key, tensor] : file.tensors) {
    EXPECT_EQ(back.tensors.at(key).dtype, tensor.dtype) << key;
    EXPECT_EQ(back.tensors.at(key).shape, tensor.shape) << key;
    EXPECT_EQ(back.tensors.at(key).bytes, tensor.bytes) << key;
  }
}

// The layout is safetensors': read it as its specification says, without our reader.
TEST(TensorFileOnDisk, IsLaidOutAsTheSafetensorsSpecificationSays) {
  MAREY_NEED_PYTHON("numpy");
  const test::TempFolder folder;
  writeTensorFile(folder / "m.marey", sample());
  EXPECT_TRUE(test::runPython(folder.path(), R"(
import json, struct, numpy as np
raw = open('m.marey', 'rb').read()
n, = struct.unpack('<Q', raw[:8])
assert n % 8 == 0
header = json.loads(raw[8:8 + n])
data = raw[8 + n:]
def tensor(name, dtype):
    a, b = header[name]['data_offsets']
    return np.frombuffer(data[a:b], dtype).reshape(header[name]['shape'])
assert (tensor('weights', '<f4') == [[1.5, -2, 3.25], [4, 5, 6]]).all()
assert (tensor('doubles', '<f8') == [1e-300, -0.1]).all()
assert (tensor('ints', '<i8') == [[-5], [1 << 40]]).all()
assert header['scalar']['shape'] == [] and header['weights']['dtype'] == 'F32'
assert all(isinstance(v, str) for v in header['__metadata__'].values())
assert json.loads(header['__metadata__']['marey'])['family'] == 'moglow'
)")) << test::slurp(folder / "python.log");
}

TEST(TensorFileOnDisk, CutAtAnyLengthIsRefused) {
  const std::string bytes = serialise(sample());
  for (size_t length = 0; length < bytes.size(); ++length)
    EXPECT_THROW(parseTensorFile(std::string_view(bytes).substr(0, length), "m"), InputError)
        << length;
  EXPECT_THROW(parseTensorFile(bytes + "x", "m"), InputError);
}

std::string withHeader(const std::string& header, const std::string& data) {
  const uint64_t size = header.size();
  return std::string(reinterpret_cast<const char*>(&size), 8) + header + data;
}

TEST(TensorFileOnDisk, WithSizesThatDoNotAddUpIsRefused) {
  const std::string data(16, '\0');
  const auto parse = [&](const std::string& entry) {
    return parseTensorFile(withHeader("{\"a\": " + entry + "}", data), "m");
  };
  EXPECT_NO_THROW(parse(R"({"dtype": "F32", "shape": [4], "data_offsets": [0, 16]})"));
  const char* const wrong[] = {
      R"({"dtype": "F32", "shape": [5], "data_offsets": [0, 16]})",
      R"({"dtype": "F32", "shape": [4], "data_offsets": [0, 20]})",
      R"({"dtype": "F32", "shape": [2], "data_offsets": [8, 0]})",
      R"({"dtype": "F32", "shape": [2], "data_offsets": [0, 8]})",
      R"({"dtype": "F32", "shape": [-4], "data_offsets": [0, 16]})",
      R"({"dtype": "F32", "shape": [4.0], "data_offsets": [0, 16]})",
      R"({"dtype": "F32", "shape": [4294967296, 4294967296], "data_offsets": [0, 0]})",
      R"({"dtype": "BF16", "shape": [8], "data_offsets": [0, 16]})",
      R"({"dtype": "F32", "shape": [4]})",
      R"("F32")",
  };
  for (const char* entry : wrong) EXPECT_THROW(parse(entry), InputError) << entry;
}

TEST(TensorFileOnDisk, WhoseTensorsShareBytesIsRefused) {
  const std::string entry = R"({"dtype": "F32", "shape": [4], "data_offsets": [0, 16]})";
  const std::string header = "{\"a\": " + entry + ", \"b\": " + entry + "}";
  EXPECT_THROW(parseTensorFile(withHeader(header, std::string(16, '\0')), "m"), InputError);
}

TEST(TensorFileOnDisk, NamesTheMissingOrMisshapenTensor) {
  const TensorFile file = sample();
  EXPECT_NO_THROW(file.get("weights", {2, -1}, "m.marey"));
  EXPECT_EQ(messageOf<InputError>([&] {
              file.get("weights", {3, -1}, "m.marey");
            }),
            "m.marey, tensor 'weights': expected shape (3, any), found (2, 3)");
  EXPECT_EQ(messageOf<InputError>([&] { file.get("bias", {3}, "m.marey"); }),
            "m.marey, tensor 'bias': expected shape (3), found no such tensor");
  EXPECT_THROW(file.get("weights", {2, 3, 1}, "m.marey"), InputError);
}

uint16_t half(float value) {
  const Tensor halves = Tensor::fromFloats({1}, &value).as(DType::F16);
  uint16_t out = 0;
  std::memcpy(&out, halves.bytes.data(), 2);
  return out;
}

float fromHalf(uint16_t bits) {
  Tensor halves{.dtype = DType::F16, .shape = {1}, .bytes = std::vector<std::byte>(2)};
  std::memcpy(halves.bytes.data(), &bits, 2);
  return halves.toFloats()[0];
}

// numpy.float32(value).astype(numpy.float16).view(numpy.uint16) of NumPy 1.24.
TEST(HalfPrecision, RoundsAsNumpyDoes) {
  const std::pair<float, uint16_t> known[] = {
      {0.0f, 0x0000},     {-0.0f, 0x8000},    {1.0f, 0x3c00}, {-2.5f, 0xc100},   {65504.0f, 0x7bff},
      {65519.0f, 0x7bff}, {65520.0f, 0x7c00}, {1e5f, 0x7c00}, {6e-8f, 0x0001},   {0x1p-25f, 0x0000},
      {0x1p-14f, 0x0400}, {6.1e-5f, 0x03ff},  {0.1f, 0x2e66}, {2049.0f, 0x6800}, {2051.0f, 0x6802},
  };
  for (const auto& [value, bits] : known) EXPECT_EQ(half(value), bits) << value;
}

TEST(HalfPrecision, ReturnsEveryOfItsValuesUnchanged) {
  for (uint32_t bits = 0; bits < 0x10000; ++bits) {
    const auto word = static_cast<uint16_t>(bits);
    const float value = fromHalf(word);
    if (std::isnan(value))
      EXPECT_EQ(half(value) & 0x7e00, 0x7e00) << bits;
    else
      EXPECT_EQ(half(value), word) << bits;
  }
  // Independent of the conversion above: sign, exponent and mantissa by hand.
  EXPECT_EQ(fromHalf(0x3555), 1365.0f / 4096.0f);
  EXPECT_EQ(fromHalf(0x03ff), 1023.0f * 0x1p-24f);
  EXPECT_EQ(fromHalf(0xfc00), -std::numeric_limits<float>::infinity());
}

TEST(TensorValues, ConvertBetweenTypes) {
  const int64_t ints[] = {-3, 70000};
  const Tensor tensor = Tensor::fromInt64({2}, ints);
  EXPECT_EQ(tensor.toFloats(), (std::vector<float>{-3.f, 70000.f}));
  EXPECT_EQ(tensor.toDoubles(), (std::vector<double>{-3., 70000.}));
  EXPECT_EQ(tensor.as(DType::F64).dtype, DType::F64);
  EXPECT_EQ(tensor.as(DType::F64).toInt64(), tensor.toInt64());
}

TEST(TensorValues, WithoutAWholeNumberAreRefusedAsSuch) {
  for (const double value : {std::nan(""), 1e19, -1e300}) {
    const Tensor tensor = Tensor::fromDoubles({1}, &value);
    EXPECT_THROW(tensor.toInt64(), NumericError) << value;
  }
}

}  // namespace
}  // namespace marey
