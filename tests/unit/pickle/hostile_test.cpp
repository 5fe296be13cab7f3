// Checkpoints made by hand: exact layouts, and everything a hostile file could try.
#include <climits>
#include <cstdint>

#include "pickle/torch_checkpoint.h"
#include "unit/base/support.h"
#include <gtest/gtest.h>

#include "base/archive.h"

namespace marey {
namespace {

namespace fs = std::filesystem;
using test::messageOf;
using test::slurp;
using test::TempFolder;

std::string littleEndian(uint64_t value, size_t bytes) {
  return {reinterpret_cast<const char*>(&value), bytes};
}
std::string text(const std::string& s) {
  return "X" + littleEndian(s.size(), 4) + s;
}
std::string number(uint32_t n) {
  return "J" + littleEndian(n, 4);
}
std::string global(const std::string& module, const std::string& name) {
  return "c" + module + "\n" + name + "\n";
}
std::string storageOf(const std::string& type, const std::string& key, uint32_t count) {
  return "(" + text("storage") + global("torch", type) + text(key) + text("cpu") + number(count) +
         "tQ";
}
/// shape and stride as pickled tuples of up to three items.
std::string tensorOf(const std::string& storage, uint32_t offset, const std::string& shape,
                     const std::string& stride) {
  return global("torch._utils", "_rebuild_tensor_v2") + "(" + storage + number(offset) + shape +
         stride + "\x89" + global("collections", "OrderedDict") + ")RtR";
}
std::string tuple(const std::vector<uint32_t>& items) {
  std::string out = "(";
  for (const uint32_t item : items) out += number(item);
  return out + "t";
}

/// A zip container around an object (without its STOP) and storage "0" of floats 0, 1, 2, ...
TorchCheckpoint parsed(const std::string& object, size_t floats = 6,
                       const TorchTensorFilter& filter = {}) {
  std::vector<float> values(floats);
  for (size_t i = 0; i < floats; ++i) values[i] = static_cast<float>(i);
  const TempFolder folder;
  writeArchive(folder / "a.pt",
               {{"a/data.pkl", "\x80\x02" + object + "."},
                {"a/data/0", {reinterpret_cast<const char*>(values.data()), floats * 4}}},
               false);
  return readTorchCheckpoint(folder / "a.pt", filter);
}
std::string refusal(const std::string& object) {
  return messageOf<InputError>([&] { parsed(object); });
}

std::string dictOf(const std::string& value) {
  return "}" + text("w") + value + "s";
}

TEST(TorchCheckpointByHand, OfAStridedTensorPicksItsElements) {
  const auto tensor = tensorOf(storageOf("FloatStorage", "0", 6), 1, tuple({2, 2}), tuple({1, 3}));
  EXPECT_EQ(parsed(dictOf(tensor)).tensors.at("w").toFloats(), (std::vector<float>{1, 4, 2, 5}));
}

TEST(TorchCheckpointByHand, CopiesOnlyTheTensorsAskedForAndChecksTheRest) {
  const auto tensor = tensorOf(storageOf("FloatStorage", "0", 6), 0, tuple({6}), tuple({1}));
  const auto beyond = tensorOf(storageOf("FloatStorage", "0", 6), 1, tuple({6}), tuple({1}));
  const TorchTensorFilter onlyA = [](const std::string& path) { return path == "a"; };
  const auto read = parsed("}" + text("a") + tensor + "s" + text("b") + tensor + "s", 6, onlyA);
  EXPECT_EQ(read.tensors.size(), 1u);
  EXPECT_TRUE(read.tensors.contains("a"));
  EXPECT_THROW(parsed("}" + text("a") + tensor + "s" + text("b") + beyond + "s", 6, onlyA),
               InputError);
}

TEST(TorchCheckpointByHand, OfPythonTwoHasItsTextAsKeys) {
  const auto tensor = tensorOf(storageOf("FloatStorage", "0", 6), 0, tuple({6}), tuple({1}));
  EXPECT_TRUE(parsed("}U\x01w" + tensor + "s").tensors.contains("w"));
  EXPECT_EQ(parsed(std::string("}U\x01\xe9K\x05s", 7)).scalars.at("\xc3\xa9"), 5);
}

TEST(TorchCheckpointByHand, ReadsIntegersOfAnyWidthAndSign) {
  const auto value = [](const std::string& opcodes) {
    return parsed(dictOf(opcodes)).scalars.at("w");
  };
  EXPECT_EQ(value("K\xff"), 255);
  EXPECT_EQ(value("M\xff\xff"), 65535);
  EXPECT_EQ(value("J\xff\xff\xff\xff"), -1);
  EXPECT_EQ(value(std::string("\x8a\x00", 2)), 0);
  EXPECT_EQ(value("\x8a\x01\xff"), -1);
  EXPECT_EQ(value(std::string("\x8a\x02\x00\x80", 4)), -32768);
  EXPECT_EQ(value("\x8a\x08\xff\xff\xff\xff\xff\xff\xff\x7f"), INT64_MAX);
  EXPECT_EQ(value(std::string("G\xbf\xf8\0\0\0\0\0\0", 9)), -1.5);
}

TEST(TorchCheckpointByHand, BeyondItsStorageIsRefused) {
  const auto attempt = [](uint32_t count, uint32_t offset, const std::string& shape,
                          const std::string& stride) {
    parsed(dictOf(tensorOf(storageOf("FloatStorage", "0", count), offset, shape, stride)));
  };
  EXPECT_NO_THROW(attempt(6, 0, tuple({6}), tuple({1})));
  EXPECT_NO_THROW(attempt(6, 5, tuple({1}), tuple({1})));
  EXPECT_THROW(attempt(6, 1, tuple({6}), tuple({1})), InputError);
  EXPECT_THROW(attempt(6, 6, tuple({1}), tuple({1})), InputError);
  EXPECT_THROW(attempt(6, 0, tuple({2, 2}), tuple({4, 2})), InputError);
  EXPECT_THROW(attempt(6, 0, tuple({2}), tuple({0x7fffffff})), InputError);
  EXPECT_THROW(attempt(6, 0, tuple({3, 2}), tuple({1})), InputError);
  EXPECT_THROW(attempt(6, 0, tuple({0xffffffff}), tuple({1})), InputError);
  EXPECT_THROW(attempt(6, 0xffffffff, tuple({1}), tuple({1})), InputError);
  EXPECT_THROW(attempt(7, 0, tuple({6}), tuple({1})), InputError) << "storage of another size";
  EXPECT_THROW(attempt(5, 0, tuple({5}), tuple({1})), InputError) << "storage of another size";
}

TEST(TorchCheckpointByHand, WithoutItsStorageNamesTheTensor) {
  const auto message =
      refusal(dictOf(tensorOf(storageOf("FloatStorage", "9", 6), 0, tuple({6}), tuple({1}))));
  EXPECT_NE(message.find("tensor 'w': expected its storage, found no storage '9'"),
            std::string::npos)
      << message;
}

TEST(TorchCheckpointByHand, ThatAsksForACallIsRefusedAndNothingRuns) {
  const TempFolder folder;
  const std::string command = "touch " + (folder / "executed").string();
  const std::string calls[] = {
      global("os", "system") + text(command) + "\x85R",
      global("posix", "system") + text(command) + "\x85R",
      text("os") + text("system") + "\x93" + text(command) + "\x85R",
      global("builtins", "eval") + text("1") + "\x85R",
      "(" + text(command) + "ios\nsystem\n",
      dictOf(global("subprocess", "Popen") + text(command) + "\x85\x81"),
      global("torch.storage", "_load_from_bytes") + text("x") + "\x85R",
      global("collections", "OrderedDict.__reduce__") + ")R",
      "}(" + text("a") + number(1) + text("b") + global("os", "system") + "u",
  };
  for (const auto& call : calls) {
    const auto message = refusal(call);
    EXPECT_NE(message.find("', which is refused (nothing was run)"), std::string::npos) << message;
  }
  EXPECT_NE(refusal(calls[0]).find("'os.system'"), std::string::npos);
  // The same as bare pickles, which torch.load would run as a legacy stream.
  EXPECT_NE(messageOf<InputError>([&] {
              parseTorchCheckpoint("\x80\x02" + calls[0] + ".", "x.pt");
            }).find("'os.system'"),
            std::string::npos);
  EXPECT_NE(messageOf<InputError>([&] {
              parseTorchCheckpoint("cos\nsystem\n(S'ls'\ntR.", "x.pt");
            }).find("'os.system'"),
            std::string::npos);
  EXPECT_FALSE(fs::exists(folder / "executed"));
}

TEST(TorchCheckpointByHand, WithAllowedNamesInTheWrongPlaceIsRefused) {
  const std::string wrong[] = {
      global("torch", "FloatStorage") + ")R",               // a storage type is no call
      global("collections", "OrderedDict") + "K\x01\x85R",  // a number is no list
      global("torch._utils", "_rebuild_tensor_v2") + ")R",  // no arguments
      global("torch._utils", "_rebuild_parameter") +
          "(K\x01K\x01Nt"
          "R",                                    // no tensor
      dictOf(global("torch", "FloatStorage")),    // a bare name as value
      dictOf(storageOf("FloatStorage", "0", 6)),  // a bare storage as value
      text("storage") + "Q",                      // no tuple as reference
      "K\x01}b",                                  // state of a number
  };
  for (const auto& object : wrong) EXPECT_FALSE(refusal(object).empty());
}

TEST(TorchCheckpointByHand, WithABrokenStackIsRefused) {
  for (const char* object : {"", "a", "s", "u", "t", "R", "b", "0", "1", "2", "(", "(a", "h\x05",
                             "q\x05", "]K\x01K\x01s", "}(K\x01u",
                             "}K\x01"
                             "a",
                             "\xff", "P0\n"})
    EXPECT_FALSE(refusal(object).empty()) << object;
}

TEST(TorchCheckpointByHand, ThatNestsWithoutEndIsRefused) {
  std::string deep;
  for (int i = 0; i < 200'000; ++i) deep += "]";
  for (int i = 0; i < 199'999; ++i) deep += "a";
  EXPECT_NE(refusal(deep).find("nesting"), std::string::npos);
  EXPECT_NE(refusal("]q\x01h\x01"
                    "a")
                .find("nesting"),
            std::string::npos)
      << "a list within itself";
  EXPECT_NE(refusal("}q\x01" + text("k") + "h\x01s").find("nesting"), std::string::npos);
}

TEST(TorchCheckpointByHand, ThatUnfoldsWithoutBoundIsRefused) {
  // Each list holds the one before ten times: ten to the thirtieth values in 700 bytes.
  std::string laughs = "]q";
  laughs += '\0';
  for (char level = 1; level < 31; ++level) {
    laughs += "](";
    for (int i = 0; i < 10; ++i) laughs += std::string("h") + static_cast<char>(level - 1);
    laughs += std::string("eq") + level;
  }
  EXPECT_NE(refusal(laughs).find("at most"), std::string::npos);
  // One long text, as a value again and again.
  std::string repeats = text(std::string(1 << 20, 'x')) + "q" + '\x01' + "0](";
  for (int i = 0; i < 2000; ++i) repeats += "h\x01";
  EXPECT_NE(refusal(repeats + "e").find("bytes of text"), std::string::npos);
  // One element, expanded to four terabytes.
  const auto expanded =
      tensorOf(storageOf("FloatStorage", "0", 6), 0, tuple({1 << 20, 1 << 20}), tuple({0, 0}));
  EXPECT_NE(refusal(dictOf(expanded)).find("in proportion"), std::string::npos);
}

TEST(TorchCheckpointByHand, WithAHugeMemoNumberCostsNothing) {
  EXPECT_EQ(parsed(dictOf("K\x07r\xff\xff\xff\xff"
                          "0j\xff\xff\xff\xff"))
                .scalars.at("w"),
            7);
}

TEST(TorchCheckpointByHand, WithTwoValuesOfOnePathIsRefused) {
  const auto inner = "}" + text("b") + number(1) + "s";
  EXPECT_NE(refusal("}" + text("a") + inner + "s" + text("a/b") + number(2) + "s").find("'a/b'"),
            std::string::npos);
  EXPECT_EQ(parsed("}" + text("a") + number(1) + "s" + text("a") + number(2) + "s").scalars.at("a"),
            2)
      << "within one dictionary the last value holds, as in Python";
}

TEST(TorchCheckpointByHand, WithTextThatIsNoUtf8IsRefused) {
  for (const char* bytes : {"\xff", "\xc0\x80", "\xed\xa0\x80", "\xe2\x82", "\xf4\x90\x80\x80"})
    EXPECT_NE(refusal(dictOf(text(bytes))).find("UTF-8"), std::string::npos);
  EXPECT_EQ(parsed(dictOf(text("\xf0\x9f\x90\x95"))).scalars.at("w"), "\xf0\x9f\x90\x95");
}

TEST(TorchCheckpointByHand, ThatIsAnotherKindOfFileSaysSo) {
  const auto message = [](const std::string& bytes) {
    return messageOf<InputError>([&] { parseTorchCheckpoint(bytes, "x.pt"); });
  };
  EXPECT_NE(message("HIERARCHY\n").find("expected a PyTorch checkpoint"), std::string::npos);
  EXPECT_NE(message("").find("an empty file"), std::string::npos);
  EXPECT_NE(message("\x80\x02K\x01.").find("another pickle"), std::string::npos);
  const TempFolder folder;
  writeArchive(folder / "a.npz", {{"clips.npy", "x"}});
  EXPECT_NE(message(slurp(folder / "a.npz")).find("without data.pkl"), std::string::npos);
  writeArchive(folder / "s.pt", {{"s/data.pkl", "\x80\x02}."}, {"s/constants.pkl", "\x80\x02)."}});
  EXPECT_NE(message(slurp(folder / "s.pt")).find("TorchScript"), std::string::npos);
  writeArchive(folder / "b.pt", {{"b/data.pkl", "\x80\x02}."}, {"b/byteorder", "big"}});
  EXPECT_NE(message(slurp(folder / "b.pt")).find("little-endian"), std::string::npos);
}

}  // namespace
}  // namespace marey
