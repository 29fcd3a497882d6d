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
  EXPECT_EQ(int_text(NativeId::kTimeToString, 0), "T#0s");
  EXPECT_EQ(int_text(NativeId::kTimeToString, 3'723'004'000'000), "T#1h2m3s4ms");
  EXPECT_EQ(int_text(NativeId::kTimeToString, 3'000'005'006), "T#3s5us6ns");
  EXPECT_EQ(int_text(NativeId::kTimeToString, -1'500'000'000), "T#-1s500ms");
  EXPECT_EQ(int_text(NativeId::kTimeToString, 90'000'000'000'000), "T#1d1h");
  EXPECT_EQ(int_text(NativeId::kTimeToString, INT64_MIN), "T#-106751d23h47m16s854ms775us808ns");
}

TEST(NativeToText, Dates) {
  constexpr int64_t kSecond = 1'000'000'000;
  EXPECT_EQ(int_text(NativeId::kDateToString, 0), "D#1970-01-01");
  EXPECT_EQ(int_text(NativeId::kDateToString, 951'782'400 * kSecond), "D#2000-02-29");
  EXPECT_EQ(int_text(NativeId::kDateToString, -1), "D#1969-12-31");
  EXPECT_EQ(int_text(NativeId::kDateToString, INT64_MAX), "D#2262-04-11");
  EXPECT_EQ(int_text(NativeId::kDateToString, INT64_MIN), "D#1677-09-21");
  EXPECT_EQ(int_text(NativeId::kDtToString, 1'769'862'896 * kSecond), "DT#2026-01-31-12:34:56");
  EXPECT_EQ(int_text(NativeId::kDtToString, -1), "DT#1969-12-31-23:59:59.999999999");
  EXPECT_EQ(int_text(NativeId::kTodToString, 45'296'789'000'000), "TOD#12:34:56.789");
  EXPECT_EQ(int_text(NativeId::kTodToString, 0), "TOD#00:00:00");
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

// What monitoring shows and what a program makes itself must not differ.
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
      bits -= bits % static_cast<uint64_t>(kNsPerDay);
    }
    EXPECT_EQ(to_text(id, bits), ir::scalar_text(types, types.elementary(kind), bits)) << bits;
  }
}

TEST(NativeFromText, IntegersSaturate) {
  EXPECT_EQ(to_int("  -42 bottles"), -42);
  EXPECT_EQ(to_int("+7"), 7);
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
    EXPECT_EQ(to_time(int_text(NativeId::kTimeToString, ns)), ns);
  }
  EXPECT_EQ(to_time("T#-2562047h47m16s854ms775us808ns"), INT64_MIN);
}

}  // namespace
}  // namespace stdlib::testing
