#include "base/name_case.h"

#include <gtest/gtest.h>

namespace {

void expect_same(std::string_view a, std::string_view b) {
  EXPECT_TRUE(base::same_name(a, b)) << a << " " << b;
  EXPECT_EQ(base::fold_name(a), base::fold_name(b));
  EXPECT_EQ(base::name_hash(a), base::name_hash(b));
}

TEST(NameCase, FoldsLatinGreekAndCyrillic) {
  expect_same("Motor_1", "mOTOR_1");
  expect_same("GRÖßE", "größe");
  expect_same("ÀÉÎÕÜÝÞŸ", "àéîõüýþÿ");
  expect_same("ŁÓDŹ_ŻÓŁĆ_Ň_Ő", "łódź_żółć_ň_ő");
  expect_same("ΑΒΓΩ_ΆΈΌΏ_ΣΑΣ", "αβγω_άέόώ_σας");
  expect_same("НАСОС_Ё_Ѓ", "насос_ё_ѓ");
}

TEST(NameCase, KeepsOthersApart) {
  EXPECT_FALSE(base::same_name("a", "ä"));
  EXPECT_FALSE(base::same_name("×", "÷"));
  EXPECT_FALSE(base::same_name("ı", "i"));
  EXPECT_FALSE(base::same_name("温度", "温压"));
  EXPECT_TRUE(base::same_name("温度", "温度"));
  EXPECT_EQ(base::fold_name("温度"), "温度");
}

// What was folded once stays, and the length too, whatever the bytes.
TEST(NameCase, AnyBytes) {
  uint32_t state = 1;
  for (int round = 0; round < 20000; ++round) {
    std::string text;
    for (int i = 0; i < 6; ++i)
      text.push_back(static_cast<char>((state = state * 1664525 + 1013904223) >> 24));
    const std::string folded = base::fold_name(text);
    ASSERT_EQ(folded.size(), text.size());
    ASSERT_EQ(base::fold_name(folded), folded);
    ASSERT_TRUE(base::same_name(text, folded));
  }
}

// Names are compared and hashed by pieces of eight bytes: each byte at each place of them.
TEST(NameCase, EachByteAtEachPlace) {
  for (size_t size = 1; size <= 17; ++size) {
    for (size_t at = 0; at < size; ++at) {
      for (int byte = 0; byte < 0x100; ++byte) {
        std::string text(size, 'm');
        text[at] = static_cast<char>(byte);
        std::string other(size, 'M');
        other[at] = static_cast<char>(byte ^ 0x20);
        const bool same = base::fold_name(text) == base::fold_name(other);
        ASSERT_EQ(base::same_name(text, other), same) << size << ' ' << at << ' ' << byte;
        ASSERT_EQ(base::name_hash(text) == base::name_hash(other), same);
      }
    }
  }
}

}  // namespace
