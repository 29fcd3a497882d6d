#include "ir/types/value_text.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>
#include <random>

namespace ir {
namespace {

uint64_t f32(float value) { return std::bit_cast<uint32_t>(value); }
uint64_t f64(double value) { return std::bit_cast<uint64_t>(value); }
uint64_t i64(int64_t value) { return static_cast<uint64_t>(value); }

class ValueText : public ::testing::Test {
 protected:
  std::string text(Kind kind, uint64_t bits) {
    return scalar_text(types, types.elementary(kind), bits);
  }
  // The bits, or "refused" as a failure.
  uint64_t parse(TypeId type, std::string_view literal) {
    const base::Result<uint64_t> bits = parse_scalar(types, type, literal);
    EXPECT_TRUE(bits.ok()) << literal;
    return bits.ok() ? *bits : 0xdead;
  }
  uint64_t parse(Kind kind, std::string_view literal) {
    return parse(types.elementary(kind), literal);
  }
  bool refuses(Kind kind, std::string_view literal) {
    const base::Result<uint64_t> bits = parse_scalar(types, types.elementary(kind), literal);
    return !bits.ok() && bits.error().refusal == base::Refusal::kBadValue;
  }

  TypeTable types;
};

TEST_F(ValueText, PrintsIntegersAndBits) {
  EXPECT_EQ(text(Kind::kBool, 1), "TRUE");
  EXPECT_EQ(text(Kind::kBool, 0), "FALSE");
  EXPECT_EQ(text(Kind::kSint, i64(-128)), "-128");
  EXPECT_EQ(text(Kind::kUlint, ~uint64_t{0}), "18446744073709551615");
  EXPECT_EQ(text(Kind::kWord, 0xff), "16#00FF");
  EXPECT_EQ(text(Kind::kLword, 1), "16#0000000000000001");
}

TEST_F(ValueText, PrintsShortestReals) {
  EXPECT_EQ(text(Kind::kReal, f32(2.5f)), "2.5");
  EXPECT_EQ(text(Kind::kReal, f32(0.1f)), "0.1");
  EXPECT_EQ(text(Kind::kLreal, f64(100)), "100.0");
  EXPECT_EQ(text(Kind::kLreal, f64(1e10)), "1.0E+10");
  EXPECT_EQ(text(Kind::kLreal, f64(-2.5e-7)), "-2.5E-07");
  EXPECT_EQ(text(Kind::kLreal, f64(-0.0)), "-0.0");
  EXPECT_EQ(text(Kind::kReal, f32(std::nanf(""))), "NaN");
  EXPECT_EQ(text(Kind::kReal, f32(INFINITY)), "+Inf");
  EXPECT_EQ(text(Kind::kLreal, f64(-INFINITY)), "-Inf");
}

TEST_F(ValueText, PrintsTimesAndDates) {
  EXPECT_EQ(text(Kind::kTime, 0), "T#0s");
  EXPECT_EQ(text(Kind::kTime, 1'500'000'000), "T#1s500ms");
  EXPECT_EQ(text(Kind::kLtime, i64(-90'061'001'002'003)), "LT#-1d1h1m1s1ms2us3ns");
  EXPECT_EQ(text(Kind::kTime, i64(std::numeric_limits<int64_t>::min())),
            "T#-106751d23h47m16s854ms775us808ns");
  EXPECT_EQ(text(Kind::kDate, 0), "D#1970-01-01");
  EXPECT_EQ(text(Kind::kDate, i64(-86'400'000'000'000)), "D#1969-12-31");
  EXPECT_EQ(text(Kind::kTod, 45'296'789'000'000), "TOD#12:34:56.789");
  EXPECT_EQ(text(Kind::kDt, 1'772'323'199'500'000'000), "DT#2026-02-28-23:59:59.5");
  EXPECT_EQ(text(Kind::kLdt, i64(std::numeric_limits<int64_t>::min())),
            "LDT#1677-09-21-00:12:43.145224192");
}

TEST_F(ValueText, ReadsIntegersInEveryForm) {
  EXPECT_EQ(parse(Kind::kInt, "5"), 5u);
  EXPECT_EQ(parse(Kind::kInt, " -32768 "), i64(-32768));
  EXPECT_EQ(parse(Kind::kInt, "INT#-5"), i64(-5));
  EXPECT_EQ(parse(Kind::kDint, "1_000"), 1000u);
  EXPECT_EQ(parse(Kind::kByte, "2#1010_0101"), 0xa5u);
  EXPECT_EQ(parse(Kind::kWord, "WORD#16#aF"), 0xafu);
  EXPECT_EQ(parse(Kind::kUsint, "8#17"), 15u);
  EXPECT_EQ(parse(Kind::kLint, "-9223372036854775808"), i64(INT64_MIN));
  EXPECT_EQ(parse(Kind::kBool, "true"), 1u);
  EXPECT_EQ(parse(Kind::kBool, "BOOL#0"), 0u);
}

TEST_F(ValueText, RefusesWhatDoesNotFit) {
  for (const char* literal : {"32768", "-32769", "", "-", "5x", "1__0", "_1", "1_", "16#", "16#G",
                              "INT#", "WORD#5", "5.0", "--5", "99999999999999999999"}) {
    EXPECT_TRUE(refuses(Kind::kInt, literal)) << literal;
  }
  EXPECT_TRUE(refuses(Kind::kUint, "-1"));
  EXPECT_TRUE(refuses(Kind::kBool, "2"));
  EXPECT_TRUE(refuses(Kind::kReal, "1E99"));
  EXPECT_TRUE(refuses(Kind::kReal, "0x10"));
  EXPECT_TRUE(refuses(Kind::kReal, "1.5abc"));
}

TEST_F(ValueText, ReadsReals) {
  EXPECT_EQ(parse(Kind::kReal, "3"), f32(3));
  EXPECT_EQ(parse(Kind::kReal, "REAL#1_000.5"), f32(1000.5f));
  EXPECT_EQ(parse(Kind::kLreal, "+1E6"), f64(1e6));
  EXPECT_EQ(parse(Kind::kLreal, "-Inf"), f64(-INFINITY));
}

TEST_F(ValueText, ReadsDurations) {
  EXPECT_EQ(parse(Kind::kTime, "T#1h2m3s4ms5us6ns"), 3'723'004'005'006u);
  EXPECT_EQ(parse(Kind::kTime, "time#1.5s"), 1'500'000'000u);
  EXPECT_EQ(parse(Kind::kTime, "TIME#1s_500ms"), 1'500'000'000u);
  EXPECT_EQ(parse(Kind::kTime, "-25h"), i64(-90'000'000'000'000));
  EXPECT_EQ(parse(Kind::kLtime, "LTIME#0.1d"), 8'640'000'000'000u);
  EXPECT_EQ(parse(Kind::kTime, "T#0.000000001s"), 1u);
  for (const char* literal : {"T#", "T#5", "5", "T#1s1m", "T#1s1s", "T#1.5m3s", "T#1.s", "D#1s",
                              "T#300000d", "T#1x", "T#-106751d23h47m16s854ms775us809ns"}) {
    EXPECT_TRUE(refuses(Kind::kTime, literal)) << literal;
  }
}

TEST_F(ValueText, ReadsDates) {
  EXPECT_EQ(parse(Kind::kDate, "D#1970-01-02"), 86'400'000'000'000u);
  EXPECT_EQ(parse(Kind::kDate, "date#2024-02-29"), 1'709'164'800'000'000'000u);
  EXPECT_EQ(parse(Kind::kTod, "TIME_OF_DAY#00:00:01.25"), 1'250'000'000u);
  EXPECT_EQ(parse(Kind::kDt, "DT#1970-01-01-00:01:00"), 60'000'000'000u);
  EXPECT_EQ(parse(Kind::kLdt, "LDATE_AND_TIME#1970-01-01-00:00:00.000000001"), 1u);
  for (const char* literal : {"D#2023-02-29", "D#2026-13-01", "D#2026-00-01", "D#2026-1",
                              "T#2026-01-01", "D#9999-01-01", "D#2026-01-01x", "D#"}) {
    EXPECT_TRUE(refuses(Kind::kDate, literal)) << literal;
  }
  EXPECT_TRUE(refuses(Kind::kTod, "TOD#24:00:00"));
  EXPECT_TRUE(refuses(Kind::kDt, "DT#2026-01-01"));
}

TEST_F(ValueText, NamesEnumerationLiterals) {
  Type colour;
  colour.kind = Kind::kEnum;
  colour.name = "Colour";
  colour.base = types.elementary(Kind::kInt);
  colour.literals = {{"Red", 0}, {"Green", 5}, {"Verde", 5}};
  const TypeId id = types.declare(colour);
  EXPECT_EQ(scalar_text(types, id, 5), "Green");
  EXPECT_EQ(scalar_text(types, id, 7), "7");
  EXPECT_EQ(parse(id, "red"), 0u);
  EXPECT_EQ(parse(id, "Colour#Verde"), 5u);
  EXPECT_EQ(parse(id, "colour.GREEN"), 5u);
  EXPECT_EQ(parse(id, "7"), 7u);
  EXPECT_FALSE(parse_scalar(types, id, "Blue").ok());
  const TypeId part = types.subrange(id, 5, 9);
  EXPECT_EQ(scalar_text(types, part, 5), "Green");
  EXPECT_EQ(parse(part, "Green"), 5u);
  EXPECT_FALSE(parse_scalar(types, part, "Red").ok());
}

TEST_F(ValueText, KeepsSubranges) {
  const TypeId percent = types.subrange(types.elementary(Kind::kInt), -10, 100);
  EXPECT_EQ(parse(percent, "-10"), i64(-10));
  EXPECT_FALSE(parse_scalar(types, percent, "101").ok());
  const TypeId high = types.subrange(types.elementary(Kind::kUlint), 1, -1);
  EXPECT_EQ(parse(high, "18446744073709551615"), ~uint64_t{0});
  EXPECT_FALSE(parse_scalar(types, high, "0").ok());
}

TEST_F(ValueText, WritesAndReadsStrings) {
  EXPECT_EQ(string_text("ab'c$\n\r\t\f\x01\xff"), "'ab$'c$$$L$R$T$P$01$FF'");
  EXPECT_EQ(*parse_string("STRING#'a$'$$$0A$n$L$t'"), std::string("a'$\n\n\n\t"));
  for (const char* literal : {"'", "ab", "'a'b'", "'$'", "'$0'", "'$G1'", "\"a\"", "'a$"}) {
    EXPECT_FALSE(parse_string(literal).ok()) << literal;
  }
}

TEST_F(ValueText, WritesAndReadsWideStrings) {
  const std::string units("a\0\xe4\0\x3d\xd8\x00\xde\"\0\x01\0\x00\xd8", 14);
  EXPECT_EQ(wstring_text(units), "\"a\xc3\xa4\xf0\x9f\x98\x80$\"$0001$D800\"");
  EXPECT_EQ(*parse_wstring(wstring_text(units)), units);
  EXPECT_EQ(*parse_wstring("WSTRING#\"$00e4\""), std::string("\xe4\0", 2));
  for (const char* literal : {"\"\xff\"", "\"\xc0\x80\"", "\"\xed\xa0\x80\"", "\"$00\"", "'a'"}) {
    EXPECT_FALSE(parse_wstring(literal).ok()) << literal;
  }
}

TEST_F(ValueText, WritesAndReadsCharacters) {
  EXPECT_EQ(text(Kind::kChar, 'A'), "'A'");
  EXPECT_EQ(text(Kind::kWchar, 0xe4), "\"\xc3\xa4\"");
  EXPECT_EQ(parse(Kind::kChar, "CHAR#'$0A'"), 10u);
  EXPECT_EQ(parse(Kind::kWchar, "\"\xc3\xa4\""), 0xe4u);
  EXPECT_TRUE(refuses(Kind::kChar, "'ab'"));
  EXPECT_TRUE(refuses(Kind::kChar, "''"));
}

// Every elementary type, random bits: what is printed reads back the same.
TEST_F(ValueText, ReadsBackWhatItPrints) {
  std::mt19937_64 random(1);
  for (uint32_t k = 0; k < kElementaryCount; ++k) {
    const Kind kind = static_cast<Kind>(k);
    const Scalar scalar = types.scalar(types.elementary(kind));
    const uint32_t unused = 64 - 8 * scalar_size(scalar);
    for (int round = 0; round < 500; ++round) {
      uint64_t bits = random() << unused;
      bits = is_signed(scalar) ? i64(static_cast<int64_t>(bits) >> unused) : bits >> unused;
      if (kind == Kind::kBool) bits &= 1;
      if (kind == Kind::kTod || kind == Kind::kLtod) bits %= 86'400'000'000'000;
      const bool date = kind == Kind::kDate || kind == Kind::kLdate;
      if (date)
        bits = i64(static_cast<int64_t>(bits >> 2) / 86'400'000'000'000 * 86'400'000'000'000);
      const bool nan = (scalar == Scalar::kF32 &&
                        std::isnan(std::bit_cast<float>(static_cast<uint32_t>(bits)))) ||
                       (scalar == Scalar::kF64 && std::isnan(std::bit_cast<double>(bits)));
      if (nan) continue;
      EXPECT_EQ(parse(kind, text(kind, bits)), bits) << text(kind, bits);
    }
  }
}

}  // namespace
}  // namespace ir
