// A14, one scalar or string at a time.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include "online_change/diff/fast_conversion.h"
#include "online_change/diff/value_conversion.h"

namespace online_change {
namespace {

using ir::Kind;

uint64_t real(float value) { return std::bit_cast<uint32_t>(value); }
uint64_t lreal(double value) { return std::bit_cast<uint64_t>(value); }
uint64_t integer(int64_t value) { return static_cast<uint64_t>(value); }

struct Case {
  Kind from;
  Kind to;
  uint64_t bits;
  uint64_t expected;
  const char* loss;
};

TEST(Conversion, A14_scalars) {
  const Case kCases[] = {
      {Kind::kInt, Kind::kSint, integer(100), integer(100), nullptr},
      {Kind::kInt, Kind::kSint, integer(300), integer(127), "saturates"},
      {Kind::kInt, Kind::kSint, integer(-300), integer(-128), "saturates"},
      {Kind::kUint, Kind::kInt, 40000, integer(32767), "saturates"},
      {Kind::kInt, Kind::kUint, integer(-1), 0, "saturates"},
      {Kind::kLint, Kind::kUlint, integer(-1), 0, "saturates"},
      {Kind::kUlint, Kind::kLint, ~uint64_t{0}, integer(std::numeric_limits<int64_t>::max()),
       "saturates"},
      {Kind::kInt, Kind::kReal, integer(-7), real(-7), nullptr},
      {Kind::kDint, Kind::kReal, integer(16777217), real(16777216.0f), "inexact"},
      {Kind::kUlint, Kind::kLreal, ~uint64_t{0}, lreal(0x1p64), "inexact"},
      {Kind::kReal, Kind::kInt, real(1e30f), integer(32767), "saturates"},
      {Kind::kReal, Kind::kInt, real(-1e30f), integer(-32768), "saturates"},
      {Kind::kReal, Kind::kInt, real(3.0f), integer(3), nullptr},
      {Kind::kReal, Kind::kInt, real(2.5f), integer(2), "inexact"},
      {Kind::kLreal, Kind::kInt, lreal(3.5), integer(4), "inexact"},
      {Kind::kLreal, Kind::kInt, lreal(-2.5), integer(-2), "inexact"},
      {Kind::kReal, Kind::kLreal, real(0.1f), lreal(static_cast<double>(0.1f)), nullptr},
      {Kind::kLreal, Kind::kReal, lreal(0.5), real(0.5f), nullptr},
      {Kind::kLreal, Kind::kReal, lreal(0.1), real(0.1f), "inexact"},
      {Kind::kLreal, Kind::kReal, lreal(1e300), real(std::numeric_limits<float>::max()),
       "saturates"},
      {Kind::kLreal, Kind::kReal, lreal(HUGE_VAL), real(HUGE_VALF), nullptr},
      {Kind::kBool, Kind::kInt, 1, 1, nullptr},
      {Kind::kInt, Kind::kBool, 1, 1, nullptr},
      {Kind::kInt, Kind::kBool, 2, 1, "saturates"},
      {Kind::kWord, Kind::kByte, 0x1ff, 0xff, "saturates"},
      {Kind::kByte, Kind::kInt, 0xff, 255, nullptr},
      {Kind::kTime, Kind::kLtime, 5'000'000'000, 5'000'000'000, nullptr},
      {Kind::kDt, Kind::kDate, 86'400'000'000'001, 86'400'000'000'000, "truncates"},
      {Kind::kWchar, Kind::kChar, 0x20ac, '?', "is replaced"},
  };
  for (const Case& c : kCases) {
    Converted out = convert(c.from, c.to, c.bits);
    std::string what = std::string(ir::elementary_name(c.from)) + " -> " +
                       std::string(ir::elementary_name(c.to)) + " " + std::to_string(c.bits);
    EXPECT_EQ(out.bits, c.expected) << what;
    EXPECT_STREQ(out.loss, c.loss) << what;
    EXPECT_FALSE(out.initialise) << what;
  }
}

TEST(Conversion, A14_nan_has_no_integer) {
  Converted out = convert(Kind::kLreal, Kind::kInt, lreal(std::nan("")));
  EXPECT_TRUE(out.initialise);
  EXPECT_NE(out.loss, nullptr);
}

// Whatever is called exact never loses, whatever may lose says so beforehand.
TEST(Conversion, classify_agrees_with_convert) {
  ir::TypeTable types;
  const uint64_t kSamples[] = {0,
                               1,
                               2,
                               127,
                               128,
                               255,
                               256,
                               32767,
                               32768,
                               65535,
                               1u << 24,
                               (1u << 24) + 1,
                               0xffffffff,
                               ~uint64_t{0},
                               integer(-128),
                               integer(-32768),
                               uint64_t{1} << 53,
                               (uint64_t{1} << 53) + 1};
  const Kind kIntegers[] = {Kind::kBool,  Kind::kSint,  Kind::kInt,   Kind::kDint,  Kind::kLint,
                            Kind::kUsint, Kind::kUint,  Kind::kUdint, Kind::kUlint, Kind::kByte,
                            Kind::kWord,  Kind::kDword, Kind::kLword};
  for (Kind from : kIntegers) {
    for (uint32_t k = 0; k < ir::kElementaryCount; ++k) {
      auto to = static_cast<Kind>(k);
      ir::TypeId from_id = types.elementary(from);
      Conversion conversion = classify(types, from_id, types, types.elementary(to));
      if (conversion != Conversion::kExact) continue;
      for (uint64_t sample : kSamples) {
        Converted valid = convert(Kind::kLint, from, sample);  // a value that `from` can hold
        EXPECT_EQ(convert(from, to, valid.bits).loss, nullptr)
            << ir::elementary_name(from) << " -> " << ir::elementary_name(to) << " " << sample;
      }
    }
  }
}

// The fast way does exactly what is exact, and leaves the rest to the rules.
TEST(Conversion, fast_runs_agree_with_the_rules) {
  ir::TypeTable types;
  std::vector<uint64_t> samples = {0,
                                   1,
                                   2,
                                   ~uint64_t{0},
                                   lreal(0.5),
                                   lreal(-1),
                                   lreal(1e300),
                                   lreal(std::nan("")),
                                   lreal(0x1p63),
                                   lreal(-0x1p63),
                                   real(2.5f),
                                   real(-3.0f),
                                   real(HUGE_VALF),
                                   real(0x1p31f)};
  for (int bit = 0; bit < 64; ++bit) {
    samples.push_back(uint64_t{1} << bit);
    samples.push_back((uint64_t{1} << bit) - 1);
    samples.push_back(~uint64_t{0} << bit);
  }
  uint32_t pairs = 0;
  for (uint32_t f = 0; f < ir::kElementaryCount; ++f) {
    for (uint32_t t = 0; t < ir::kElementaryCount; ++t) {
      ir::TypeId from(f);
      ir::TypeId to(t);
      FastConverter fast = fast_converter(types, from, types, to);
      Conversion rule = classify(types, from, types, to);
      if (fast == nullptr || rule == Conversion::kNone || rule == Conversion::kSame) continue;
      ++pairs;
      ir::Scalar scalar = types.scalar(from);
      for (uint64_t sample : samples) {
        if (types[from].kind == Kind::kBool && sample > 1) continue;
        uint32_t unused = 64 - 8 * ir::scalar_size(scalar);
        uint64_t bits = ir::is_signed(scalar)
                            ? integer(static_cast<int64_t>(sample << unused) >> unused)
                            : sample << unused >> unused;
        Converted slow = convert(types[from].kind, types[to].kind, bits);
        uint64_t out = 0;
        uint8_t source[8];
        std::memcpy(source, &bits, 8);
        size_t done = fast({source, 8, reinterpret_cast<uint8_t*>(&out), 1});
        std::string what = types.text(from) + " -> " + types.text(to) + " " + std::to_string(bits);
        if (done == 0) {
          bool nan = std::strstr(types.text(from).c_str(), "REAL") != nullptr;
          EXPECT_TRUE(slow.loss != nullptr || nan) << what;
          continue;
        }
        EXPECT_EQ(slow.loss, nullptr) << what;
        EXPECT_EQ(std::memcmp(&out, &slow.bits, ir::scalar_size(types.scalar(to))), 0) << what;
      }
    }
  }
  EXPECT_GT(pairs, 100u);
}

TEST(Conversion, no_rule_between_unlike_groups) {
  ir::TypeTable types;
  auto between = [&](Kind from, Kind to) {
    return classify(types, types.elementary(from), types, types.elementary(to));
  };
  EXPECT_EQ(between(Kind::kInt, Kind::kTime), Conversion::kNone);
  EXPECT_EQ(between(Kind::kReal, Kind::kBool), Conversion::kNone);
  EXPECT_EQ(between(Kind::kTod, Kind::kDate), Conversion::kNone);
  EXPECT_EQ(between(Kind::kChar, Kind::kInt), Conversion::kNone);
  EXPECT_EQ(classify(types, types.string(10), types, types.elementary(Kind::kInt)),
            Conversion::kNone);
}

ir::TypeId enumeration(ir::TypeTable& types, std::vector<ir::EnumLiteral> literals) {
  ir::Type type;
  type.kind = Kind::kEnum;
  type.name = "E";
  type.base = types.elementary(Kind::kInt);
  type.literals = std::move(literals);
  return types.declare(std::move(type));
}

TEST(Conversion, A14_enumeration_by_name) {  // case 10
  ir::TypeTable before;
  ir::TypeTable after;
  ir::TypeId from = enumeration(before, {{"Stop", 0}, {"Run", 1}, {"Old", 2}});
  ir::TypeId to = enumeration(after, {{"Stop", 0}, {"Warm", 1}, {"RUN", 2}});
  EXPECT_EQ(classify(before, from, after, to), Conversion::kMayLose);
  EXPECT_EQ(convert_scalar(before, from, after, to, 1).bits, 2u);
  EXPECT_EQ(convert_scalar(before, from, after, to, 1).loss, nullptr);
  EXPECT_TRUE(convert_scalar(before, from, after, to, 2).initialise);
  EXPECT_EQ(convert_scalar(before, from, after, after.elementary(Kind::kDint), 2).bits, 2u);
  EXPECT_TRUE(convert_scalar(before, before.elementary(Kind::kInt), after, to, 77).initialise);
}

TEST(Conversion, A14_subrange_clamps) {  // case 9
  ir::TypeTable types;
  ir::TypeId integers = types.elementary(Kind::kInt);
  ir::TypeId wide = types.subrange(integers, 0, 100);
  ir::TypeId narrow = types.subrange(integers, 0, 50);
  EXPECT_EQ(classify(types, wide, types, narrow), Conversion::kMayLose);
  EXPECT_EQ(classify(types, narrow, types, wide), Conversion::kSame);
  EXPECT_EQ(classify(types, narrow, types, integers), Conversion::kSame);
  Converted out = convert_scalar(types, wide, types, narrow, 80);
  EXPECT_EQ(out.bits, 50u);
  EXPECT_STREQ(out.loss, "saturates");
  EXPECT_EQ(convert_scalar(types, wide, types, narrow, 50).loss, nullptr);
}

TEST(Conversion, A14_strings) {  // case 7
  const uint8_t kText[] = {'a', 'b', 'c', 0, 'x'};
  uint8_t shorter[3] = {9, 9, 9};
  EXPECT_STREQ(convert_string(kText, 1, shorter, 1), "truncates");
  EXPECT_EQ(std::string(reinterpret_cast<char*>(shorter)), "ab");
  uint8_t longer[8];
  std::fill(std::begin(longer), std::end(longer), uint8_t{9});
  EXPECT_EQ(convert_string(kText, 1, longer, 1), nullptr);
  EXPECT_EQ(std::string(reinterpret_cast<char*>(longer)), "abc");
  EXPECT_EQ(longer[7], 0);
  uint8_t wide[10];
  EXPECT_EQ(convert_string(kText, 1, wide, 2), nullptr);
  EXPECT_EQ(wide[4], 'c');
  EXPECT_EQ(wide[5], 0);
  const uint8_t kWide[] = {'a', 0, 0xac, 0x20, 'b', 0, 0, 0};
  uint8_t narrow[8];
  EXPECT_STREQ(convert_string(kWide, 2, narrow, 1), "is replaced in part");
  EXPECT_EQ(std::string(reinterpret_cast<char*>(narrow)), "a?b");
}

}  // namespace
}  // namespace online_change
