// Versions of POUs without their stores to forced variables: who writes, what becomes of the code,
// and what of the rest of it.
#include "vm/load/forced_code.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "ir/bytecode/pou_version.h"
#include "tests/unit/bytecode/sample_image.h"
#include "tests/unit/exec/machine.h"
#include "tests/unit/exec/source_image.h"
#include "vm/native/program.h"

namespace {

using namespace sample;
using How = vm::Writer::How;

vm::Variable variable(const ir::Image& image, const std::string& path) {
  const auto symbol = ir::find_symbol(image, path);
  EXPECT_TRUE(symbol.ok()) << path;
  return {symbol->data, image.layouts[symbol->type].size, symbol->type};
}

// "Main kOnly": each POU that writes the variable, and how.
std::string writers(const ir::Image& image, const std::string& path) {
  constexpr const char* kNames[] = {"only", "shared", "part", "indexed", "text", "address"};
  const vm::Variable one = variable(image, path);
  std::string out;
  for (const vm::Writer& writer : vm::find_writers(image, {&one, 1})) {
    out += (out.empty() ? "" : ", ") + image.pous[writer.pou].name + " " +
           kNames[static_cast<size_t>(writer.how)];
  }
  return out;
}

constexpr const char* kProgram = R"(
TYPE Point : STRUCT x, y : INT; END_STRUCT END_TYPE
TYPE Both : UNION whole : DWORD; low : WORD; END_UNION END_TYPE
VAR_GLOBAL
  g, h, unwritten : INT; p, q : Point; text, other : STRING[9]; list : ARRAY[0..3] OF INT;
  far : ARRAY[0..40000] OF LINT; last : INT; both : Both; taken, aside, bound, elsewhere : INT; r : REF_TO INT;
END_VAR
FUNCTION Up : INT VAR_IN_OUT v : INT; END_VAR v := v + 1; Up := v; END_FUNCTION
FUNCTION Grow : LREAL VAR_IN_OUT v : LREAL; END_VAR v := v + 1.0; Grow := v; END_FUNCTION
FUNCTION_BLOCK One VAR_INPUT in : INT; END_VAR VAR_OUTPUT out : INT; END_VAR VAR inner : INT; END_VAR
  METHOD Set inner := 5; END_METHOD
  out := in;
END_FUNCTION_BLOCK
FUNCTION_BLOCK Many VAR_INPUT in : INT; END_VAR VAR_OUTPUT out : INT; END_VAR out := in; END_FUNCTION_BLOCK
FUNCTION_BLOCK Base VAR kept : INT; END_VAR kept := kept + 1; END_FUNCTION_BLOCK
FUNCTION_BLOCK Derived EXTENDS Base VAR more : INT; END_VAR SUPER^(); more := kept; END_FUNCTION_BLOCK
PROGRAM Main VAR one : One; many : ARRAY[0..2] OF Many; d : Derived; i : INT; l : LREAL; END_VAR
  g := g + 1;
  p := q; q.x := 3;
  text := 'abc';
  other := CONCAT(text, text);
  list[i] := 4;
  far[40000] := 1; last := 2;
  both.whole := 5;
  r := REF(taken); r^ := 6; aside := aside + 1;
  bound := bound + Up(bound);
  l := Grow(l); elsewhere := elsewhere + 1;
  one(in := 3); one.Set(); d();
  many[1](in := 4); many[i](in := 5);
END_PROGRAM
PROGRAM Second h := h + g; END_PROGRAM)";

TEST(Forcing, WritersOfAVariableAreFound) {
  const ir::Image image = build(kProgram);
  EXPECT_EQ(writers(image, "unwritten"), "");
  EXPECT_EQ(writers(image, "g"), "Main only");
  EXPECT_EQ(writers(image, "h"), "Second only");
  EXPECT_EQ(writers(image, "p.x"), "Main part");
  EXPECT_EQ(writers(image, "q.x"), "Main only");
  EXPECT_EQ(writers(image, "q.y"), "");
  EXPECT_EQ(writers(image, "text"), "Main only");
  EXPECT_EQ(writers(image, "list[2]"), "Main indexed");
  EXPECT_EQ(writers(image, "last"), "Main only") << "beyond what a near operand reaches";
  EXPECT_EQ(writers(image, "both.low"), "Main part");
  EXPECT_EQ(writers(image, "both.whole"), "Main only");
  EXPECT_EQ(writers(image, "taken"), "Main address");
  EXPECT_EQ(writers(image, "aside"), "Main only") << "nobody takes its address";
  EXPECT_EQ(writers(image, "bound"), "Up address, Main only");
  EXPECT_EQ(writers(image, "elsewhere"), "Main only") << "no VAR_IN_OUT of its type is written";
  EXPECT_EQ(writers(image, "Main.one.in"), "Main only");
  EXPECT_EQ(writers(image, "Main.one.out"), "One only");
  EXPECT_EQ(writers(image, "Main.one.inner"), "One.Set only");
  EXPECT_EQ(writers(image, "Main.many[1].out"), "Many shared");
  EXPECT_EQ(writers(image, "Main.many[1].in"), "Main only, Main indexed");
  EXPECT_EQ(writers(image, "Main.d.kept"), "Base only") << "the base's code runs for one instance";
  EXPECT_EQ(writers(image, "Main.d.more"), "Derived only");
}

// Each of many variables, in whatever order they are asked for, has the writers that it has alone.
TEST(Forcing, WritersOfManyVariables) {
  const ir::Image image = build(kProgram);
  std::vector<std::string> paths = {"Main.many[1].out", "g",   "Main.one.inner", "last",
                                    "Main.many[2].in",  "p.x", "Main.d.kept",    "Main.one.out",
                                    "unwritten",        "h",   "Main.i",         "Main.many[0].in"};
  std::vector<vm::Variable> variables;
  for (const std::string& path : paths) variables.push_back(variable(image, path));
  std::vector<std::vector<vm::Writer>> found(paths.size());
  for (const vm::Writer& writer : vm::find_writers(image, variables)) {
    found[writer.variable].push_back(writer);
  }
  for (size_t i = 0; i < paths.size(); ++i) {
    const std::vector<vm::Writer> alone = vm::find_writers(image, {&variables[i], 1});
    const auto same = [](const vm::Writer& a, const vm::Writer& b) {
      return a.pou == b.pou && a.unit == b.unit && a.how == b.how;
    };
    EXPECT_TRUE(std::ranges::equal(found[i], alone, same)) << paths[i];
  }
}

// A slot holds the addresses of two texts in turn, and the longer one's is made in front of a
// branch: the store behind it reaches as far as that text, not as the first one.
TEST(Forcing, AnAddressOfTheBlockBefore) {
  ir::Image image = build(R"(
TYPE U : UNION text : STRING[40]; bytes : ARRAY[0..40] OF BYTE; END_UNION END_TYPE
PROGRAM Main VAR short : STRING[3]; u : U; on : BOOL; n : INT; END_VAR
  short := 'abc';
  IF on THEN n := 1; END_IF
  u.text := 'a text of some length';
END_PROGRAM)");
  ir::LinkedPou& main = image.pous[0];
  const auto begin = image.code.begin() + main.first_unit;
  const auto end = begin + main.unit_count;
  const auto is = [](Opcode opcode) {
    return [opcode](const ir::Unit& unit) { return unit.opcode() == opcode; };
  };
  const auto branch = std::find_if(begin, end, is(Opcode::JF));
  const auto address = std::find_if(branch, end, is(Opcode::STR));
  ASSERT_EQ(main.merges.size(), 1u);
  ASSERT_EQ(main.merges[0].unit, static_cast<uint32_t>(address - begin));
  ASSERT_EQ(address->a, std::find_if(begin, end, is(Opcode::STR))->a) << "the same slot";
  for (uint32_t i = 0; i < main.slots.size(); ++i) {
    if (main.slots[i].offset == address->a)
      main.merges[0].slots.push_back(static_cast<uint16_t>(i));
  }
  std::sort(main.merges[0].slots.begin(), main.merges[0].slots.end());
  main.merges[0].unit += 2;
  std::rotate(branch, address, address + 2);
  const auto verified = ir::verify(ir::encode(image));
  ASSERT_TRUE(verified.ok()) << verified.error().text;
  EXPECT_EQ(writers(image, "Main.u.bytes[20]"), "Main indexed");
  EXPECT_EQ(writers(image, "Main.on"), "");
}

// Each kind of store that can be left out: what stands for it passes the verifier.
TEST(Forcing, WhatStandsForAStoreIsVerified) {
  const Code ret = op(Opcode::RET);
  const Code lea =
      ext(Opcode::LEA, F(kAddrInt), S(0), {}, kX, static_cast<uint32_t>(ir::Kind::kInt));
  const Code load = op(Opcode::MOV_16, F(kW0), C(kOne16));
  const struct {
    const char* what;
    Code before;
    Code store;
  } cases[] = {
      {"near, self", {}, op(Opcode::MOV_16, S(kX), C(kOne16))},
      {"near, global", {}, op(Opcode::MOV_32, G(kCount), G(kCount))},
      {"logic", {}, op(Opcode::NOT_B, S(kFlag), S(kFlag))},
      {"real", {}, op(Opcode::ADD_F32, S(kReal), S(kReal), S(kReal))},
      {"far", load, wide(Opcode::STFAR_16, F(kW0), S(kX))},
      {"through an address", lea, op(Opcode::ST_16, F(kAddrInt), C(kOne16))},
  };
  for (const auto& row : cases) {
    const auto verified = ir::verify(ir::encode(image(row.before + row.store + ret)));
    ASSERT_TRUE(verified.ok()) << row.what << ": " << verified.error().text;
    const ir::Unit without = vm::without_store(row.store.front());
    const Code code = row.before + Code{without} + ret;
    const ir::PouVersion version{kMainPou, code};
    const std::vector<base::Status> answers = ir::verify_versions(*verified, {&version, 1});
    EXPECT_TRUE(answers[0].ok()) << row.what << ": " << answers[0].error().text;
  }
}

// Other code gets no further than the image itself would.
TEST(Forcing, AVersionThatBreaksARuleIsRefused) {
  const auto verified = ir::verify(ir::encode(busy_image()));
  ASSERT_TRUE(verified.ok());
  const ir::LinkedPou& main = verified->image().pous[kMainPou];
  const auto first = verified->image().code.begin() + main.first_unit;
  const Code own(first, first + main.unit_count);
  const auto answer = [&](const Code& code) {
    const ir::PouVersion version{kMainPou, code};
    return ir::verify_versions(*verified, {&version, 1})[0];
  };
  EXPECT_TRUE(answer(own).ok());
  Code shorter = own;
  shorter.pop_back();
  ASSERT_FALSE(answer(shorter).ok());
  EXPECT_NE(answer(shorter).error().text.find("another length"), std::string::npos);
  bool without_call = false;
  for (size_t i = 0; i < own.size(); ++i) {
    Code one = own;
    one[i] = op(Opcode::MOV_16, S(0xfff0), C(kOne16)).front();
    EXPECT_FALSE(answer(one).ok()) << i;
    const bool extended = ir::opcode_row(own[i].opcode()).extended;
    if (own[i].opcode() == Opcode::CALL_INST) {
      one[i] = op(Opcode::MOV_16, S(kX), S(kX)).front();
      ASSERT_FALSE(answer(one).ok());
      without_call |= answer(one).error().text.find("something else") != std::string::npos;
    }
    if (extended) ++i;
  }
  EXPECT_TRUE(without_call);
}

// Only the POUs that write it, and those that have them inside, get other code.
TEST(Forcing, TheRestOfTheProgramKeepsItsCode) {
  const ir::Image image = build(R"(
VAR_GLOBAL g, h : INT; END_VAR
FUNCTION_BLOCK Small VAR_OUTPUT n : INT; END_VAR n := n + 1; g := n; END_FUNCTION_BLOCK
FUNCTION_BLOCK Other VAR i, n : INT; END_VAR FOR i := 1 TO 3 DO n := n + g; h := n; END_FOR; END_FUNCTION_BLOCK
PROGRAM Main VAR s : Small; seen : INT; END_VAR s(); seen := g; END_PROGRAM
PROGRAM Second VAR o : Other; END_VAR o(); END_PROGRAM)");
  for (const vm::Tier tier : {vm::Tier::kInterpreter, vm::Tier::kNative}) {
    vm::TierOptions options;
    options.tier = tier;
    Machine machine(image, options);
    ASSERT_TRUE(machine.good());
    const vm::Generation& generation = machine.generation();
    const vm::ForcedVariable g{variable(image, "g"), {7, 0}};
    const auto forced =
        vm::ForcedCode::make(generation.verified(), *generation.code(), {&g, 1}, options);
    ASSERT_NE(forced, nullptr);
    EXPECT_EQ(forced->versions(), 1u);
    EXPECT_EQ(forced->reason(0), "");
    for (uint32_t i = 0; i < image.pous.size(); ++i) {
      const vm::PouEntry& before = generation.pous()[i];
      const vm::PouEntry& now = forced->table().pous[i];
      const std::string& name = image.pous[i].name;
      EXPECT_EQ(now.code == before.code, name != "Small") << name;
      if (generation.native() == nullptr) {
        EXPECT_EQ(now.entry, now.code) << name;
        continue;
      }
      ASSERT_NE(forced->table().native, nullptr);
      EXPECT_EQ(forced->table().native->reason(i), "") << name;
      EXPECT_EQ(now.machine == before.machine, name == "Other" || name == "Second") << name;
    }
  }
}

// Where a store may lead elsewhere too, the POU is interpreted, and nothing else is.
TEST(Forcing, AStoreThatMayLeadElsewhereIsInterpreted) {
  const ir::Image image = build(R"(
FUNCTION_BLOCK Many VAR_OUTPUT n : INT; END_VAR n := n + 1; END_FUNCTION_BLOCK
PROGRAM Main VAR a, b : Many; seen, i : INT; END_VAR FOR i := 1 TO 2 DO a(); b(); END_FOR; seen := a.n; END_PROGRAM)");
  Machine machine(image);
  ASSERT_TRUE(machine.good());
  const vm::Generation& generation = machine.generation();
  if (generation.native() == nullptr) GTEST_SKIP() << "no native tier on this machine";
  const vm::ForcedVariable n{variable(image, "Main.a.n"), {7, 0}};
  const auto forced = vm::ForcedCode::make(generation.verified(), *generation.code(), {&n, 1}, {});
  ASSERT_NE(forced, nullptr);
  EXPECT_EQ(forced->reason(0), "");
  const vm::native::Program& native = *forced->table().native;
  EXPECT_EQ(native.reason(0), "it writes where a variable is forced");
  EXPECT_EQ(native.reason(1), "");
  EXPECT_NE(forced->table().pous[1].machine, generation.pous()[1].machine) << "it had it inside";
}

// A force that would have too much of a program interpreted holds at the boundaries.
TEST(Forcing, TooManyPousAreNotInterpreted) {
  const auto source = [](size_t count) {
    std::string text = "VAR_GLOBAL g : INT; END_VAR\n";
    std::string calls = "g := 1;\n";
    for (size_t i = 0; i < count; ++i) {
      const std::string name = "F" + std::to_string(i);
      text += "FUNCTION " + name + " : INT VAR_IN_OUT v : INT; END_VAR v := v + 1; END_FUNCTION\n";
      calls += name + "(g);\n";
    }
    return text + "PROGRAM Main " + calls + "END_PROGRAM";
  };
  for (const size_t more : {0, 1}) {
    Machine machine(build(source(vm::kMostRestoringPous + more)));
    ASSERT_TRUE(machine.good());
    const vm::Generation& generation = machine.generation();
    const vm::ForcedVariable g{variable(machine.image(), "g"), {7, 0}};
    const auto forced =
        vm::ForcedCode::make(generation.verified(), *generation.code(), {&g, 1}, {});
    ASSERT_NE(forced, nullptr);
    if (more == 0) {
      EXPECT_EQ(forced->reason(0), "");
      EXPECT_EQ(forced->versions(), vm::kMostRestoringPous + 1);
    } else {
      EXPECT_EQ(forced->reason(0),
                "`F0` in line 2 may write it by VAR_IN_OUT or by a reference, and so may more than "
                "31 other POUs");
      EXPECT_EQ(forced->versions(), 0u);
    }
  }
}

// The variables of a version that the verifier does not take are forced at the boundaries; the
// others keep theirs.
TEST(Forcing, WhatIsNotVerifiedDoesNotRun) {
  Machine machine(build(R"(
VAR_GLOBAL g, h : INT; END_VAR
FUNCTION_BLOCK Bad VAR n : INT; END_VAR n := n + 1; g := n; END_FUNCTION_BLOCK
PROGRAM Main VAR b : Bad; seen : INT; END_VAR b(); g := 3; h := 4; seen := g + h; END_PROGRAM)"));
  ASSERT_TRUE(machine.good());
  const ir::Image& image = machine.image();
  const vm::Generation& generation = machine.generation();
  size_t asked = 0;
  const auto verify = [&](const ir::VerifiedImage& verified,
                          std::span<const ir::PouVersion> versions) {
    ++asked;
    std::vector<base::Status> answers = ir::verify_versions(verified, versions);
    for (size_t i = 0; i < versions.size(); ++i) {
      EXPECT_TRUE(answers[i].ok());
      if (image.pous[versions[i].pou].name == "Bad") {
        answers[i] = base::Error{base::Refusal::kBadCall, "not like that"};
      }
    }
    return answers;
  };
  const vm::ForcedVariable both[] = {{variable(image, "g"), {7, 0}},
                                     {variable(image, "h"), {8, 0}}};
  const auto forced =
      vm::ForcedCode::make(generation.verified(), *generation.code(), both, {}, verify);
  ASSERT_NE(forced, nullptr);
  EXPECT_EQ(asked, 2u);
  EXPECT_NE(forced->reason(0).find("not like that"), std::string::npos);
  EXPECT_EQ(forced->reason(1), "");
  EXPECT_EQ(forced->versions(), 1u) << "that of Main, where `h` is written";
  for (uint32_t i = 0; i < image.pous.size(); ++i) {
    const bool own = forced->table().pous[i].code == generation.pous()[i].code;
    EXPECT_EQ(own, image.pous[i].name != "Main") << image.pous[i].name;
  }
}

TEST(Forcing, WithoutWritersThereIsNothingToExchange) {
  Machine machine(build("PROGRAM Main VAR a, b : INT; END_VAR b := a; END_PROGRAM"));
  ASSERT_TRUE(machine.good());
  const vm::Generation& generation = machine.generation();
  const vm::ForcedVariable a{variable(machine.image(), "Main.a"), {7, 0}};
  EXPECT_EQ(vm::ForcedCode::make(generation.verified(), *generation.code(), {&a, 1}, {}), nullptr);
  EXPECT_EQ(vm::ForcedCode::make(generation.verified(), *generation.code(), {}, {}), nullptr);
}

}  // namespace
