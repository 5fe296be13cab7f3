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
np.savez('types.npz', **{t: np.arange(-3, 3).astype(t) for t in ('i1', 'i2', '>i2', '>i4', '>f8')},
         **{t: np.arange(6).astype(t) for t in ('u2', 'u4', 'u8', '>u2')})
np.savez('big.npz', x=np.array([2**63], dtype='u8'))
np.savez('mixed.npz', x=a, objects=np.array([{'a': 1}], dtype=object),
         names=np.array(['hip', 'Hüfte', '腰', '', '🦵'], dtype='>U7'), name=np.array('walk'),
         bytes=np.array([b'ab', b'c']), date=np.datetime64('2024-01-01'), c=np.zeros(2, 'c8'),
         fields=np.zeros(2, dtype=[('x', 'f4'), ('y', 'f4')]))
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

TEST(NpzFiles, HaveIntegersOfAllTypesAndByteOrders) {
  MAREY_NEED_PYTHON("numpy");
  const TempFolder folder;
  ASSERT_TRUE(test::runPython(folder.path(), kWriteArrays)) << slurp(folder / "python.log");
  const auto arrays = readNpz(folder / "types.npz");
  for (const char* type : {"i1", "i2", ">i2", ">i4", ">f8"})
    EXPECT_EQ(arrays.at(type).toInt64(), (std::vector<int64_t>{-3, -2, -1, 0, 1, 2})) << type;
  for (const char* type : {"u2", "u4", "u8", ">u2"})
    EXPECT_EQ(arrays.at(type).toInt64(), (std::vector<int64_t>{0, 1, 2, 3, 4, 5})) << type;
  const auto message = messageOf<InputError>([&] { readNpz(folder / "big.npz"); });
  EXPECT_NE(message.find("array 'x': expected whole numbers"), std::string::npos) << message;
}

TEST(NpzFiles, KeepTextAndNameWhatIsNeitherNumbersNorText) {
  MAREY_NEED_PYTHON("numpy");
  const TempFolder folder;
  ASSERT_TRUE(test::runPython(folder.path(), kWriteArrays)) << slurp(folder / "python.log");
  const NpzArrays arrays = readNpzArrays(folder / "mixed.npz");
  EXPECT_EQ(arrays.numbers.size(), 1u);
  EXPECT_EQ(arrays.texts.at("names").values,
            (std::vector<std::string>{"hip",
                                      "H\xc3\xbc"
                                      "fte",
                                      "\xe8\x85\xb0", "", "\xf0\x9f\xa6\xb5"}));
  EXPECT_EQ(arrays.texts.at("names").shape, std::vector<int64_t>{5});
  EXPECT_EQ(arrays.texts.at("name").values, std::vector<std::string>{"walk"});
  EXPECT_TRUE(arrays.texts.at("name").shape.empty());
  EXPECT_EQ(arrays.texts.at("bytes").values, (std::vector<std::string>{"ab", "c"}));
  const std::string listing = arrays.listing();
  for (const char* part : {"'objects' objects (a pickle, which is not opened) (1)",
                           "'date' dates ()", "'c' complex numbers (2)",
                           "'fields' structures of several fields (2)", "'x' int64 (2, 3, 4)"})
    EXPECT_NE(listing.find(part), std::string::npos) << listing;
}

TEST(NpzFiles, OfOtherWritersAreRead) {
  MAREY_NEED_PYTHON("numpy");
  const TempFolder folder;
  ASSERT_TRUE(test::runPython(folder.path(), R"(
import io, numpy as np, zipfile
def npy(a):
    out = io.BytesIO()
    np.save(out, a)
    return out.getvalue()
with zipfile.ZipFile('folder.npz', 'w', zipfile.ZIP_DEFLATED) as z:
    z.writestr('data/', b'')
    z.writestr('data/a.npy', npy(np.arange(3)))
    z.writestr('data/b.npy', npy(np.arange(4)))
    z.writestr('data/readme.txt', b'hello')
with zipfile.ZipFile('zip64.npz', 'w') as z:
    with z.open('a.npy', 'w', force_zip64=True) as entry:
        entry.write(npy(np.arange(3)))
with zipfile.ZipFile('none.npz', 'w') as z:
    z.writestr('walk.bvh', b'HIERARCHY')
with zipfile.ZipFile('twice.npz', 'w') as z:
    z.writestr('a.npy', npy(np.arange(3)))
    z.writestr('a.npy', npy(np.arange(4)))
)")) << slurp(folder / "python.log");
  const NpzArrays arrays = readNpzArrays(folder / "folder.npz");
  EXPECT_EQ(arrays.numbers.at("a").count(), 3);
  EXPECT_EQ(arrays.numbers.at("b").count(), 4);
  EXPECT_EQ(arrays.others.at("readme.txt"), "a text that begins with 'hello'");
  EXPECT_EQ(readNpz(folder / "zip64.npz").at("a").count(), 3);
  auto message = messageOf<InputError>([&] { readNpz(folder / "none.npz"); });
  EXPECT_NE(message.find("an NPZ archive of arrays, found a zip archive"), std::string::npos);
  message = messageOf<InputError>([&] { readNpz(folder / "twice.npz"); });
  EXPECT_NE(message.find("a name twice"), std::string::npos) << message;
}

TEST(NpzFiles, AreReadByNumpy) {
  MAREY_NEED_PYTHON("numpy");
  const TempFolder folder;
  const float floats[] = {0.5f, 1.f, 1.5f, 2.f, 2.5f, 3.f};
  const int64_t ints[] = {-1, 1};
  writeNpz(folder / "ours.npz",
           {.numbers = {{"clips", Tensor::fromFloats({2, 3}, floats)},
                        {"half", Tensor::fromFloats({3, 2}, floats).as(DType::F16)},
                        {"ints", Tensor::fromInt64({2}, ints)},
                        {"scalar", Tensor::fromFloats({}, floats)},
                        {"empty", Tensor::fromFloats({0, 2}, nullptr)}},
            .texts = {{"recipe", TextArray::one("{\"seed\": 1}")},
                      {"nothing", TextArray::one("")},
                      {"names", TextArray::list({"Hips", "\xe8\x85\xb0", "\x8d\x98"})}},
            .others = {}});
  EXPECT_TRUE(test::runPython(folder.path(), R"(
import numpy as np
z = np.load('ours.npz', allow_pickle=False)
assert z['clips'].dtype == np.float32 and (z['clips'] == [[.5, 1, 1.5], [2, 2.5, 3]]).all()
assert z['half'].dtype == np.float16 and (z['half'] == [[.5, 1], [1.5, 2], [2.5, 3]]).all()
assert z['ints'].dtype == np.int64 and (z['ints'] == [-1, 1]).all()
assert z['scalar'].shape == () and z['scalar'] == .5
assert z['empty'].shape == (0, 2)
assert z['recipe'].shape == () and z['recipe'].item() == '{"seed": 1}'
assert z['nothing'].item() == ''
assert z['names'].tolist() == ['Hips', '\u8170', r'\x8d\x98'], z['names']
)")) << slurp(folder / "python.log");
  EXPECT_EQ(readNpzArrays(folder / "ours.npz").texts.at("recipe").values.at(0), "{\"seed\": 1}");
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

TEST(NpyArrays, OfTextsWithoutALetterAreReadInEveryOrder) {
  for (const char* columnsFirst : {"True", "False"}) {
    const NpyArray array = parseNpyArray(
        npy(fmt::format("{{'descr': '<U0', 'fortran_order': {}, 'shape': (2, 3)}}", columnsFirst),
            ""),
        "a");
    ASSERT_TRUE(array.text) << columnsFirst;
    EXPECT_EQ(array.text->values, std::vector<std::string>(6)) << columnsFirst;
  }
}

TEST(NpyArrays, WithHeadersInDoubleQuotesAreRead) {
  const std::string data(8, '\0');
  EXPECT_EQ(parseNpy(npy(R"({"descr": "<f8", "fortran_order": False, "shape": (1,)})", data), "a")
                .count(),
            1);
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
