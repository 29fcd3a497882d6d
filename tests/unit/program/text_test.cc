#include "ir/program/text.h"

#include <gtest/gtest.h>

#include <random>

#include "ir/program/ops.h"
#include "tests/unit/program/sample.h"

namespace ir {
namespace {

std::string reason(std::string_view text) {
  const base::Result<Program> program = parse_program(text);
  return program.ok() ? "parsed" : program.error().text;
}

TEST(IrText, PrintsWhatItParsed) { EXPECT_EQ(print(parse_ok(kSample)), kSample); }

TEST(IrText, SampleIsAVerifiedProgram) { verified(kSample); }

TEST(IrText, KeepsEveryFieldOfTheSample) {
  const Program program = parse_ok(kSample);
  EXPECT_EQ(program.name, "Line");
  EXPECT_EQ(program.schedule, Schedule::kRunFirst);
  EXPECT_EQ(program.tasks[1].policy.overrun, Overrun::kLengthen);
  const Pou& limit = program.pous[program.find_pou("LIMIT").index];
  EXPECT_EQ(limit.file, "a b.st");
  EXPECT_EQ(limit.line, 7u);
  EXPECT_EQ(limit.content.identity[31], 1);
  EXPECT_EQ(limit.locals[2].kind, LocalKind::kInOut);
  EXPECT_EQ(limit.values[2].scalar, Scalar::kBool);
  EXPECT_EQ(limit.blocks[0].insts[1].line, 9u);
  EXPECT_EQ(program.types[program.globals].members[2].address,
            (DirectAddress{DirectArea::kInput, 1, 1}));
  EXPECT_EQ(program.constants[ConstId(1)].elements[1].count, 3u);
  EXPECT_EQ(program.tasks[0].watchdog_ns, 5'000'000);
  EXPECT_EQ(program.pou_of_instance_type(program.instances[0].type), program.find_pou("Main"));
}

TEST(IrText, PrintsOnePou) {
  const Program program = parse_ok(kSample);
  const std::string text = print(program, program.pous[1]);
  EXPECT_TRUE(text.starts_with("pou function_block Counter self Counter\n  b0:\n"));
  EXPECT_NE(std::string(kSample).find(text), std::string::npos);
}

TEST(IrText, InternsAnonymousTypesLikeTheFrontEnd) {
  Program program = parse_ok(kSample);
  EXPECT_EQ(program.types.string(10), TypeId(25));
  EXPECT_EQ(program.types.array(TypeId(31), {{0, 1}}), TypeId(33));
}

TEST(IrText, NumbersWhatNamesDoNotTellApart) {
  const std::string text = R"(program P
type %25 Same = globals
  member global a : %26
  member global A : %26
type %26 same = struct
  member local '' : INT
globals %25
task T period 1 priority 0
)";
  const Program program = parse_ok(text);
  EXPECT_EQ(print(program), text);
  EXPECT_EQ(program.types[TypeId(26)].name, "same");
}

TEST(IrText, IgnoresCommentsAndIndentation) {
  std::string loose = "// first\n";
  for (const char c : kSample) {
    loose += c == '\n' ? std::string("  // 'x\n\n\t") : std::string(1, c);
  }
  EXPECT_EQ(print(parse_ok(loose)), kSample);
}

TEST(IrText, SaysLineAndReason) {
  EXPECT_EQ(reason(""), "IR text has no line `globals TYPE`");
  EXPECT_EQ(reason("program P\nprogramme"),
            "IR text, line 2: expected a declaration, found programme");
  EXPECT_EQ(reason("type A = struct\n member local x : Y"), "IR text, line 2: there is no type Y");
  EXPECT_EQ(reason("type %7 = struct"),
            "IR text, line 1: types are numbered in order; this is %25");
  EXPECT_EQ(reason("type A = string 40000"),
            "IR text, line 1: expected a number up to 32767, found '40000'");
  EXPECT_EQ(reason("const #1 = 5"), "IR text, line 1: constants are numbered in order; this is #0");
  EXPECT_EQ(reason("schedule never"), "IR text, line 1: unknown schedule");
  EXPECT_EQ(reason("globals INT\npou function F\nb0:\nv0 = foo i16"),
            "IR text, line 4: unknown word 'foo'");
  EXPECT_EQ(reason("globals INT\npou function F\nb0:\nv0 = load i16 local.x"),
            "IR text, line 4: there is no local variable x");
  EXPECT_EQ(reason("globals INT\npou function F\nb0:\nv4294967294 = const i16 1"),
            "IR text, line 4: value number 4294967294 is too large");
  EXPECT_EQ(reason("globals INT\npou function F\nb1:"),
            "IR text, line 3: blocks are numbered in order; this is b0");
}

// Any bytes: an error or a program, never anything else; and what parses prints
// to a text that parses to the same text.
class MutatedText : public ::testing::TestWithParam<uint32_t> {};

std::string mutate(std::string text, std::mt19937& random) {
  const auto below = [&random](size_t limit) { return random() % limit; };
  for (size_t i = 1 + below(4); i-- > 0 && !text.empty();) {
    const size_t at = below(text.size());
    const size_t length = std::min<size_t>(below(12), text.size() - at);
    switch (below(5)) {
      case 0:
        text[at] = static_cast<char>(random());
        break;
      case 1:
        text.erase(at, length);
        break;
      case 2:
        text.insert(at, text.substr(below(text.size()), below(40)));
        break;
      case 3:
        text[at] = "0123456789#%v'.[]^!@()"[below(22)];
        break;
      default:
        std::swap(text[at], text[below(text.size())]);
    }
  }
  return text;
}

TEST_P(MutatedText, NeverCrashesParserPrinterOrVerifier) {
  std::mt19937 random(GetParam());
  size_t parsed = 0;
  for (int round = 0; round < 400; ++round) {
    const base::Result<Program> program = parse_program(mutate(std::string(kSample), random));
    if (!program.ok()) {
      EXPECT_FALSE(program.error().text.empty());
      continue;
    }
    ++parsed;
    const std::string text = print(*program);
    const base::Result<Program> again = parse_program(text);
    ASSERT_TRUE(again.ok()) << again.error().text << "\n" << text;
    EXPECT_EQ(print(*again), text);
    (void)verify(*program).ok();
  }
  EXPECT_GT(parsed, 0u);
}

INSTANTIATE_TEST_SUITE_P(Seeds, MutatedText, ::testing::Range(0u, 6u));

TEST(IrText, SurvivesRandomBytes) {
  std::mt19937 random(5);
  for (int round = 0; round < 2000; ++round) {
    std::string bytes(random() % 200, ' ');
    for (char& c : bytes) {
      c = static_cast<char>(random());
    }
    EXPECT_FALSE(parse_program(bytes).ok());
  }
}

TEST(OpTable, KnowsTerminators) {
  EXPECT_EQ(op_name(Op::kCallInstance), "call_instance");
  EXPECT_EQ(op_operand_count(Op::kSelect), 3);
  EXPECT_FALSE(op_has_result(Op::kStore));
  EXPECT_TRUE(is_terminator(Op::kTrap));
  EXPECT_FALSE(is_terminator(Op::kTaskTime));
  EXPECT_EQ(static_cast<uint32_t>(Op::kEndTry) + 1, kOpCount);
  EXPECT_STREQ(trap_name(TrapKind::kForStep), "for-step");
}

}  // namespace
}  // namespace ir
