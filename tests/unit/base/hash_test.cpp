#include "base/hash.h"

#include <gtest/gtest.h>

namespace marey {
namespace {

// From the reference program: printf '' | xxhsum -H128 (xxHash 0.8).
TEST(ContentHash, OfNothingIsThePublishedXxh3Value) {
  EXPECT_EQ(contentHash(""), "99aa06d3014798d86001c324468d497f");
}

TEST(ContentHash, ChangesWithEveryByte) {
  const std::string text(100, 'a');
  for (size_t i = 0; i < text.size(); ++i) {
    std::string other = text;
    other[i] = 'b';
    EXPECT_NE(contentHash(other), contentHash(text)) << i;
  }
  EXPECT_EQ(contentHash(text), contentHash(std::string(100, 'a')));
}

}  // namespace
}  // namespace marey
