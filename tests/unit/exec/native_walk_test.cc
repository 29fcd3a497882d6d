// Loops that walk over variables with pointers: machine code does what the interpreter does,
// wherever the pointers lead, and wherever fuel ends.
#include <gtest/gtest.h>

#include <cstdlib>
#include <random>

#include "tests/unit/exec/source_image.h"
#include "tests/unit/exec/stops.h"
#include "vm/native/make_function.h"
#include "vm/native/program.h"

namespace {

using sample::build;
using sample::Optimised;
using sample::stops;

std::string code_of(const ir::Image& image) { return vm::native::functions_text(image); }

void compare(const ir::Image& image, const std::string& source,
             std::initializer_list<uint64_t> slices) {
  constexpr uint64_t kMost = 600;  // loops that overwrite their own counter have no end
  for (const uint64_t slice : slices) {
    const auto expected = stops(image, {.tier = vm::Tier::kInterpreter}, slice, kMost);
    for (const uint32_t registers : {0u, 6u}) {
      const vm::TierOptions native{.tier = vm::Tier::kNative,
                                   .integer_registers = registers,
                                   .spill_seed = registers == 0 ? 0 : slice};
      const auto found = stops(image, native, slice, kMost);
      ASSERT_EQ(expected.size(), found.size()) << slice << source;
      for (size_t i = 0; i < found.size(); ++i) {
        ASSERT_EQ(expected[i], found[i]) << "stop " << i << ", slices of " << slice << source;
      }
    }
  }
}

// Variables of all kinds, pointers to all of them, and loops that move the pointers.
class Program {
 public:
  explicit Program(uint32_t seed) : random_(seed) {}

  std::string text() {
    const bool in_function = one_of(3) == 0;
    has_instances_ = !in_function;
    std::string body;
    const int loops = 1 + one_of(2);
    for (int i = 0; i < loops; ++i) body += pointers() + loop();
    const std::string own = R"(
  a : ARRAY[0..19] OF BYTE := [1, 2, 3, 4, 5, 6, 7, 8, 9, 10];
  p, q : POINTER TO BYTE;
  b : ARRAY[0..9] OF WORD := [10(16#1234)];
  w : POINTER TO WORD;
  x, y : INT;
  s : UDINT;
  one : BYTE := 77;
  cell : Cell;
  i, k : INT;
)";
    std::string out = R"(
TYPE Cell : STRUCT n : INT; next : POINTER TO BYTE; t : ARRAY[0..5] OF BYTE; END_STRUCT END_TYPE
TYPE Mixed : STRUCT n : INT; edge : R_TRIG; t : ARRAY[0..5] OF BYTE; END_STRUCT END_TYPE
VAR_GLOBAL g : ARRAY[0..15] OF BYTE; gx : DINT; gp : POINTER TO BYTE; END_VAR
FUNCTION_BLOCK Block VAR v : ARRAY[0..7] OF BYTE; u : UINT; inner : R_TRIG; END_VAR END_FUNCTION_BLOCK
)";
    if (in_function) {
      out +=
          "FUNCTION Walk : UDINT\nVAR" + own + "END_VAR\n" + body + "  Walk := s + TO_UDINT(x);\n";
      out += "END_FUNCTION\nPROGRAM Main VAR scans, r : UDINT; fb : Block; END_VAR\n";
      return out + "  scans := scans + 1; r := r * 3 + Walk();\nEND_PROGRAM\n";
    }
    out += "PROGRAM Main VAR" + own + "  fb : Block; mixed : Mixed; scans : UDINT;\nEND_VAR\n";
    return out + "  scans := scans + 1; mixed.edge(CLK := x > 3);\n" + body + "END_PROGRAM\n";
  }

 private:
  int one_of(int n) { return static_cast<int>(random_() % static_cast<uint32_t>(n)); }
  std::string number(int n) { return std::to_string(one_of(n)); }
  template <size_t N>
  std::string any(const char* const (&texts)[N]) {
    return texts[one_of(N)];
  }

  std::string place() {
    static constexpr const char* kUsual[] = {"ADR(a)", "ADR(b)", "ADR(g)", "ADR(a[3])", "ADR(a)"};
    static constexpr const char* kOdd[] = {"ADR(p)",
                                           "ADR(q)",
                                           "ADR(x)",
                                           "ADR(s)",
                                           "ADR(i)",
                                           "ADR(one)",
                                           "ADR(cell)",
                                           "0",
                                           "gp",
                                           "ADR(cell.t)",
                                           "ADR(g) - 1",
                                           "ADR(gx)",
                                           "ADR(w)",
                                           "q",
                                           "p",
                                           "ADR(a) + 20",
                                           "ADR(b) + SIZEOF(b)"};
    static constexpr const char* kInstances[] = {"ADR(fb)", "ADR(mixed)", "ADR(mixed.t)"};
    std::string at = one_of(4) == 0 ? any(kOdd) : any(kUsual);
    if (has_instances_ && one_of(12) == 0) at = any(kInstances);
    if (one_of(4) == 0) at += " + " + number(24);
    if (one_of(12) == 0) at += " - " + number(30);
    return at;
  }

  std::string pointers() {
    const std::string words = one_of(8) == 0 ? "ADR(one)" : place();
    std::string out = "  p := " + place() + "; q := " + place() + "; w := " + words + ";\n";
    if (one_of(4) == 0) out += "  gp := " + place() + ";\n";
    return out;
  }

  std::string value() {
    static constexpr const char* kValues[] = {"p^",         "q^",   "p^",   "TO_BYTE(w^)",
                                              "p[i]",       "q[k]", "a[3]", "g[2]",
                                              "TO_BYTE(x)", "one",  "gp^"};
    return any(kValues);
  }

  std::string condition() {
    static constexpr const char* kConditions[] = {
        "p^ = 3", "i > 4", "p < q", "s > 1000", "x = y", "p = ADR(a[7])", "q^ <> one", "p[1] < 9"};
    return any(kConditions);
  }

  std::string statement(int depth) {
    switch (one_of(16)) {
      case 0:
      case 1:
        return "s := s * 3 + " + value() + "; ";
      case 2:
      case 3:
        return "p := p + 1; ";
      case 4:
        return "q := q + " + number(4) + "; ";
      case 5:
        return "w := w + 2; ";
      case 6:
        return one_of(2) == 0 ? "p := p - 1; " : "p := p + x; ";
      case 7:
        return "q^ := " + value() + "; ";
      case 8:
        return "p^ := " + value() + "; ";
      case 9:
        return "w^ := TO_WORD(s); ";
      case 10:
        return "x := x + TO_INT(" + value() + "); ";
      case 11:
        return one_of(3) == 0 ? "y := y + 1; gx := gx + y; " : "one := one XOR " + value() + "; ";
      case 12:
        if (one_of(3) != 0) return "k := (k + 1) MOD 9; ";
        return one_of(2) == 0 ? "gp := p; " : "q := p; ";
      case 13:
        return "a[k] := " + value() + "; ";
      default:
        break;
    }
    if (depth > 1) return "s := s + 1; ";
    std::string out = "IF " + condition() + " THEN ";
    if (depth == 0 && one_of(4) == 0) return out + "EXIT; END_IF; ";
    out += statement(depth + 1);
    if (one_of(2) == 0) out += "ELSE " + statement(depth + 1);
    return out + "END_IF; ";
  }

  // Turns that all go one way: several are done at once.
  std::string straight() {
    static constexpr const char* kDone[] = {"s := s * 3 + p^; ",    "q^ := p^; q := q + 1; ",
                                            "s := s + p[1]; ",      "p^ := one; ",
                                            "w^ := TO_WORD(s); ",   "w := w + 2; ",
                                            "x := x + p[i] + w^; ", "a[i] := b[i] + q^; "};
    static constexpr const char* kWhile[] = {"p < q", "p <= q", "q > p", "q >= p"};
    std::string body;
    for (int n = 1 + one_of(3); n > 0; --n) body += any(kDone);
    const std::string step = "p := p + " + std::to_string(1 + one_of(3)) + "; ";
    if (one_of(2) == 0)
      return std::string("  WHILE ") + any(kWhile) + " DO " + body + step + "END_WHILE;\n";
    body += one_of(2) == 0 ? step : "";
    const std::string last = one_of(2) == 0 ? number(30) : "k + " + number(30);
    return "  FOR i := " + number(4) + " TO " + last + " DO " + body + "END_FOR;\n";
  }

  std::string loop() {
    if (one_of(3) == 0) return straight();
    std::string body;
    const int count = 1 + one_of(5);
    for (int n = 0; n < count; ++n) body += statement(0);
    switch (one_of(4)) {
      case 0:
        return "  FOR i := 0 TO " + number(20) + " DO " + body + "END_FOR;\n";
      case 1:
        return "  i := 0; WHILE p < ADR(a) + " + number(24) + " AND i < 30 DO i := i + 1; " + body +
               "p := p + 1; END_WHILE;\n";
      case 2:
        return "  i := 0; WHILE p <> q AND i < 25 DO " + body + "i := i + 1; END_WHILE;\n";
      default:
        return "  i := 0; REPEAT " + body + "i := i + 1; UNTIL i > " + number(20) +
               " OR p >= q END_REPEAT;\n";
    }
  }

  std::mt19937 random_;
  bool has_instances_ = false;
};

void expect_same(const std::string& source) {
  for (const Optimised optimised : {Optimised::kNo, Optimised::kYes}) {
    compare(build(source, nullptr, optimised), source, {1, 2, 5, 599, 5'000});
  }
}

// ... and a loop of it walks, where machine code follows pointers.
void expect_walked(const std::string& source) {
#if defined(__x86_64__)
  for (const Optimised optimised : {Optimised::kNo, Optimised::kYes}) {
    const std::string code = code_of(build(source, nullptr, optimised));
    EXPECT_NE(code.find(" := reach.8"), std::string::npos) << source;
  }
#endif
  expect_same(source);
}

TEST(NativeWalk, AByteThatWasNotAskedForInEveryTurnIsNotThere) {
  if (!vm::native::is_available()) GTEST_SKIP() << "no native tier on this machine";
  for (const char* const condition : {"i < 4", "i > 4", "i MOD 2 = 0", "x < 0"}) {
    expect_walked(std::string(R"(
PROGRAM Main VAR a, b : ARRAY[0..5] OF BYTE := [6(9)]; p : POINTER TO BYTE; i, x : INT; END_VAR
  p := ADR(a);
  FOR i := 0 TO 8 DO IF )") +
                  condition + R"( THEN x := x * 3 + p^; END_IF; p := p + 1; END_FOR;
  FOR i := 0 TO 8 DO p := p - 1; END_FOR;
  x := x + p^;
END_PROGRAM)");
  }
}

TEST(NativeWalk, WholeInstancesAndWhatHasSlotsAreLeftToTheInterpreter) {
  if (!vm::native::is_available()) GTEST_SKIP() << "no native tier on this machine";
  const std::string types = R"(
FUNCTION_BLOCK Plain VAR v : ARRAY[0..7] OF BYTE := [8(3)]; END_VAR END_FUNCTION_BLOCK
TYPE Mixed : STRUCT n : INT := 5; edge : R_TRIG; t : ARRAY[0..5] OF BYTE; END_STRUCT END_TYPE)";
  for (const char* const place : {"ADR(plain)", "ADR(mixed)", "ADR(mixed.t)", "ADR(mixed.n)"}) {
    expect_walked(types + R"(
PROGRAM Main VAR plain : Plain; mixed : Mixed; p : POINTER TO BYTE; i, x : INT; END_VAR
  mixed.edge(CLK := TRUE);
  p := )" + place +
                  R"(;
  FOR i := 0 TO 7 DO x := x * 3 + p^; p := p + 1; END_FOR;
  p := p - 1;
  x := x + p^;
END_PROGRAM)");
  }
}

TEST(NativeWalk, WordsOfAByteAreNotThere) {
  if (!vm::native::is_available()) GTEST_SKIP() << "no native tier on this machine";
  expect_walked(R"(
PROGRAM Main VAR one, two : BYTE; w : POINTER TO WORD; i, x : INT; END_VAR
  w := ADR(one);
  FOR i := 0 TO 7 DO x := x + WORD_TO_INT(w^); END_FOR;
END_PROGRAM)");
}

TEST(NativeWalk, AReferenceToTheOwnInstanceChangesWhatTheLoopNames) {
  if (!vm::native::is_available()) GTEST_SKIP() << "no native tier on this machine";
  for (const char* const other : {"", "x := x + p^; p := p + 1; "}) {
    expect_same(std::string(R"(
FUNCTION_BLOCK Fb
VAR_INPUT count : DINT; r : REF_TO Fb; END_VAR
VAR s, x : DINT; i : INT; a : ARRAY[0..19] OF BYTE := [20(3)]; p : POINTER TO BYTE; END_VAR
  p := ADR(a);
  FOR i := 0 TO 9 DO r^.count := r^.count + 1; s := s * 3 + count; count := count + 2; )") +
                other + R"(END_FOR;
END_FUNCTION_BLOCK
PROGRAM Main VAR fb : Fb; END_VAR fb(r := REF(fb)); END_PROGRAM)");
  }
}

TEST(NativeWalk, APointerThatBecomesAnotherOneIsFollowedOneByOne) {
  if (!vm::native::is_available()) GTEST_SKIP() << "no native tier on this machine";
  expect_same(R"(
PROGRAM Main VAR a, b, c : ARRAY[0..9] OF BYTE := [10(3)]; i, x : INT;
  p, q, r, t : POINTER TO BYTE; END_VAR
  p := ADR(a); q := ADR(b); r := ADR(c);
  FOR i := 0 TO 8 DO x := x * 3 + p^; p^ := INT_TO_BYTE(i); t := p; p := q; q := r; r := t; END_FOR;
END_PROGRAM)");
}

uint32_t asked(const char* name, uint32_t otherwise) {
  const char* const text = std::getenv(name);
  return text == nullptr ? otherwise : static_cast<uint32_t>(std::strtoul(text, nullptr, 10));
}

// More of them: STC_WALKS=100000 STC_WALKS_SEED=7.
TEST(NativeWalk, RandomLoopsDoWhatTheInterpreterDoes) {
  if (!vm::native::is_available()) GTEST_SKIP() << "no native tier on this machine";
  const uint32_t count = asked("STC_WALKS", 300);
  const uint32_t seed = asked("STC_WALKS_SEED", 1);
  uint32_t walks = 0;
  for (uint32_t i = 0; i < count; ++i) {
    const std::string source = Program(seed * 1000003 + i).text();
    for (const Optimised optimised : {Optimised::kNo, Optimised::kYes}) {
      const ir::Image image = build(source, nullptr, optimised);
      ASSERT_FALSE(image.pous.empty());
      if (code_of(image).find(" := reach.8") != std::string::npos) ++walks;
      compare(image, source, {1, 3, 7, 599, 5'000});
      if (testing::Test::HasFatalFailure()) return;
    }
  }
#if defined(__x86_64__)
  RecordProperty("walks", static_cast<int>(walks));
  EXPECT_GT(walks, count / 2) << "most of them have a loop that walks";
#endif
}

}  // namespace
