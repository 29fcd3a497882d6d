// Fused handlers: what shares one, and that nobody can tell: state, fuel, traps, places of
// suspension. Random programs and the golden files compare both forms too.
#include "vm/exec/fusion.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/unit/exec/machine.h"
#include "tests/unit/exec/source_image.h"

namespace {

using sample::Machine;
using vm::Exit;

// Optimised, as what the rows are for.
ir::Image build(const std::string& source, const ir::Image* base = nullptr) {
  return sample::build(source, base, sample::Optimised::kYes);
}

vm::TierOptions tier(vm::Fusing fusing, uint64_t seed = 0) {
  vm::TierOptions out;
  out.tier = vm::Tier::kInterpreter;
  out.fusing = fusing;
  out.fusing_seed = seed;
  return out;
}

constexpr const char* kLoops = R"(
FUNCTION_BLOCK Motor VAR_INPUT run : BOOL; stop : BOOL; speed : REAL; END_VAR
VAR_OUTPUT on : BOOL; turns : DINT; END_VAR VAR was : BOOL; v : REAL; END_VAR
  on := (on OR run) AND NOT stop;
  IF on AND NOT was THEN turns := turns + 1; END_IF;
  was := on;
  IF on THEN v := v + speed * 0.5; ELSE v := v * 0.25; END_IF;
END_FUNCTION_BLOCK
PROGRAM Main
VAR a : ARRAY[0..9] OF INT; m : ARRAY[0..9] OF Motor; i, j : INT; s : DINT; bits : DWORD; q : BOOL; END_VAR
  FOR i := 0 TO 9 DO
    bits := bits XOR SHL(DWORD#1, i) XOR 16#21;
    a[i] := a[i] + i;
    m[i](run := (bits AND 4) <> 0, stop := (bits AND 64) = 0, speed := 1.5);
    IF m[i].on THEN s := s + m[i].turns; END_IF;
  END_FOR;
  FOR i := 0 TO 8 DO
    FOR j := i TO 9 DO s := s * 3 + a[j]; q := (q OR s > 100) AND NOT (j > 5 AND q); END_FOR;
  END_FOR;
END_PROGRAM)";

// Where it was suspended, and what it had done until then.
std::vector<std::string> trace(const ir::Image& image, const vm::TierOptions& options,
                               uint64_t fuel) {
  Machine machine(image, options);
  if (!machine.good()) return {};
  std::vector<std::string> out;
  for (int scan = 0; scan < 3; ++scan) {
    machine.start();
    Exit exit = Exit::kSuspended;
    while (exit == Exit::kSuspended) {
      exit = machine.execution().run(fuel);
      const vm::Trap at = machine.execution().interrupted(ir::TrapKind::kFuel);
      std::string line = std::to_string(at.pou) + ":" + std::to_string(at.unit) + " " +
                         std::to_string(at.instance) + " " +
                         std::to_string(machine.execution().fuel_used());
      for (const char* path : {"Main.a", "Main.m", "Main.i", "Main.j", "Main.s", "Main.bits"})
        line += " " + machine.value(path);
      out.push_back(line);
    }
    EXPECT_EQ(exit, Exit::kDone) << machine.trap_text();
  }
  return out;
}

size_t fused_units(const Machine& machine, uint32_t pou) {
  const ir::Image& image = machine.image();
  const vm::StepLine line(
      std::span(image.code).subspan(image.pous[pou].first_unit, image.pous[pou].unit_count));
  size_t count = 0;
  for (uint32_t i = 0; i < line.size(); ++i) {
    if (!line.is_extension(i) && machine.generation().pous()[pou].code[i].op >= vm::kFirstFused)
      ++count;
  }
  return count;
}

uint32_t pou_number(const ir::Image& image, const std::string& name) {
  for (uint32_t i = 0; i < image.pous.size(); ++i)
    if (image.pous[i].name == name) return i;
  ADD_FAILURE() << name;
  return 0;
}

TEST(Fusion, EveryFuelSuspendsAtTheSamePlacesWithTheSameState) {
  const ir::Image image = build(kLoops);
  EXPECT_GT(fused_units(Machine(image, tier(vm::Fusing::kAlways)), pou_number(image, "Main")), 10u);
  for (uint64_t fuel = 1; fuel < 90; ++fuel) {
    const auto plain = trace(image, tier(vm::Fusing::kNever), fuel);
    EXPECT_EQ(trace(image, tier(vm::Fusing::kAuto), fuel), plain) << fuel;
    EXPECT_EQ(trace(image, tier(vm::Fusing::kAlways, fuel), fuel), plain) << fuel;
  }
}

// Is `unit` part of a fused handler that begins before it?
bool is_inside(const Machine& machine, uint32_t pou, uint32_t unit) {
  const ir::Image& image = machine.image();
  const vm::StepLine line(
      std::span(image.code).subspan(image.pous[pou].first_unit, image.pous[pou].unit_count));
  const ir::Unit* const code = machine.generation().pous()[pou].code;
  for (uint32_t i = 0; i < unit; ++i) {
    if (line.is_extension(i) || code[i].op < vm::kFirstFused) continue;
    const auto rows = vm::fusions();
    const auto row = std::find_if(rows.begin(), rows.end(),
                                  [&](const auto& r) { return r.handler == code[i].op; });
    vm::StepWalk walk(line, i);
    vm::StepKey key = 0;
    for (uint32_t k = 0; k < row->length && walk.take(key); ++k) {
      if (k > 0 && walk.unit(k) == unit) return true;
    }
  }
  return false;
}

TEST(Fusion, ATrapInsideNamesItsOwnInstruction) {
  const char* const programs[] = {
      "PROGRAM Main VAR a : ARRAY[0..9] OF INT; i : INT; s : DINT; END_VAR\n"
      "  FOR i := 0 TO 20 DO\n\n    s := s * 31 + a[i];\n  END_FOR;\nEND_PROGRAM",
      "PROGRAM Main VAR a : ARRAY[0..9] OF INT; i, s : INT; END_VAR\n"
      "  FOR i := 0 TO 20 DO\n\n    a[i] := s;\n  END_FOR;\nEND_PROGRAM",
      "PROGRAM Main VAR m : ARRAY[0..3, 0..9] OF LREAL; i, j : INT; s : LREAL; END_VAR\n"
      "  FOR i := 0 TO 3 DO FOR j := 0 TO 20 DO\n\n    s := s + m[i, j] * 2.0;\n  END_FOR; "
      "END_FOR;\n"
      "END_PROGRAM",
      "PROGRAM Main VAR a : ARRAY[0..9] OF INT; i : INT; s : DINT; END_VAR\n"
      "  FOR i := 0 TO 20 DO\n    s := s + 1;\n    s := s * 31 + a[i];\n  END_FOR;\nEND_PROGRAM",
      "PROGRAM Main VAR a : ARRAY[0..9] OF DINT; i : INT; s : DINT; END_VAR\n"
      "  FOR i := 0 TO 20 DO\n    s := s + 1;\n    a[i] := s;\n  END_FOR;\nEND_PROGRAM",
      "PROGRAM Main VAR a : ARRAY[0..9] OF REAL; i : INT; s : REAL; END_VAR\n"
      "  FOR i := 0 TO 20 DO\n    s := s + 1.0;\n    s := s + a[i] * 2.0;\n  END_FOR;\nEND_PROGRAM",
      "PROGRAM Main VAR s, i : DINT; END_VAR\n"
      "  FOR i := 5 TO 0 BY -1 DO\n    s := s * 3 + 7;\n    s := s * 10 / i + 7;\n  END_FOR;\n"
      "END_PROGRAM",
      "PROGRAM Main VAR r : REAL := 1.0; s : DINT; END_VAR\n"
      "  WHILE s < 2000000000 DO\n    r := r * 1000.0;\n    s := REAL_TO_DINT(r * 1000.0);\n  "
      "END_WHILE;\n"
      "END_PROGRAM",
  };
  size_t inside = 0;
  for (const char* const source : programs) {
    const ir::Image image = build(source);
    Machine plain(image, tier(vm::Fusing::kNever));
    Machine fused(image, tier(vm::Fusing::kAlways));
    ASSERT_EQ(plain.scan(), Exit::kTrap) << source;
    ASSERT_EQ(fused.scan(), Exit::kTrap) << source;
    const vm::Trap& trap = fused.execution().trap();
    if (is_inside(fused, trap.pou, trap.unit)) ++inside;
    EXPECT_EQ(trap.unit, plain.execution().trap().unit);
    EXPECT_EQ(trap.operand[0], plain.execution().trap().operand[0]);
    EXPECT_EQ(trap.operand[1], plain.execution().trap().operand[1]);
    EXPECT_EQ(fused.trap_text(), plain.trap_text());
    EXPECT_EQ(vm::describe(fused.image(), trap).line, 4u);
    for (const char* path : {"Main.s", "Main.i", "Main.r"})
      EXPECT_EQ(fused.value(path), plain.value(path));
  }
  EXPECT_GE(inside, 2u) << "the rows of fusions.def have none of these; take other programs";
}

// An address may point at what an earlier step has written: that value is read anew.
TEST(Fusion, AStoreThroughAnAddressEndsWhatIsAtHand) {
  const ir::Image image = build(R"(
FUNCTION Twice : DINT VAR_IN_OUT x : DINT; y : DINT; END_VAR
  x := x + 1; y := x * 2; x := x + 1; y := y + x; Twice := x;
END_FUNCTION
PROGRAM Main VAR s : DINT; END_VAR s := Twice(s, s) + s; END_PROGRAM)");
  Machine plain(image, tier(vm::Fusing::kNever));
  Machine fused(image, tier(vm::Fusing::kAlways));
  for (int scan = 0; scan < 4; ++scan) {
    ASSERT_EQ(plain.scan(), Exit::kDone);
    ASSERT_EQ(fused.scan(), Exit::kDone);
    EXPECT_EQ(fused.value("Main.s"), plain.value("Main.s"));
  }
  EXPECT_NE(fused.value("Main.s"), "0");
}

TEST(Fusion, AChangeKeepsTheFusedCodeOfPousThatStay) {
  const ir::Image first = build(kLoops);
  std::string changed = kLoops;
  changed.replace(changed.find("s * 3"), 5, "s * 5");
  const ir::Image second = build(changed, &first);
  vm::Memory memory = std::move(vm::Memory::reserve()).value();
  auto slots = std::make_shared<vm::CodeSlots>(UINT64_MAX / 16);
  const vm::TierOptions options = tier(vm::Fusing::kAlways);
  auto old = vm::Generation::build(*ir::verify(ir::encode(first)), 0, memory.data(), slots, nullptr,
                                   options);
  ASSERT_TRUE(old.ok());
  auto next = vm::Generation::build(*ir::verify(ir::encode(second)), 1, memory.data(), slots,
                                    old->get(), options);
  ASSERT_TRUE(next.ok());
  const uint32_t motor = pou_number(first, "Motor");
  const uint32_t main = pou_number(first, "Main");
  EXPECT_EQ((*old)->pous()[motor].code, (*next)->pous()[motor].code);
  EXPECT_NE((*old)->pous()[main].code, (*next)->pous()[main].code);
}

// Every fused number stands for exactly what the units say.
TEST(Fusion, AFusedUnitIsARowOfTheTable) {
  const ir::Image image = build(kLoops);
  const Machine machine(image, tier(vm::Fusing::kAlways));
  size_t found = 0;
  for (uint32_t pou = 0; pou < image.pous.size(); ++pou) {
    const vm::StepLine line(
        std::span(image.code).subspan(image.pous[pou].first_unit, image.pous[pou].unit_count));
    const ir::Unit* const code = machine.generation().pous()[pou].code;
    for (uint32_t i = 0; i < line.size(); ++i) {
      if (line.is_extension(i)) continue;
      if (code[i].op < vm::kFirstFused) {
        EXPECT_EQ(code[i].op, line[i].handler);
        continue;
      }
      const auto rows = vm::fusions();
      const auto row = std::find_if(rows.begin(), rows.end(),
                                    [&](const auto& r) { return r.handler == code[i].op; });
      ASSERT_NE(row, rows.end());
      vm::StepWalk walk(line, i);
      vm::StepKey key = 0;
      for (uint32_t k = 0; k < row->length; ++k) {
        ASSERT_TRUE(walk.take(key));
        EXPECT_EQ(key, row->keys[k]);
      }
      ++found;
    }
  }
  EXPECT_GT(found, 10u);
}

TEST(Fusion, StepsEndWhereWhatComesNextIsNotKnown) {
  const ir::Image image = build(kLoops);
  for (const ir::LinkedPou& pou : image.pous) {
    const vm::StepLine line(std::span(image.code).subspan(pou.first_unit, pou.unit_count));
    for (uint32_t i = 0; i < line.size(); ++i) {
      if (line.is_extension(i)) continue;
      vm::StepWalk walk(line, i);
      vm::StepKey key = 0;
      uint32_t back = 0;
      while (walk.take(key)) {
        const vm::StepLine::Unit& last = line[walk.unit(walk.length() - 1)];
        if (last.jumps && last.next <= walk.unit(walk.length() - 1)) ++back;
        if (last.ends) {
          EXPECT_FALSE(walk.take(key));
        }
      }
      EXPECT_LE(back, 2u);
      EXPECT_LE(walk.length(), vm::kMaxSteps);
    }
  }
}

TEST(Fusion, TheTableIsSortedAndHasNothingTwice) {
  const auto rows = vm::fusions();
  ASSERT_GT(rows.size(), 100u);
  for (size_t i = 0; i < rows.size(); ++i) {
    EXPECT_GE(rows[i].length, 2);
    EXPECT_LE(rows[i].length, vm::kMaxSteps);
    if (i > 0) {
      EXPECT_TRUE(std::lexicographical_compare(
          rows[i - 1].keys.begin(), rows[i - 1].keys.begin() + rows[i - 1].length,
          rows[i].keys.begin(), rows[i].keys.begin() + rows[i].length));
    }
  }
}

}  // namespace
