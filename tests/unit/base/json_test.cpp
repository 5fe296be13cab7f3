#include "base/json.h"

#include "unit/base/support.h"
#include <gtest/gtest.h>

namespace marey {
namespace {

using test::messageOf;

JsonReader readerOf(const Json& value) {
  return {value, "run.json"};
}

TEST(JsonText, OfASyntaxErrorNamesTheFileAndTheLine) {
  const auto message =
      messageOf<InputError>([] { parseJson("{\n \"a\": 1,\n \"b\": }\n", "x.json"); });
  EXPECT_TRUE(message.starts_with("x.json:3: expected JSON")) << message;
  const auto cut = messageOf<InputError>([] { parseJson("{\n\"a\": \"b\n\n\n", "x.json"); });
  EXPECT_TRUE(cut.starts_with("x.json:2:")) << cut;
}

TEST(JsonText, BeyondTheRangeOfNumbersIsAnInputError) {
  EXPECT_THROW(parseJson("[1e999]", "x.json"), InputError);
}

TEST(JsonText, ThatNestsTooDeeplyIsRefused) {
  const std::string deep(100'000, '[');
  EXPECT_NE(messageOf<InputError>([&] { parseJson(deep, "x.json"); }).find("levels"),
            std::string::npos);
  const std::string fine = std::string(150, '[') + std::string(150, ']');
  EXPECT_NO_THROW(parseJson(fine, "x.json"));
  const std::string quoted = "\"" + std::string(1000, '[') + "\\\"" + std::string(1000, '{') + "\"";
  EXPECT_NO_THROW(parseJson(quoted, "x.json"));
}

TEST(JsonText, WithBytesThatAreNoUtf8IsStillWritten) {
  const Json value = {{"name",
                       "H\xfc"
                       "fte"}};
  EXPECT_EQ(jsonText(value),
            "{\"name\":\"H\xef\xbf\xbd"
            "fte\"}");
  const test::TempFolder folder;
  writeJson(folder / "a.json", value);
  EXPECT_EQ(readJson(folder / "a.json")["name"],
            "H\xef\xbf\xbd"
            "fte");
}

TEST(JsonText, SurvivesARoundTripThroughAFileInItsOrder) {
  const test::TempFolder folder;
  const Json value = {
      {"z", 1}, {"a", {1.5, -2.25, 1e-30}}, {"text", "ä\n\"q\""}, {"none", nullptr}};
  writeJson(folder / "deep/er/a.json", value);
  EXPECT_EQ(readJson(folder / "deep/er/a.json"), value);
  EXPECT_EQ(test::slurp(folder / "deep/er/a.json").find("\"z\""), 4u);
}

TEST(JsonReaderOfAnObject, NamesTheMissingKeyWithItsPath) {
  const Json value = {{"flow", {{"steps", 8}}}};
  JsonReader reader = readerOf(value);
  JsonReader flow = reader.object("flow");
  EXPECT_EQ(flow.required<int>("steps"), 8);
  EXPECT_EQ(messageOf<InputError>([&] { flow.required<int>("hidden"); }),
            "run.json, key 'flow.hidden': expected a value, found none");
}

TEST(JsonReaderOfAnObject, RejectsKeysThatNobodyAskedFor) {
  const Json value = {{"steps", 8}, {"stepz", 9}};
  JsonReader reader = readerOf(value);
  reader.required<int>("steps");
  EXPECT_EQ(messageOf<InputError>([&] { reader.finish(); }),
            "run.json, key 'stepz': expected a known key, found an unknown one");
  reader.optional<int>("stepz", 0);
  EXPECT_NO_THROW(reader.finish());
}

TEST(JsonReaderOfAnObject, TakesTheFallbackForMissingAndNullKeysOnly) {
  const Json value = {{"a", nullptr}, {"b", 3}};
  JsonReader reader = readerOf(value);
  EXPECT_EQ(reader.optional<int>("a", 7), 7);
  EXPECT_EQ(reader.optional<int>("b", 7), 3);
  EXPECT_EQ(reader.optional<int>("c", 7), 7);
}

TEST(JsonReaderOfAnObject, RefusesNumbersThatWouldChangeInConversion) {
  const Json value = {
      {"half", 1.5}, {"big", 4294967297}, {"negative", -1}, {"huge", 1e300},
      {"text", "3"}, {"list", {1, 2.5}},  {"truth", true},  {"max", 18446744073709551615u}};
  JsonReader reader = readerOf(value);
  EXPECT_THROW(reader.required<int>("half"), InputError);
  EXPECT_THROW(reader.required<int>("big"), InputError);
  EXPECT_EQ(reader.required<int64_t>("big"), 4294967297);
  EXPECT_THROW(reader.required<uint64_t>("negative"), InputError);
  EXPECT_THROW(reader.required<float>("huge"), InputError);
  EXPECT_EQ(reader.required<double>("huge"), 1e300);
  EXPECT_THROW(reader.required<int>("text"), InputError);
  EXPECT_THROW(reader.required<std::vector<int>>("list"), InputError);
  EXPECT_EQ(reader.required<std::vector<double>>("list"), (std::vector<double>{1, 2.5}));
  EXPECT_THROW(reader.required<int>("truth"), InputError);
  EXPECT_THROW(reader.required<bool>("half"), InputError);
  EXPECT_THROW(reader.required<int64_t>("max"), InputError);
  EXPECT_EQ(reader.required<uint64_t>("max"), 18446744073709551615u);
  EXPECT_THROW(reader.required<std::string>("half"), InputError);
}

TEST(JsonReaderOfAnObject, ReadsListsOfLists) {
  const Json value = {{"points", {{1.0, 2.0}, {3.0, 4.5}}}, {"wrong", {{1.0}, 2.0}}};
  JsonReader reader = readerOf(value);
  using Lists = std::vector<std::vector<float>>;
  EXPECT_EQ(reader.required<Lists>("points"), (Lists{{1.f, 2.f}, {3.f, 4.5f}}));
  EXPECT_THROW(reader.required<Lists>("wrong"), InputError);
}

TEST(JsonReaderOfAnObject, RefusesWhatIsNoObject) {
  const Json list = Json::array({1, 2});
  EXPECT_THROW(readerOf(list), InputError);
}

}  // namespace
}  // namespace marey
