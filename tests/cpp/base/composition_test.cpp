// Letters and their marks as one character or as two.
#include "base/composition.hpp"

#include <gtest/gtest.h>

namespace thawslide {
namespace {

TEST(Composition, JoinsLettersAndTheirMarks) {
  EXPECT_EQ(composed("Su\u0308d\u0301"), "S\u00fcd\u0301") << "there is no d with an acute accent";
  EXPECT_EQ(composed("e\u0302\u0301"), "\u1ebf") << "two marks";
  EXPECT_EQ(composed("\u0418\u0306\u304b\u3099"), "\u0419\u304c");
}

TEST(Composition, KeepsOtherTextAndInvalidBytes) {
  for (const char* text : {"", "abc", "S\u00fcd", "\u0308u", "\xff\u0308", "u\xcc", "\xf0\x9f\x92", "\U0001f3d4"}) {
    EXPECT_EQ(composed(text), text);
  }
}

}  // namespace
}  // namespace thawslide
