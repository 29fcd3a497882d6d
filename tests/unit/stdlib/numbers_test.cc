#include <bit>
#include <cmath>
#include <limits>

#include "ir/types/value_text.h"
#include "stdlib/native/calendar.h"
#include "tests/unit/stdlib/native_call.h"

namespace stdlib::testing {
namespace {

std::string to_text(NativeId id, uint64_t bits, uint32_t capacity = 80) {
  Text destination(capacity);
  call(id, {destination.arg(), {bits, nullptr, 0}});
  return destination.value();
}

std::string int_text(NativeId id, int64_t value, uint32_t capacity = 80) {
  return to_text(id, static_cast<uint64_t>(value), capacity);
}

std::string moment_text(NativeId id, int64_t value, bool is_long = false) {
  Text destination(80);
  call(id, {destination.arg(), number(value), number(is_long)});
  return destination.value();
}

std::string real_text(float value) {
  return to_text(NativeId::kF32ToString, std::bit_cast<uint32_t>(value));
}

std::string lreal_text(double value) {
  return to_text(NativeId::kF64ToString, std::bit_cast<uint64_t>(value));
}

uint64_t from_text(NativeId id, const std::string& value) {
  Text source(80, value);
  return call(id, {source.arg()});
}

int64_t to_int(const std::string& value) {
  return static_cast<int64_t>(from_text(NativeId::kStringToI64, value));
}

double to_lreal(const std::string& value) {
  return std::bit_cast<double>(from_text(NativeId::kStringToF64, value));
}

int64_t to_time(const std::string& value) {
  return static_cast<int64_t>(from_text(NativeId::kStringToTime, value));
}

TEST(NativeToText, Integers) {
  EXPECT_EQ(int_text(NativeId::kI64ToString, 0), "0");
  EXPECT_EQ(int_text(NativeId::kI64ToString, INT64_MIN), "-9223372036854775808");
  EXPECT_EQ(int_text(NativeId::kI64ToString, INT64_MAX), "9223372036854775807");
  EXPECT_EQ(to_text(NativeId::kU64ToString, UINT64_MAX), "18446744073709551615");
  EXPECT_EQ(int_text(NativeId::kI64ToString, -12345, 3), "-12");
  EXPECT_EQ(int_text(NativeId::kI64ToString, -12345, 0), "");
}

TEST(NativeToText, IntegersOfEveryLengthReadBack) {
  uint64_t number = 0;
  for (int digits = 1; digits <= 20; ++digits) {
    number = number * 10 + static_cast<uint64_t>(digits % 10);
    for (const uint64_t value : {number, number - 1, number + 1, 0 - number}) {
      EXPECT_EQ(to_text(NativeId::kU64ToString, value), std::to_string(value));
      EXPECT_EQ(from_text(NativeId::kStringToU64, std::to_string(value)), value);
      const auto whole = static_cast<int64_t>(value);
      EXPECT_EQ(int_text(NativeId::kI64ToString, whole), std::to_string(whole));
      EXPECT_EQ(to_int(std::to_string(whole)), whole);
    }
  }
}

TEST(NativeFromText, DecimalDigitsAtTheEdges) {
  EXPECT_EQ(from_text(NativeId::kStringToU64, "9999999999999999999"), 9999999999999999999u);
  EXPECT_EQ(from_text(NativeId::kStringToU64, "18446744073709551616"), UINT64_MAX);
  EXPECT_EQ(from_text(NativeId::kStringToU64, "00000000000000000000000000012"), 12u);
  EXPECT_EQ(from_text(NativeId::kStringToU64, "12 3"), 12u);
  EXPECT_EQ(from_text(NativeId::kStringToU64, "1_2_3"), 123u);
  EXPECT_EQ(from_text(NativeId::kStringToU64, "-5"), 0u);
  EXPECT_EQ(to_int("- 5"), 0);
  EXPECT_EQ(to_int("+-5"), 0);
  EXPECT_EQ(to_int("+"), 0);
  EXPECT_EQ(to_int("9223372036854775808"), INT64_MAX);
  EXPECT_EQ(to_int("-9223372036854775809"), INT64_MIN);
}

TEST(NativeToText, RealsAreShortestIecLiterals) {
  EXPECT_EQ(real_text(2.0f), "2.0");
  EXPECT_EQ(real_text(0.1f), "0.1");
  EXPECT_EQ(real_text(-0.0f), "-0.0");
  EXPECT_EQ(lreal_text(2.5), "2.5");
  EXPECT_EQ(lreal_text(0.1 + 0.2), "0.30000000000000004");
  EXPECT_EQ(lreal_text(1e10), "1.0E+10");
  EXPECT_EQ(lreal_text(-1.5e-300), "-1.5E-300");
  EXPECT_EQ(lreal_text(std::numeric_limits<double>::max()), "1.7976931348623157E+308");
  EXPECT_EQ(lreal_text(std::numeric_limits<double>::denorm_min()), "5.0E-324");
  EXPECT_EQ(lreal_text(std::nan("")), "NaN");
  EXPECT_EQ(lreal_text(std::numeric_limits<double>::infinity()), "+Inf");
  EXPECT_EQ(real_text(-std::numeric_limits<float>::infinity()), "-Inf");
}

TEST(NativeToText, EveryTextReadsBackTheSame) {
  uint64_t random = 1;
  for (int i = 0; i < 20000; ++i) {
    random = random * 6364136223846793005u + 1442695040888963407u;
    const double value = std::bit_cast<double>(random);
    if (std::isfinite(value)) {
      const std::string text = lreal_text(value);
      EXPECT_EQ(std::bit_cast<uint64_t>(to_lreal(text)), random) << text;
      EXPECT_NE(text.find('.'), std::string::npos) << text;
    }
  }
}

TEST(NativeToText, Bool) {
  EXPECT_EQ(to_text(NativeId::kBoolToString, 1), "TRUE");
  EXPECT_EQ(to_text(NativeId::kBoolToString, 0), "FALSE");
}

TEST(NativeToText, Durations) {
  EXPECT_EQ(moment_text(NativeId::kTimeToString, 0), "T#0ms");
  EXPECT_EQ(moment_text(NativeId::kTimeToString, 3'723'004'000'000), "T#1h2m3s4ms");
  EXPECT_EQ(moment_text(NativeId::kTimeToString, 3'000'005'006), "T#3s5us6ns");
  EXPECT_EQ(moment_text(NativeId::kTimeToString, -1'500'000'000), "T#-1s500ms");
  EXPECT_EQ(moment_text(NativeId::kTimeToString, 90'000'000'000'000), "T#1d1h");
  EXPECT_EQ(moment_text(NativeId::kTimeToString, INT64_MIN), "T#-106751d23h47m16s854ms775us808ns");
}

TEST(NativeToText, Dates) {
  constexpr int64_t kSecond = 1'000'000'000;
  EXPECT_EQ(moment_text(NativeId::kDateToString, 0), "D#1970-01-01");
  EXPECT_EQ(moment_text(NativeId::kDateToString, 951'782'400 * kSecond), "D#2000-02-29");
  EXPECT_EQ(moment_text(NativeId::kDateToString, -1), "D#1969-12-31");
  EXPECT_EQ(moment_text(NativeId::kDateToString, INT64_MAX), "D#2262-04-11");
  EXPECT_EQ(moment_text(NativeId::kDateToString, INT64_MIN), "D#1677-09-21");
  EXPECT_EQ(moment_text(NativeId::kDtToString, 1'769'862'896 * kSecond), "DT#2026-01-31-12:34:56");
  EXPECT_EQ(moment_text(NativeId::kDtToString, -1), "DT#1969-12-31-23:59:59.999999999");
  EXPECT_EQ(moment_text(NativeId::kTodToString, 45'296'789'000'000), "TOD#12:34:56.789");
  EXPECT_EQ(moment_text(NativeId::kTodToString, 0), "TOD#00:00:00");
}

TEST(NativeToText, LongFormsSaySo) {
  EXPECT_EQ(moment_text(NativeId::kTimeToString, 0, true), "LT#0ns");
  EXPECT_EQ(moment_text(NativeId::kTimeToString, -1'000, true), "LT#-1us");
  EXPECT_EQ(moment_text(NativeId::kDateToString, 0, true), "LD#1970-01-01");
  EXPECT_EQ(moment_text(NativeId::kTodToString, 1, true), "LTOD#00:00:00.000000001");
  EXPECT_EQ(moment_text(NativeId::kDtToString, 0, true), "LDT#1970-01-01-00:00:00");
}

TEST(NativeToText, Characters) {
  EXPECT_EQ(to_text(NativeId::kCharToString, 'x'), "x");
  EXPECT_EQ(to_text(NativeId::kCharToString, 0), "");
  EXPECT_EQ(to_text(NativeId::kCharToString, 0x20AC), "?");
  EXPECT_EQ(to_text(NativeId::kCharToString, 'x', 0), "");
  Text wide(4, "", 2);
  call(NativeId::kCharToWstring, {wide.arg(), number(0x141)});
  EXPECT_EQ(wide.value(), "\x41");
  call(NativeId::kCharToWstring, {wide.arg(), number(0)});
  EXPECT_EQ(wide.value(), "");
}

TEST(NativeFromText, Characters) {
  EXPECT_EQ(from_text(NativeId::kStringToChar, "abc"), 'a');
  EXPECT_EQ(from_text(NativeId::kStringToChar, ""), 0u);
  Text wide(4, "z", 2);
  EXPECT_EQ(call(NativeId::kWstringToChar, {wide.arg()}), 'z');
}

TEST(NativeFromText, Dates) {
  auto date = [](ir::Kind kind, const std::string& value) {
    Text source(80, value);
    return static_cast<int64_t>(
        call(NativeId::kStringToDate, {source.arg(), number(static_cast<int64_t>(kind))}));
  };
  EXPECT_EQ(date(ir::Kind::kDate, " D#1970-01-02 "), ir::kNsPerDay);
  EXPECT_EQ(date(ir::Kind::kTod, "00:00:01"), ir::kNsPerSecond);
  EXPECT_EQ(date(ir::Kind::kLdt, "LDT#1970-01-01-00:00:00.5"), ir::kNsPerSecond / 2);
  EXPECT_EQ(date(ir::Kind::kDate, "2023-02-29"), 0);
  EXPECT_EQ(date(ir::Kind::kDate, "nonsense"), 0);
}

int64_t moment(int64_t y, int64_t mo, int64_t d, int64_t h, int64_t mi, int64_t s, int64_t ms) {
  return static_cast<int64_t>(call(NativeId::kMoment, {number(y), number(mo), number(d), number(h),
                                                       number(mi), number(s), number(ms)}));
}

TEST(NativeDates, MomentsOfTheirParts) {
  EXPECT_EQ(moment(1970, 1, 1, 0, 0, 0, 0), 0);
  EXPECT_EQ(moment(1969, 12, 31, 23, 59, 59, 999), -1'000'000);
  EXPECT_EQ(moment(2024, 2, 29, 0, 0, 0, 0), 19782 * ir::kNsPerDay);
}

TEST(NativeDates, WhatIsNoMoment) {
  for (int64_t none : {moment(2023, 2, 29, 0, 0, 0, 0), moment(2024, 0, 1, 0, 0, 0, 0),
                       moment(2024, 13, 1, 0, 0, 0, 0), moment(2024, 4, 31, 0, 0, 0, 0),
                       moment(2024, 1, 0, 0, 0, 0, 0), moment(2024, 1, 1, 24, 0, 0, 0),
                       moment(2024, 1, 1, 0, 60, 0, 0), moment(2024, 1, 1, 0, 0, -1, 0),
                       moment(2024, 1, 1, 0, 0, 0, 1000), moment(1600, 1, 1, 0, 0, 0, 0),
                       moment(9999, 1, 1, 0, 0, 0, 0), moment(INT64_MAX, 1, 1, 0, 0, 0, 0)}) {
    EXPECT_EQ(none, INT64_MIN);
  }
}

TEST(NativeDates, PartsAndBack) {
  for (int64_t ns = -9'000'000'000'000'000'000; ns < 9'000'000'000'000'000'000;
       ns += 12'345'678'901'234'567) {
    int64_t parts[8];
    for (int64_t i = 0; i < 8; ++i) {
      parts[i] = static_cast<int64_t>(call(NativeId::kMomentPart, {number(ns), number(i)}));
    }
    const int64_t back =
        moment(parts[0], parts[1], parts[2], parts[3], parts[4], parts[5], parts[6]);
    EXPECT_TRUE(back <= ns && ns - back < ir::kNsPerMillisecond) << ns;
    EXPECT_EQ((split_days(ns).days % 7 + 11) % 7, parts[7]) << ns;
  }
}

TEST(NativeDigits, BinaryCodedDecimals) {
  auto from = [](uint64_t bcd) { return call(NativeId::kBcdToNumber, {{bcd, nullptr, 0}}); };
  auto to = [](uint64_t value) { return call(NativeId::kNumberToBcd, {{value, nullptr, 0}}); };
  EXPECT_EQ(from(0), 0u);
  EXPECT_EQ(from(0x9999'9999'9999'9999), 9'999'999'999'999'999u);
  EXPECT_EQ(from(0x1234'5678), 12'345'678u);
  EXPECT_EQ(from(0xA), UINT64_MAX);
  EXPECT_EQ(from(0xF000'0000'0000'0000), UINT64_MAX);
  for (uint64_t value = 0; value < 10'000'000'000'000'000; value = value * 3 + 7) {
    EXPECT_EQ(from(to(value)), value);
  }
}

TEST(NativeDigits, BytesInTheOtherOrder) {
  auto swap = [](uint64_t bits, int64_t bytes) {
    return call(NativeId::kSwapBytes, {{bits, nullptr, 0}, number(bytes)});
  };
  EXPECT_EQ(swap(0x1234, 2), 0x3412u);
  EXPECT_EQ(swap(0x12345678, 4), 0x78563412u);
  EXPECT_EQ(swap(0x0123456789ABCDEF, 8), 0xEFCDAB8967452301u);
  EXPECT_EQ(swap(0x12, 1), 0x12u);
  EXPECT_EQ(swap(0x12, 0), 0u);
}

TEST(NativeCalendar, FollowsEveryDayOfEightCenturies) {
  const uint32_t lengths[12] = {31, 28, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31};
  CivilDate expected = {1600, 1, 1};
  for (int64_t days = -135'140; expected.year < 2400; ++days) {
    const CivilDate date = civil_from_days(days);
    ASSERT_EQ(date.year, expected.year);
    ASSERT_EQ(date.month, expected.month);
    ASSERT_EQ(date.day, expected.day);
    const int64_t year = expected.year;
    const bool leap = year % 4 == 0 && (year % 100 != 0 || year % 400 == 0);
    const uint32_t last = lengths[expected.month - 1] + (leap && expected.month == 2 ? 1 : 0);
    if (++expected.day > last) {
      expected.day = 1;
      expected.year += expected.month == 12 ? 1 : 0;
      expected.month = expected.month % 12 + 1;
    }
  }
}

// What monitoring shows and what a program makes itself must not differ; only T#0ms is T#0s there.
TEST(NativeToText, SpeltLikeMonitoring) {
  const ir::TypeTable types;
  const std::pair<ir::Kind, NativeId> pairs[] = {
      {ir::Kind::kLint, NativeId::kI64ToString},  {ir::Kind::kUlint, NativeId::kU64ToString},
      {ir::Kind::kReal, NativeId::kF32ToString},  {ir::Kind::kLreal, NativeId::kF64ToString},
      {ir::Kind::kTime, NativeId::kTimeToString}, {ir::Kind::kDate, NativeId::kDateToString},
      {ir::Kind::kTod, NativeId::kTodToString},   {ir::Kind::kDt, NativeId::kDtToString}};
  uint64_t random = 7;
  for (int i = 0; i < 20000; ++i) {
    random = random * 6364136223846793005u + 1442695040888963407u;
    const auto [kind, id] = pairs[random >> 61];
    uint64_t bits = static_cast<uint64_t>(static_cast<int64_t>(random) >> (i % 50));
    bits = kind == ir::Kind::kReal ? bits & UINT32_MAX : bits;
    if (kind == ir::Kind::kDate) {
      bits -= bits % static_cast<uint64_t>(ir::kNsPerDay);
    }
    const std::string text = ir::elementary_group(kind) >= ir::Group::kDuration
                                 ? moment_text(id, static_cast<int64_t>(bits))
                                 : to_text(id, bits);
    EXPECT_EQ(text, ir::scalar_text(types, types.elementary(kind), bits)) << bits;
  }
}

TEST(NativeFromText, IntegersSaturate) {
  EXPECT_EQ(to_int("  -42 bottles"), -42);
  EXPECT_EQ(to_int("+7"), 7);
  EXPECT_EQ(to_int("16#Ff_g"), 255);
  EXPECT_EQ(to_int("-2#1111_1111"), -255);
  EXPECT_EQ(to_int("8#78"), 7);
  EXPECT_EQ(to_int("1_000"), 1000);
  EXPECT_EQ(to_int("3#1"), 3);
  EXPECT_EQ(to_int("16#"), 0);
  EXPECT_EQ(from_text(NativeId::kStringToU64, "16#FFFF_FFFF_FFFF_FFFF"), UINT64_MAX);
  EXPECT_EQ(from_text(NativeId::kStringToU64, "16#1_0000_0000_0000_0000"), UINT64_MAX);
  EXPECT_EQ(to_int("-9223372036854775808"), INT64_MIN);
  EXPECT_EQ(to_int("-9223372036854775809"), INT64_MIN);
  EXPECT_EQ(to_int("9223372036854775808"), INT64_MAX);
  EXPECT_EQ(to_int("99999999999999999999999"), INT64_MAX);
  EXPECT_EQ(from_text(NativeId::kStringToU64, "18446744073709551615"), UINT64_MAX);
  EXPECT_EQ(from_text(NativeId::kStringToU64, "18446744073709551616"), UINT64_MAX);
}

TEST(NativeFromText, NoNumberIsZero) {
  for (const char* text : {"", " ", "-", "+", "--1", "+-1", "x1", "\t1"}) {
    EXPECT_EQ(to_int(text), 0) << text;
    EXPECT_EQ(to_lreal(text), 0.0) << text;
  }
  EXPECT_EQ(from_text(NativeId::kStringToU64, "-5"), 0u);
  EXPECT_EQ(to_lreal("inf"), 0.0);
  EXPECT_EQ(to_lreal("nan"), 0.0);
  EXPECT_EQ(to_lreal("."), 0.0);
}

TEST(NativeFromText, Reals) {
  EXPECT_EQ(to_lreal(" -2.5e3 l/min"), -2500.0);
  EXPECT_EQ(to_lreal(".5"), 0.5);
  EXPECT_EQ(to_lreal("1e999999999999999999999"), std::numeric_limits<double>::infinity());
  EXPECT_EQ(to_lreal("-1e400"), -std::numeric_limits<double>::infinity());
  EXPECT_EQ(to_lreal("1e-400"), 0.0);
  EXPECT_EQ(to_lreal("0.001E-400"), 0.0);
  EXPECT_EQ(to_lreal("1e-999999999999999999999"), 0.0);
}

TEST(NativeFromText, Bools) {
  EXPECT_EQ(from_text(NativeId::kStringToBool, "TRUE"), 1u);
  EXPECT_EQ(from_text(NativeId::kStringToBool, " true "), 1u);
  EXPECT_EQ(from_text(NativeId::kStringToBool, "1"), 1u);
  for (const char* text : {"", "FALSE", "0", "2", "TRUE1", "TRU", "11"}) {
    EXPECT_EQ(from_text(NativeId::kStringToBool, text), 0u) << text;
  }
}

TEST(NativeFromText, Durations) {
  EXPECT_EQ(to_time("T#1h2m3s4ms"), 3'723'004'000'000);
  EXPECT_EQ(to_time(" time#1H_30m "), 5'400'000'000'000);
  EXPECT_EQ(to_time("LT#1d2ns"), 86'400'000'000'002);
  EXPECT_EQ(to_time("T#-1.5s"), -1'500'000'000);
  EXPECT_EQ(to_time("T#0.333333333333333333333s"), 333'333'333);
  EXPECT_EQ(to_time("T#1_000ms"), 1'000'000'000);
  EXPECT_EQ(to_time("250us"), 250'000);
}

TEST(NativeFromText, NoDurationIsZero) {
  for (const char* text :
       {"", "T#", "T#-", "5", "T#5", "T#s", "T#5x", "T#5s3h", "T#1.5h3m", "T#5s bottles", "T#_5s",
        "T#5.s", "T#9999999999h", "T#99999999999999999999ns", "T#2562047h47m16s854ms775us808ns"}) {
    EXPECT_EQ(to_time(text), 0) << text;
  }
}

TEST(NativeFromText, EveryDurationReadsBackTheSame) {
  uint64_t random = 1;
  for (int i = 0; i < 20000; ++i) {
    random = random * 6364136223846793005u + 1442695040888963407u;
    const auto ns = static_cast<int64_t>(random) >> (i % 60);
    EXPECT_EQ(to_time(moment_text(NativeId::kTimeToString, ns)), ns);
  }
  EXPECT_EQ(to_time("T#-2562047h47m16s854ms775us808ns"), INT64_MIN);
}

}  // namespace
}  // namespace stdlib::testing
