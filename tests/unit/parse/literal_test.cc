#include "frontend/lex/literals.h"

#include <gtest/gtest.h>

#include <cmath>

namespace frontend {
namespace {

using base::DiagnosticCode;

constexpr uint64_t kSecond = 1'000'000'000;

template <class Decoded>
std::string problem(const Decoded& decoded) {
  return decoded.problem ? std::string(base::diagnostic_row(decoded.problem->code).code) : "";
}

TEST(Literal, Integers) {
  EXPECT_EQ(decode_integer("1_000").value, 1000u);
  EXPECT_EQ(decode_integer("16#fF").value, 255u);
  EXPECT_EQ(decode_integer("2#1010_0101").value, 0xA5u);
  EXPECT_EQ(decode_integer("8#17").value, 15u);
  EXPECT_TRUE(decode_integer("8#17").based);
  EXPECT_EQ(decode_integer("18446744073709551615").value, UINT64_MAX);
  EXPECT_FALSE(decode_integer("18446744073709551615").too_large);
  EXPECT_TRUE(decode_integer("18446744073709551616").too_large);
  EXPECT_TRUE(decode_integer("99999999999999999999999999999999").too_large);
  EXPECT_EQ(problem(decode_integer("18446744073709551616")), "E0007");
  EXPECT_FALSE(decode_integer("16#FFFF_FFFF_FFFF_FFFF").too_large);
}

TEST(Literal, BadIntegers) {
  for (const char* text :
       {"2#102", "3#1", "16#", "1__0", "1_", "16#_F", "12abc", "16#G", "99999#1", "1\xC3\xA4"}) {
    EXPECT_EQ(problem(decode_integer(text)), "E0006") << text;
  }
}

TEST(Literal, Reals) {
  EXPECT_EQ(decode_real("1.5").value, 1.5);
  EXPECT_EQ(decode_real("1_000.2_5").value, 1000.25);
  EXPECT_EQ(decode_real("1E6").value, 1e6);
  EXPECT_EQ(decode_real("2.5e-3").value, 2.5e-3);
  EXPECT_EQ(decode_real("2.5E+3").value, 2500);
  EXPECT_EQ(decode_real("0.1").value, 0.1);
  EXPECT_EQ(decode_real("1.7976931348623157E308").value, 1.7976931348623157E308);
  EXPECT_EQ(problem(decode_real("1E309")), "E0007");
  EXPECT_EQ(problem(decode_real("1E-999")), "");
  EXPECT_EQ(problem(decode_real("1.5_")), "E0006");
  EXPECT_EQ(problem(decode_real("1.5abc")), "E0006");
  EXPECT_EQ(problem(decode_real("1E")), "E0006");
  EXPECT_EQ(problem(decode_real(std::string(500, '1') + ".0")), "E0007");
}

TEST(Literal, Durations) {
  EXPECT_EQ(decode_duration("T#5s").ns, 5 * kSecond);
  EXPECT_EQ(decode_duration("TIME#1h30m").ns, 5400 * kSecond);
  EXPECT_EQ(decode_duration("t#1d_2h_3m_4s_5ms_6us_7ns").ns,
            ((24 + 2) * 3600 + 3 * 60 + 4) * kSecond + 5'006'007);
  EXPECT_EQ(decode_duration("T#1.5s").ns, 1'500'000'000u);
  EXPECT_EQ(decode_duration("T#0.1d").ns, 8640 * kSecond);
  EXPECT_EQ(decode_duration("T#1.0000000019s").ns, 1'000'000'001u);
  EXPECT_EQ(decode_duration("T#1.99999999999999999999999s").ns, 1'999'999'999u);
  EXPECT_EQ(decode_duration("T#90m").ns, 5400 * kSecond);
  EXPECT_TRUE(decode_duration("T#-5s").negative);
  EXPECT_EQ(decode_duration("T#-5s").ns, 5 * kSecond);
  EXPECT_TRUE(decode_duration("LTIME#1ns").is_long);
  EXPECT_FALSE(decode_duration("TIME#1ns").is_long);
}

TEST(Literal, DurationLimits) {
  EXPECT_EQ(decode_duration("LT#9223372036854775807ns").ns, 9223372036854775807u);
  EXPECT_EQ(problem(decode_duration("LT#9223372036854775807ns")), "");
  EXPECT_EQ(problem(decode_duration("LT#9223372036854775808ns")), "E0009");
  EXPECT_EQ(problem(decode_duration("LT#-9223372036854775808ns")), "");
  EXPECT_EQ(problem(decode_duration("LT#-9223372036854775809ns")), "E0009");
  EXPECT_EQ(problem(decode_duration("T#999999999999999999999d")), "E0009");
  EXPECT_EQ(problem(decode_duration("T#-99999999999999999999ns")), "E0009");
  EXPECT_EQ(problem(decode_duration("T#106751d23h47m16s854ms775us808ns")), "E0009");
}

TEST(Literal, BadDurations) {
  for (const char* text : {"T#5", "T#5x", "T#3s2h", "T#1s1s", "T#1.5h30m", "T#5_", "T#5s_x"}) {
    EXPECT_EQ(problem(decode_duration(text)), "E0008") << text;
  }
}

TEST(Literal, Dates) {
  EXPECT_EQ(decode_date("D#1970-01-02").time.ns, 86400 * kSecond);
  EXPECT_EQ(decode_date("DATE#2024-02-29").time.ns, 1709164800 * kSecond);
  EXPECT_TRUE(decode_date("D#1969-12-31").time.negative);
  EXPECT_EQ(decode_date("D#1969-12-31").time.ns, 86400 * kSecond);
  EXPECT_EQ(decode_date("TOD#12:30:15.25").time.ns, 45015 * kSecond + 250'000'000);
  EXPECT_EQ(decode_date("TOD#12:30").time.ns, 45000 * kSecond);
  EXPECT_EQ(decode_date("DT#2024-02-29-00:00:01").time.ns, 1709164801 * kSecond);
  EXPECT_EQ(decode_date("LDT#1970-01-01-00:00:00.000000001").time.ns, 1u);
  EXPECT_TRUE(decode_date("LDT#1970-01-01-00:00:00").time.is_long);
  EXPECT_EQ(decode_date("LTIME_OF_DAY#00:00:01").form, DateForm::kTimeOfDay);
  EXPECT_EQ(decode_date("DATE_AND_TIME#1970-01-01-00:00:00").form, DateForm::kDateAndTime);
}

TEST(Literal, BadDates) {
  for (const char* text :
       {"D#2023-02-29", "D#2024-13-01", "D#2024-00-01", "D#2024-01-32", "D#2024", "D#2024-01",
        "D#1600-01-01", "D#9999999999999999999-01-01", "TOD#24:00:00", "TOD#12:60", "TOD#12",
        "TOD#12:00:61", "DT#2024-01-01", "D#2024-01-01x", "DT#2024-01-01-12:00:00-5"}) {
    EXPECT_EQ(problem(decode_date(text).time), "E0010") << text;
  }
}

TEST(Literal, Strings) {
  EXPECT_EQ(decode_string("'abc'", StringCharset::kUtf8Source).bytes, "abc");
  EXPECT_EQ(decode_string("''", StringCharset::kUtf8Source).bytes, "");
  EXPECT_EQ(decode_string("'$$$'$\"$L$N$P$R$T$0A$e4'", StringCharset::kUtf8Source).bytes, "$'\"\n\n\f\r\t\n\xE4");
  EXPECT_EQ(decode_string("'\xC3\xA4'", StringCharset::kUtf8Source).bytes, "\xE4");
  EXPECT_EQ(decode_string("'\xC3\xA4'", StringCharset::kUtf8SourceBytes).bytes, "\xC3\xA4");
  EXPECT_EQ(decode_string("'\xE4'", StringCharset::kLatin1Source).bytes, "\xE4");
  EXPECT_EQ(decode_string("'\xE4'", StringCharset::kLatin1ToUtf8).bytes, "\xC3\xA4");
  EXPECT_EQ(problem(decode_string("'\xCE\xA9'", StringCharset::kUtf8Source)), "E0013");
  EXPECT_EQ(problem(decode_string("'\xCE\xA9'", StringCharset::kUtf8SourceBytes)), "");
  EXPECT_EQ(problem(decode_string("'cost $5'", StringCharset::kUtf8Source)), "E0005");
  EXPECT_EQ(problem(decode_string("'$", StringCharset::kUtf8Source)), "E0005");
  EXPECT_EQ(problem(decode_string("'$5G'", StringCharset::kUtf8Source)), "E0005");
}

TEST(Literal, WideStrings) {
  auto wide = [](const char* text, bool latin1 = false) {
    return decode_wide_string(text, latin1).bytes;
  };
  EXPECT_EQ(wide("\"a\""), std::string("a\0", 2));
  EXPECT_EQ(wide("\"$00C4\""), std::string("\xC4\0", 2));
  EXPECT_EQ(wide("\"\xC3\xA4\""), std::string("\xE4\0", 2));
  EXPECT_EQ(wide("\"\xE4\"", true), std::string("\xE4\0", 2));
  EXPECT_EQ(wide("\"\xF0\x9F\x98\x80\""), std::string("\x3D\xD8\x00\xDE", 4));
  EXPECT_EQ(problem(decode_wide_string("\"$0A\"", false)), "E0005");
}

TEST(Literal, Charset) {
  EXPECT_FALSE(is_latin1("plain"));
  EXPECT_FALSE(is_latin1("\xC3\xA4"));
  EXPECT_TRUE(is_latin1("\xE4"));
  EXPECT_TRUE(is_latin1("\xC3"));
}

ir::DirectAddress address(const char* text) { return decode_address(text).address; }

TEST(Literal, Addresses) {
  using Area = ir::DirectArea;
  EXPECT_EQ(address("%IX2.3"), (ir::DirectAddress{Area::kInput, 19, 1}));
  EXPECT_EQ(address("%q0.1"), (ir::DirectAddress{Area::kOutput, 1, 1}));
  EXPECT_EQ(address("%MX12"), (ir::DirectAddress{Area::kMarker, 12, 1}));
  EXPECT_EQ(address("%QB3"), (ir::DirectAddress{Area::kOutput, 24, 8}));
  EXPECT_EQ(address("%QW4"), (ir::DirectAddress{Area::kOutput, 64, 16}));
  EXPECT_EQ(address("%MD1"), (ir::DirectAddress{Area::kMarker, 32, 32}));
  EXPECT_EQ(address("%ML2"), (ir::DirectAddress{Area::kMarker, 128, 64}));
}

TEST(Literal, BadAddresses) {
  for (const char* text : {"%*", "%I", "%IX", "%IZ3", "%IX1.8", "%IX1..3", "%Z3", "%IW1*",
                           "%IX1a", "%IX99999999999", "%ID999999999", "%IX900000000.1"}) {
    EXPECT_EQ(problem(decode_address(text)), "E0011") << text;
  }
}

TEST(Literal, OpenRelativeAndHierarchicalAddresses) {
  EXPECT_TRUE(decode_address("%I*").incomplete);
  EXPECT_EQ(decode_address("%I*").address.bit_size, 0u);
  EXPECT_TRUE(decode_address("%qw*").incomplete);
  EXPECT_EQ(decode_address("%qw*").address.bit_size, 16u);
  EXPECT_EQ(decode_address("%B12").address.area, ir::DirectArea::kNone);
  EXPECT_EQ(decode_address("%B12").address.bit_offset, 96u);
  EXPECT_EQ(decode_address("%X1.3").address.bit_offset, 11u);
  EXPECT_EQ(decode_address("%IW2.5.7.1").levels, (std::vector<uint32_t>{2, 5, 7, 1}));
  EXPECT_TRUE(decode_address("%IX2.5").levels.empty());
  EXPECT_EQ(problem(decode_address("%IW1.2.3.4.5.6.7.8")), "");  // kMaxAddressLevels
  EXPECT_EQ(problem(decode_address("%IW1.2.3.4.5.6.7.8.9")), "E0011");
}

TEST(Literal, Parts) {
  EXPECT_EQ(decode_part("%X3").number, 3u);
  EXPECT_EQ(decode_part("%W1").bit_size, 16);
  EXPECT_EQ(decode_part("%d0").bit_size, 32);
  EXPECT_EQ(problem(decode_part("%L0")), "E0011");
  EXPECT_EQ(problem(decode_part("%X")), "E0011");
  EXPECT_EQ(problem(decode_part("%X1.2")), "E0011");
}

}  // namespace
}  // namespace frontend
