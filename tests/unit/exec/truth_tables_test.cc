// Truth tables do what the instructions do, for everybody who reads behind them. Random code
// follows the verifier's rule: temporaries are read where they were written, whichever way was
// taken. Golden files and random programs run with tables for every instruction, too.
#include "vm/load/truth_tables.h"

#include <gtest/gtest.h>

#include <map>
#include <random>
#include <set>

#include "tests/unit/exec/machine.h"
#include "tests/unit/exec/source_image.h"
#include "vm/exec/handler_numbers.h"

namespace {

using ir::Base;
using ir::Opcode;
using ir::Unit;

constexpr uint16_t kTemps = 6;   // frame offsets 0 to 5
constexpr uint16_t kLocals = 3;  // frame offsets 8 to 10
constexpr uint16_t kVariables = 9;
const base::Bytes kPool = {0, 1};

// By base and offset; what was never written is 0.
struct Memory {
  std::map<std::pair<Base, uint16_t>, uint8_t> bytes;
  uint8_t& at(Base base, uint16_t offset) { return bytes[{base, offset}]; }
  uint8_t read(Base base, uint16_t offset) {
    return base == Base::kConst ? kPool[offset] : at(base, offset);
  }
};

uint8_t result_of(Opcode op, uint8_t a, uint8_t b, uint8_t c) {
  if (op == Opcode::MOV_B) return b;
  if (op == Opcode::NOT_B) return !b;
  if (op == Opcode::AND_B) return b && c;
  if (op == Opcode::OR_B) return b || c;
  if (op == Opcode::XOR_B) return b != c;
  if (op == Opcode::ANDN_B) return b && !c;
  if (op == Opcode::ORN_B) return b || !c;
  return b ? c : a;  // CMOV_B
}

// Units are taken one by one, or as series where one begins.
void run(std::span<const Unit> code, std::span<const vm::TruthSeries> series, Memory& memory) {
  for (size_t i = 0; i < code.size();) {
    const Unit& u = code[i];
    const auto found = std::find_if(series.begin(), series.end(),
                                    [&](const vm::TruthSeries& s) { return s.first == i; });
    if (found != series.end()) {
      for (const vm::TruthRow& row : found->rows) {
        uint32_t number = 0;
        for (uint32_t k = 0; k < vm::kTruthInputs; ++k) {
          auto base = static_cast<Base>(row.bases >> 2 * k & 3);
          const bool at_home = k < vm::kHomeInputs;
          if (found->home != vm::kNoHome && at_home) base = static_cast<Base>(found->home);
          EXPECT_NE(base, Base::kConst);
          number += static_cast<uint32_t>(memory.read(base, row.in[k])) << k;
        }
        memory.at(static_cast<Base>(row.bases >> 12), row.out) = row.table >> (number & 63) & 1;
      }
      i += found->units;
    } else if (u.opcode() == Opcode::JF || u.opcode() == Opcode::JT) {
      const bool jumps = memory.read(u.base_a(), u.a) == (u.opcode() == Opcode::JT);
      i += jumps ? 1 + u.bc() : 1;
    } else if (u.opcode() == Opcode::JMP) {
      i += 1 + u.bc();
    } else if (u.opcode() == Opcode::RET) {
      return;
    } else {
      const uint8_t a = memory.at(u.base_a(), u.a);
      const uint8_t b = memory.read(u.base_b(), u.b);
      memory.at(u.base_a(), u.a) = result_of(u.opcode(), a, b, memory.read(u.base_c(), u.c));
      ++i;
    }
  }
}

class Code {
 public:
  explicit Code(uint32_t seed) : random_(seed) {
    for (uint16_t i = 0; i < kTemps; ++i) {
      pou.slots.push_back(
          {i, ir::SlotKind::kTemp, ir::LocalKind::kTemp, false, ir::Class::kB, {}, {}});
    }
    for (uint16_t i = 0; i < kLocals; ++i) {
      const auto offset = static_cast<uint16_t>(8 + i);
      pou.slots.push_back(
          {offset, ir::SlotKind::kLocal, ir::LocalKind::kTemp, false, ir::Class::kB, {}, {}});
    }
    pou.frame_size = 16;
  }

  // Blocks of logic; each ends with a jump over some of the next ones, or with none.
  void fill(uint32_t blocks, uint32_t most) {
    std::vector<std::pair<size_t, uint32_t>> jumps;   // unit and the block it leads to
    std::map<uint32_t, std::set<uint16_t>> promised;  // by block: what is written there
    bool arrives = true;
    for (uint32_t block = 0; block < blocks; ++block) {
      const auto merge = promised.find(block);
      if (merge != promised.end()) {
        // What was promised at a jump and holds a value here as well.
        std::set<uint16_t> both;
        for (const uint16_t slot : merge->second) {
          if (!arrives || written_.contains(slot)) both.insert(slot);
        }
        written_ = both;
        pou.merges.push_back({static_cast<uint32_t>(units.size()), {both.begin(), both.end()}});
      } else if (!arrives) {
        break;
      }
      for (auto& [unit, to] : jumps) {
        if (to == block) units[unit].set_bc(static_cast<uint32_t>(units.size() - unit - 1));
      }
      for (uint32_t i = below(most) + 1; i-- > 0;) add_gate();
      arrives = true;
      const uint32_t to = block + 1 + below(3);
      const uint32_t kind = below(3);
      if (kind == 0 || to >= blocks) continue;
      const auto known = promised.find(to);
      if (known == promised.end()) {
        promised[to] = written_;
      } else {
        std::erase_if(known->second, [&](uint16_t slot) { return !written_.contains(slot); });
      }
      jumps.emplace_back(units.size(), to);
      Unit jump = Unit::make(kind == 1  ? Opcode::JMP
                             : below(2) ? Opcode::JT
                                        : Opcode::JF,
                             Base::kSelf);
      if (kind == 1) jump = Unit::make(Opcode::JMP);
      if (kind != 1) jump.a = variable();
      arrives = kind != 1;
      units.push_back(jump);
    }
    for (auto& [unit, to] : jumps) {
      if (units[unit].bc() == 0) units[unit].set_bc(static_cast<uint32_t>(units.size() - unit - 1));
    }
    units.push_back(Unit::make(Opcode::RET));
  }
  void add_gate() {
    constexpr Opcode kOps[] = {Opcode::MOV_B, Opcode::NOT_B,  Opcode::AND_B, Opcode::OR_B,
                               Opcode::XOR_B, Opcode::ANDN_B, Opcode::ORN_B, Opcode::CMOV_B};
    Opcode op = kOps[below(8)];
    if (op == Opcode::CMOV_B && written_.empty()) op = Opcode::MOV_B;
    const auto [base_b, b] = source(false);
    auto [base_c, c] = source(true);
    if (op == Opcode::MOV_B || op == Opcode::NOT_B) base_c = Base::kFrame, c = 0;
    Base base_a = static_cast<Base>(below(3));
    uint16_t a = base_a == Base::kFrame ? frame() : variable();
    if (op == Opcode::CMOV_B) {
      base_a = Base::kFrame;
      a = any_written();
    }
    if (base_a == Base::kFrame) written_.insert(slot_of(a));
    Unit unit = Unit::make(op, base_a, base_b, base_c);
    unit.a = a;
    unit.b = b;
    unit.c = c;
    units.push_back(unit);
  }
  uint32_t below(uint32_t limit) { return static_cast<uint32_t>(random_() % limit); }

  ir::LinkedPou pou;
  std::vector<Unit> units;

 private:
  static uint16_t slot_of(uint16_t offset) {
    return static_cast<uint16_t>(offset < 8 ? offset : offset - 8 + kTemps);
  }
  uint16_t variable() { return static_cast<uint16_t>(below(kVariables)); }
  uint16_t frame() {
    const uint32_t i = below(kTemps + 1);
    return static_cast<uint16_t>(i < kTemps ? i : 8 + below(kLocals));
  }
  uint16_t any_written() {
    auto slot = written_.begin();
    std::advance(slot, below(static_cast<uint32_t>(written_.size())));
    return static_cast<uint16_t>(*slot < kTemps ? *slot : 8 + *slot - kTemps);
  }
  std::pair<Base, uint16_t> source(bool constants) {
    const uint32_t kind = below(8);
    if (kind == 0 && constants) return {Base::kConst, static_cast<uint16_t>(below(2))};
    if (kind < 4 && !written_.empty()) return {Base::kFrame, any_written()};
    return {kind < 6 ? Base::kSelf : Base::kGlobal, variable()};
  }
  std::mt19937 random_;
  std::set<uint16_t> written_;  // slots
};

TEST(TruthTables, RandomLinesLeaveTheSameBehindThem) {
  size_t gates = 0;
  size_t rows = 0;
  size_t with_home = 0;
  size_t without_home = 0;
  for (uint32_t seed = 1; seed <= 3000; ++seed) {
    Code code(seed);
    code.fill(1 + seed % 7, 1 + seed % 40);
    const auto series = vm::truth_tables(code.pou, code.units, kPool, 1, true);
    for (const auto& s : series) {
      gates += s.units;
      rows += s.rows.size();
      ++(s.home == vm::kNoHome ? without_home : with_home);
    }
    for (int start = 0; start < 8; ++start) {
      Memory plain;
      for (uint16_t i = 0; i < kVariables; ++i) {
        plain.at(Base::kSelf, i) = static_cast<uint8_t>(code.below(2));
        plain.at(Base::kGlobal, i) = static_cast<uint8_t>(code.below(2));
      }
      // What another call left there.
      for (uint16_t i = 0; i < 16; ++i)
        plain.at(Base::kFrame, i) = static_cast<uint8_t>(code.below(256));
      Memory tables = plain;
      run(code.units, {}, plain);
      run(code.units, series, tables);
      for (uint16_t i = 0; i < kTemps; ++i) plain.at(Base::kFrame, i) = tables.at(Base::kFrame, i);
      ASSERT_EQ(tables.bytes, plain.bytes) << "seed " << seed;
    }
  }
  EXPECT_LT(rows, gates * 9 / 10);
  EXPECT_GT(with_home, 1000u);
  EXPECT_GT(without_home, 1000u);
}

Unit gate(Opcode op, Base base_a, uint16_t a, Base base_b, uint16_t b, Base base_c, uint16_t c) {
  Unit unit = Unit::make(op, base_a, base_b, base_c);
  unit.a = a;
  unit.b = b;
  unit.c = c;
  return unit;
}

TEST(TruthTables, ARungOfSixContactsIsOneRow) {
  Code code(1);
  const Base f = Base::kFrame;
  const Base s = Base::kSelf;
  code.units = {gate(Opcode::AND_B, f, 0, s, 0, s, 1),
                gate(Opcode::ANDN_B, f, 0, f, 0, s, 2),
                gate(Opcode::AND_B, f, 1, s, 3, s, 4),
                gate(Opcode::OR_B, f, 0, f, 0, f, 1),
                gate(Opcode::ORN_B, s, 8, f, 0, Base::kGlobal, 5),
                Unit::make(Opcode::RET)};
  const auto series = vm::truth_tables(code.pou, code.units, kPool, 1, false);
  ASSERT_EQ(series.size(), 1u);
  EXPECT_EQ(series[0].units, 5u);
  ASSERT_EQ(series[0].rows.size(), 1u);
  EXPECT_EQ(series[0].rows[0].out, 8);
}

// Temporaries that wait, and instructions in one table, are limited.
TEST(TruthTables, TheWorkIsLinearInTheCode) {
  for (const uint16_t temps : {uint16_t{2}, uint16_t{3000}}) {
    Code code(1);
    code.pou.slots.clear();
    for (uint16_t i = 0; i < temps; ++i) {
      code.pou.slots.push_back(
          {i, ir::SlotKind::kTemp, ir::LocalKind::kTemp, false, ir::Class::kB, {}, {}});
    }
    code.pou.frame_size = 3000;
    for (uint32_t i = 0; i < 60'000; ++i) {
      const auto to = static_cast<uint16_t>(i % temps);
      const auto from = static_cast<uint16_t>((i * 7 + 1) % temps);
      code.units.push_back(gate(i % 2 == 0 ? Opcode::XOR_B : Opcode::OR_B, Base::kFrame, to,
                                Base::kFrame, from, Base::kSelf, static_cast<uint16_t>(i % 5)));
    }
    code.units.push_back(gate(Opcode::MOV_B, Base::kSelf, 7, Base::kFrame, 0, Base::kFrame, 0));
    code.units.push_back(Unit::make(Opcode::RET));
    const auto series = vm::truth_tables(code.pou, code.units, kPool, 1, true);
    ASSERT_EQ(series.size(), 1u);
    EXPECT_LE(series[0].rows.size(), code.units.size());
  }
}

constexpr const char* kRungs = R"(
FUNCTION Latch : BOOL VAR_INPUT s, r, q : BOOL; END_VAR
VAR a, b : BOOL; END_VAR
  a := s AND NOT r; b := q AND NOT r; a := a XOR (b AND s); b := b OR (a AND NOT s);
  Latch := (a OR b) AND NOT (r AND (s XOR q)) OR (a AND b AND s);
  Latch := Latch AND (s OR q OR NOT r) AND NOT (a AND NOT b AND r);
END_FUNCTION
VAR_GLOBAL Stop : BOOL; Lamps : ARRAY[0..3] OF BOOL; END_VAR
PROGRAM Main
VAR x, y, z, u, v, w : BOOL; n : DWORD := 16#9E3779B9; sum : DWORD; i : INT; END_VAR
  n := n * 1664525 + 1013904223; x := n.31; y := n.30; z := n.29; Stop := n.28;
  u := (x AND y OR NOT z) AND NOT (Stop AND x) OR (u AND NOT y AND (z OR x)) OR (v AND w AND NOT x);
  v := (u OR NOT x) AND (y OR z AND NOT Stop) XOR (w AND NOT u AND x) OR (Stop AND NOT v AND y);
  IF u AND NOT v THEN w := x OR (y AND NOT z) AND NOT Stop; ELSE w := NOT w AND (x OR Stop); END_IF;
  Lamps[0] := u AND (v OR w) AND NOT Stop; Lamps[1] := Latch(x, y, w) OR Latch(u, v, z);
  FOR i := 0 TO 3 DO
    sum := ROL(sum, 1) XOR BOOL_TO_DWORD(Lamps[i]) XOR BOOL_TO_DWORD(u AND v OR w AND x);
  END_FOR;
END_PROGRAM)";

TEST(TruthTables, TheHandlerDoesWhatTheInstructionsDo) {
  const ir::Image image = sample::build(kRungs, nullptr, sample::Optimised::kYes);
  vm::TierOptions plain;
  plain.tier = vm::Tier::kInterpreter;
  plain.fusing = vm::Fusing::kNever;
  vm::TierOptions tables = plain;
  tables.fusing = vm::Fusing::kAlways;
  tables.logic_line = 1;
  sample::Machine a(image, plain);
  sample::Machine b(image, tables);
  size_t heads = 0;
  for (uint32_t p = 0; p < image.pous.size(); ++p) {
    for (uint32_t i = 0; i < image.pous[p].unit_count; ++i) {
      heads += b.generation().pous()[p].code[i].op == vm::kTruthTables ? 1 : 0;
    }
  }
  EXPECT_GT(heads, 4u);
  for (int scan = 0; scan < 200; ++scan) {
    ASSERT_EQ(a.scan(), vm::Exit::kDone) << a.trap_text();
    ASSERT_EQ(b.scan(), vm::Exit::kDone) << b.trap_text();
    for (const char* path : {"Main.u", "Main.v", "Main.w", "Main.sum", "Lamps", "Stop"}) {
      ASSERT_EQ(a.value(path), b.value(path)) << path << ", scan " << scan;
    }
  }
}

// Bytes that are neither 0 nor 1 are TRUE, so instructions stay.
TEST(TruthTables, NoneWhereBoolsMayBeAnything) {
  const ir::Image image = sample::build(
      "TYPE U : UNION b : BYTE; x : BOOL; END_UNION; END_TYPE\n"
      "PROGRAM Main VAR u : U; p, q : BOOL; END_VAR\n"
      "  p := u.x AND NOT q; q := p OR (u.x XOR q); p := q AND NOT (u.x AND p);\nEND_PROGRAM",
      nullptr, sample::Optimised::kYes);
  vm::TierOptions tables;
  tables.tier = vm::Tier::kInterpreter;
  tables.logic_line = 1;
  const sample::Machine machine(image, tables);
  for (uint32_t p = 0; p < image.pous.size(); ++p) {
    for (uint32_t i = 0; i < image.pous[p].unit_count; ++i) {
      EXPECT_NE(machine.generation().pous()[p].code[i].op, vm::kTruthTables);
    }
  }
}

}  // namespace
