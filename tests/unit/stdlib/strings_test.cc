#include "tests/unit/stdlib/native_call.h"

namespace stdlib::testing {
namespace {

// The same cases for STRING (unit 1) and WSTRING (unit 2).
struct Kind {
  uint32_t unit;
  NativeId len, left, right, mid, concat, insert, erase, replace, find, compare;
};

const Kind kStringKind = {1,
                          NativeId::kLenS,
                          NativeId::kLeftS,
                          NativeId::kRightS,
                          NativeId::kMidS,
                          NativeId::kConcatS,
                          NativeId::kInsertS,
                          NativeId::kDeleteS,
                          NativeId::kReplaceS,
                          NativeId::kFindS,
                          NativeId::kCompareS};
const Kind kWstringKind = {2,
                           NativeId::kLenW,
                           NativeId::kLeftW,
                           NativeId::kRightW,
                           NativeId::kMidW,
                           NativeId::kConcatW,
                           NativeId::kInsertW,
                           NativeId::kDeleteW,
                           NativeId::kReplaceW,
                           NativeId::kFindW,
                           NativeId::kCompareW};

class NativeStrings : public ::testing::TestWithParam<const Kind*> {
 protected:
  const Kind& kind() const { return *GetParam(); }
  Text text(const std::string& value, uint32_t capacity = 20) {
    return Text(capacity, value, kind().unit);
  }
  // A function with a string result, one or two string arguments, numbers.
  std::string result(NativeId id, std::vector<std::string> strings, std::vector<int64_t> numbers,
                     uint32_t capacity = 20) {
    Text destination(capacity, std::string(capacity, '#'), kind().unit);
    std::vector<Text> sources;
    for (const std::string& value : strings) {
      sources.push_back(text(value));
    }
    std::vector<NativeArg> args = {destination.arg()};
    for (Text& source : sources) {
      args.push_back(source.arg());
    }
    for (const int64_t value : numbers) {
      args.push_back(number(value));
    }
    call(id, args);
    return destination.value();
  }
  int64_t relation(NativeId id, const std::string& a, const std::string& b) {
    Text first = text(a);
    Text second = text(b);
    return static_cast<int64_t>(call(id, {first.arg(), second.arg()}));
  }
};

INSTANTIATE_TEST_SUITE_P(Both, NativeStrings, ::testing::Values(&kStringKind, &kWstringKind),
                         [](const auto& kind) {
                           return kind.param->unit == 1 ? "String" : "Wstring";
                         });

constexpr int64_t kLowest = INT64_MIN;
constexpr int64_t kHighest = INT64_MAX;

TEST_P(NativeStrings, LenStopsAtTheCapacityWithoutNul) {
  Text full = text("abcdef", 3);  // 'd' stands where the NUL belongs
  EXPECT_EQ(call(kind().len, {full.arg()}), 3u);
  Text empty = text("", 0);
  EXPECT_EQ(call(kind().len, {empty.arg()}), 0u);
}

TEST_P(NativeStrings, LeftClamps) {
  EXPECT_EQ(result(kind().left, {"bottle"}, {3}), "bot");
  EXPECT_EQ(result(kind().left, {"bottle"}, {0}), "");
  EXPECT_EQ(result(kind().left, {"bottle"}, {kLowest}), "");
  EXPECT_EQ(result(kind().left, {"bottle"}, {kHighest}), "bottle");
}

TEST_P(NativeStrings, RightClamps) {
  EXPECT_EQ(result(kind().right, {"bottle"}, {3}), "tle");
  EXPECT_EQ(result(kind().right, {"bottle"}, {-1}), "");
  EXPECT_EQ(result(kind().right, {"bottle"}, {kHighest}), "bottle");
}

TEST_P(NativeStrings, MidTakesLengthThenPosition) {
  EXPECT_EQ(result(kind().mid, {"bottle"}, {2, 3}), "tt");
  EXPECT_EQ(result(kind().mid, {"bottle"}, {2, 0}), "bo");
  EXPECT_EQ(result(kind().mid, {"bottle"}, {2, kLowest}), "bo");
  EXPECT_EQ(result(kind().mid, {"bottle"}, {kHighest, 6}), "e");
  EXPECT_EQ(result(kind().mid, {"bottle"}, {1, 7}), "");
  EXPECT_EQ(result(kind().mid, {"bottle"}, {1, kHighest}), "");
}

TEST_P(NativeStrings, ConcatTruncates) {
  EXPECT_EQ(result(kind().concat, {"cap", "per"}, {}), "capper");
  EXPECT_EQ(result(kind().concat, {"cap", "per"}, {}, 4), "capp");
  EXPECT_EQ(result(kind().concat, {"cap", "per"}, {}, 2), "ca");
  EXPECT_EQ(result(kind().concat, {"cap", "per"}, {}, 0), "");
  EXPECT_EQ(result(kind().concat, {"", ""}, {}), "");
}

TEST_P(NativeStrings, ThreeTextsAtOnceAreCutAsTwoAndOne) {
  const NativeId three = kind().unit == 1 ? NativeId::kConcat3S : NativeId::kConcat3W;
  for (uint32_t capacity = 0; capacity < 10; ++capacity) {
    const std::string two = result(kind().concat, {"abc", "d"}, {}, capacity);
    EXPECT_EQ(result(three, {"abc", "d", "efg"}, {}, capacity),
              result(kind().concat, {two, "efg"}, {}, capacity));
  }
  EXPECT_EQ(result(three, {"", "", ""}, {}), "");
}

TEST_P(NativeStrings, InsertBehindPosition) {
  EXPECT_EQ(result(kind().insert, {"fler", "il"}, {1}), "filler");
  EXPECT_EQ(result(kind().insert, {"ler", "fil"}, {0}), "filler");
  EXPECT_EQ(result(kind().insert, {"ler", "fil"}, {kLowest}), "filler");
  EXPECT_EQ(result(kind().insert, {"fil", "ler"}, {kHighest}), "filler");
  EXPECT_EQ(result(kind().insert, {"fler", "il"}, {1}, 4), "fill");
}

TEST_P(NativeStrings, DeleteTakesLengthThenPosition) {
  EXPECT_EQ(result(kind().erase, {"filler"}, {2, 3}), "fier");
  EXPECT_EQ(result(kind().erase, {"filler"}, {kHighest, 1}), "");
  EXPECT_EQ(result(kind().erase, {"filler"}, {1, 0}), "iller");
  EXPECT_EQ(result(kind().erase, {"filler"}, {1, 7}), "filler");
  EXPECT_EQ(result(kind().erase, {"filler"}, {kLowest, 2}), "filler");
}

TEST_P(NativeStrings, ReplaceTakesLengthThenPosition) {
  EXPECT_EQ(result(kind().replace, {"filler", "ck"}, {2, 3}), "ficker");
  EXPECT_EQ(result(kind().replace, {"filler", "s"}, {0, 7}), "fillers");
  EXPECT_EQ(result(kind().replace, {"filler", "s"}, {kHighest, kHighest}), "fillers");
  EXPECT_EQ(result(kind().replace, {"filler", "X"}, {kHighest, kLowest}), "X");
  EXPECT_EQ(result(kind().replace, {"filler", "overlong"}, {1, 2}, 5), "fover");
}

TEST_P(NativeStrings, FindCountsFromOne) {
  EXPECT_EQ(relation(kind().find, "conveyor", "vey"), 4);
  EXPECT_EQ(relation(kind().find, "conveyor", "conveyor"), 1);
  EXPECT_EQ(relation(kind().find, "conveyor", "conveyors"), 0);
  EXPECT_EQ(relation(kind().find, "conveyor", "x"), 0);
  EXPECT_EQ(relation(kind().find, "conveyor", ""), 0);
  EXPECT_EQ(relation(kind().find, "", ""), 0);
}

TEST_P(NativeStrings, CompareByCodeUnitThenLength) {
  EXPECT_EQ(relation(kind().compare, "abc", "abc"), 0);
  EXPECT_EQ(relation(kind().compare, "abc", "abd"), -1);
  EXPECT_EQ(relation(kind().compare, "b", "abc"), 1);
  EXPECT_EQ(relation(kind().compare, "ab", "abc"), -1);
  EXPECT_EQ(relation(kind().compare, "\xFF", "a"), 1);
  EXPECT_EQ(relation(kind().compare, "", ""), 0);
}

TEST_P(NativeStrings, SourceWithoutNulIsReadUpToItsCapacity) {
  Text destination = text("", 10);
  Text full = text("abcdef", 3);
  call(kind().concat, {destination.arg(), full.arg(), full.arg()});
  EXPECT_EQ(destination.value(), "abcabc");
  EXPECT_EQ(static_cast<int64_t>(call(kind().find, {full.arg(), full.arg()})), 1);
}

TEST_P(NativeStrings, LongTextsAreAsShortOnes) {
  std::string line;
  for (int i = 0; i < 60; ++i) {
    line.push_back(static_cast<char>('a' + i % 26));
    Text to(130, std::string(130, '#'), kind().unit);
    Text from(60, line, kind().unit);
    call(kind().concat, {to.arg(), from.arg(), from.arg()});
    EXPECT_EQ(to.value(), line + line);
  }
  Text text(60, line, kind().unit);
  EXPECT_EQ(call(kind().len, {text.arg()}), 60u);
  Text last(20, "fgh", kind().unit);  // 5, 31 and 57 are where it is
  EXPECT_EQ(call(kind().find, {text.arg(), last.arg()}), 6u);
  Text other(60, line, kind().unit);
  EXPECT_EQ(call(kind().compare, {text.arg(), other.arg()}), 0u);
  other.set_unit(58, 'z');
  EXPECT_EQ(static_cast<int64_t>(call(kind().compare, {text.arg(), other.arg()})), -1);
}

TEST(NativeCharset, Latin1BothWays) {
  Text narrow(10, "caf\xE9");
  Text wide(10, "", 2);
  call(NativeId::kStringToWstring, {wide.arg(), narrow.arg()});
  EXPECT_EQ(wide.value(), "caf\xE9");
  wide.set_unit(0, 0x20AC);  // the euro sign is not in Latin-1
  Text back(10);
  call(NativeId::kWstringToString, {back.arg(), wide.arg()});
  EXPECT_EQ(back.value(), "?af\xE9");
}

TEST(NativeCharset, WideUnitsCompareByValueNotByByte) {
  Text small(4, "", 2);
  Text large(4, "", 2);
  small.set_unit(0, 0x00FF);
  large.set_unit(0, 0x0100);
  EXPECT_EQ(static_cast<int64_t>(call(NativeId::kCompareW, {small.arg(), large.arg()})), -1);
}

TEST(NativeCharacters, BehindTheEndThereAreZerosAndWritingFillsWithBlanks) {
  const struct {
    uint32_t unit;
    NativeId get, set;
  } kinds[] = {{1, NativeId::kCharacterS, NativeId::kSetCharacterS},
               {2, NativeId::kCharacterW, NativeId::kSetCharacterW}};
  for (const auto& kind : kinds) {
    Text text(6, "abc", kind.unit);
    EXPECT_EQ(call(kind.get, {text.arg(), number(2)}), uint64_t{'c'});
    EXPECT_EQ(call(kind.get, {text.arg(), number(3)}), 0u);
    EXPECT_EQ(call(kind.get, {text.arg(), number(-1)}), 0u);
    call(kind.set, {text.arg(), number(1), number('X')});
    call(kind.set, {text.arg(), number(5), number('Z')});
    EXPECT_EQ(text.value(), "aXc  Z");
    call(kind.set, {text.arg(), number(6), number('!')});
    EXPECT_EQ(text.value(), "aXc  Z");
    call(kind.set, {text.arg(), number(1), number(0)});
    EXPECT_EQ(text.value(), "a");
  }
}

}  // namespace
}  // namespace stdlib::testing
