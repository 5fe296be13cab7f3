#include "base/ranks.h"

#include <cmath>

#include <gtest/gtest.h>

#include "base/error.h"
#include "base/packing.h"

namespace marey {
namespace {

TEST(Shares, HoldEveryItemOnceInOrderAndDifferByOneAtMost) {
  for (const size_t items : {0u, 1u, 2u, 7u, 64u, 1000003u})
    for (const int ranks : {1, 2, 3, 8}) {
      size_t next = 0;
      for (int r = 0; r < ranks; ++r) {
        const auto [first, last] = shareOf(items, r, ranks);
        EXPECT_EQ(first, next);
        EXPECT_LE(last - first, items / static_cast<size_t>(ranks) + 1);
        EXPECT_GE(last - first, items / static_cast<size_t>(ranks));
        next = last;
      }
      EXPECT_EQ(next, items);
    }
  EXPECT_EQ(shareOf(1, 0, 3), (std::pair<size_t, size_t>(0, 1)));
}

TEST(OneProcess, DoesAllTheWorkItself) {
  Ranks ranks;
  Progress progress;
  const auto results = ranks.gather(
      3,
      [](size_t first, size_t last, Progress&) {
        std::vector<std::string> out;
        for (size_t i = first; i < last; ++i) out.push_back(std::to_string(i * i));
        return out;
      },
      progress);
  EXPECT_EQ(results, (std::vector<std::string>{"0", "1", "4"}));
  EXPECT_EQ(ranks.fromFirst([] { return std::string("told"); }), "told");
  EXPECT_THROW(ranks.together([] { throw UsageError("wrong"); }), UsageError);
}

TEST(PackedValues, ComeBackBitForBitAndACutIsRefused) {
  Packer packer;
  packer.add(0.1);
  packer.add(std::string("na\0me", 5)).add(std::vector<double>{1e-300, -0.0}).add(true);
  const std::string bytes = packer.take();
  Unpacker rest(bytes);
  EXPECT_EQ(rest.number<double>(), 0.1);
  EXPECT_EQ(rest.text(), std::string("na\0me", 5));
  const auto list = rest.list<double>();
  EXPECT_EQ(list[0], 1e-300);
  EXPECT_TRUE(std::signbit(list[1]));
  EXPECT_TRUE(rest.number<bool>());
  EXPECT_TRUE(rest.done());
  Unpacker cut(std::string_view(bytes).substr(0, bytes.size() - 6));
  cut.number<double>();
  cut.text();
  EXPECT_THROW(cut.list<double>(), Error);
}

}  // namespace
}  // namespace marey
