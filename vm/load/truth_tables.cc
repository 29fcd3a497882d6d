#include "vm/load/truth_tables.h"

#include <algorithm>
#include <bit>
#include <utility>

#include "vm/exec/handler_numbers.h"
#include "vm/load/last_reads.h"

namespace vm {
namespace {

using ir::Base;
using ir::Opcode;

// A table is computed from so many instructions at most, and so many values wait for being written:
// both keep the work linear.
constexpr uint32_t kMostGates = 32;
constexpr size_t kMostWaiting = 16;

bool is_logic(Opcode op) {
  switch (op) {
    case Opcode::MOV_B:
    case Opcode::AND_B:
    case Opcode::OR_B:
    case Opcode::XOR_B:
    case Opcode::ANDN_B:
    case Opcode::ORN_B:
    case Opcode::NOT_B:
    case Opcode::CMOV_B:
      return true;
    default:
      return false;
  }
}

// The result of 64 cases at once.
uint64_t apply(Opcode op, uint64_t a, uint64_t b, uint64_t c) {
  switch (op) {
    case Opcode::AND_B:
      return b & c;
    case Opcode::OR_B:
      return b | c;
    case Opcode::XOR_B:
      return b ^ c;
    case Opcode::ANDN_B:
      return b & ~c;
    case Opcode::ORN_B:
      return b | ~c;
    case Opcode::NOT_B:
      return ~b;
    case Opcode::CMOV_B:
      return (b & c) | (~b & a);
    default:
      return b;
  }
}

// Input k of a table in all cases.
constexpr uint64_t kCases[kTruthInputs] = {0xaaaaaaaaaaaaaaaau, 0xccccccccccccccccu,
                                           0xf0f0f0f0f0f0f0f0u, 0xff00ff00ff00ff00u,
                                           0xffff0000ffff0000u, 0xffffffff00000000u};

// Base in bits 16 and 17, offset below.
using Place = uint32_t;
constexpr Place kNowhere = ~Place{0};
Place place_of(Base base, uint16_t offset) { return static_cast<uint32_t>(base) << 16 | offset; }

// The places in memory that a value follows from, as inputs of a table.
class Leaves {
 public:
  Leaves() { places_.fill(kNowhere); }
  bool has(Place place) const { return input_of(place) < kTruthInputs; }
  // Which input has that place? kTruthInputs: none.
  uint32_t input_of(Place place) const {
    return static_cast<uint32_t>(std::find(places_.begin(), places_.end(), place) -
                                 places_.begin());
  }
  // False: there is no room.
  bool add(Place place, SlotHome home) {
    if (place == kNowhere || has(place)) return true;
    const bool away = home != kNoHome && place >> 16 != home;
    for (uint32_t k = away ? kHomeInputs : 0; k < kTruthInputs; ++k) {
      if (places_[k] != kNowhere) continue;
      places_[k] = place;
      return true;
    }
    return false;
  }
  bool add(const Leaves& others, SlotHome home) {
    return std::all_of(others.places_.begin(), others.places_.end(),
                       [&](Place place) { return add(place, home); });
  }
  uint32_t count() const {
    const auto free = std::count(places_.begin(), places_.end(), kNowhere);
    return kTruthInputs - static_cast<uint32_t>(free);
  }
  Place operator[](uint32_t k) const { return places_[k]; }

 private:
  std::array<Place, kTruthInputs> places_;
};

// A value as the instructions that make it of what is in memory now.
struct Term {
  enum class Kind : uint8_t { kConstant, kLeaf, kGate };
  Kind kind = Kind::kConstant;
  Opcode op = Opcode::MOV_B;
  uint32_t gates = 0;            // in it
  uint64_t constant = 0;         // in all cases
  std::array<uint32_t, 3> in{};  // terms: a, b, c
  Leaves leaves;
  Place place = kNowhere;  // of a leaf
};

class Maker {
 public:
  // `at_home`: some variable there; kNowhere: there is no home.
  Maker(const base::Bytes& pool, Place at_home)
      : pool_(pool),
        at_home_(at_home),
        home_(at_home == kNowhere ? kNoHome : static_cast<SlotHome>(at_home >> 16)),
        terms_(1) {}

  // False: with that home there are no rows for the line.
  bool take(const ir::Unit& u, const LastReads& reads, uint32_t unit);
  std::vector<TruthRow> finish();

 private:
  struct Waiting {  // the value of a place in the frame, which has not been written yet
    Place slot = 0;
    uint32_t term = 0;
  };
  uint32_t add(const Term& term) {
    terms_.push_back(term);
    return static_cast<uint32_t>(terms_.size() - 1);
  }
  uint32_t leaf(Place place);
  uint32_t read(Base base, uint16_t offset, bool ends);
  size_t waiting_at(Place place) const;
  void forget(Base base, uint16_t offset);
  void write_waiting(size_t index);
  void write_readers(Place place);
  bool write_largest(std::array<uint32_t, 3>& in);
  bool join(Term& term);
  void write(Place place, uint32_t term);
  uint64_t cases(uint32_t term, const Leaves& leaves) const;

  const base::Bytes& pool_;
  Place at_home_;
  SlotHome home_;
  std::vector<Term> terms_;  // the first stands for operands that there are not
  std::vector<Waiting> waiting_;
  std::vector<TruthRow> rows_;
};

uint32_t Maker::leaf(Place place) {
  Term term;
  term.kind = Term::Kind::kLeaf;
  term.place = place;
  term.leaves.add(place, home_);
  return add(term);
}

size_t Maker::waiting_at(Place place) const {
  size_t i = 0;
  while (i < waiting_.size() && waiting_[i].slot != place) ++i;
  return i;
}

uint32_t Maker::read(Base base, uint16_t offset, bool ends) {
  if (base == Base::kConst) {
    Term term;
    term.constant = pool_[offset] != 0 ? ~uint64_t{0} : 0;
    return add(term);
  }
  const Place place = place_of(base, offset);
  const size_t found = waiting_at(place);
  if (found == waiting_.size()) return leaf(place);
  // What follows from the old value of its own place cannot wait while others follow from it.
  if (ends || !terms_[waiting_[found].term].leaves.has(place)) return waiting_[found].term;
  write_waiting(found);
  return leaf(place);
}

void Maker::forget(Base base, uint16_t offset) {
  const size_t found = waiting_at(place_of(base, offset));
  if (found != waiting_.size()) waiting_.erase(waiting_.begin() + static_cast<ptrdiff_t>(found));
}

// No other waiting value follows from that place: see write_readers().
void Maker::write_waiting(size_t index) {
  const Waiting row = waiting_[index];
  waiting_.erase(waiting_.begin() + static_cast<ptrdiff_t>(index));
  write(row.slot, row.term);
}

// Before a place changes, or a value begins to wait for it.
void Maker::write_readers(Place place) {
  for (size_t i = waiting_.size(); i-- > 0;) {
    if (terms_[waiting_[i].term].leaves.has(place)) write_waiting(i);
  }
}

uint64_t Maker::cases(uint32_t term, const Leaves& leaves) const {
  const Term& t = terms_[term];
  if (t.kind == Term::Kind::kConstant) return t.constant;
  if (t.kind == Term::Kind::kLeaf) return kCases[leaves.input_of(t.place)];
  return apply(t.op, cases(t.in[0], leaves), cases(t.in[1], leaves), cases(t.in[2], leaves));
}

// Inputs that are not needed are BOOLs, too, but those on top, which may be anything.
void Maker::write(Place place, uint32_t term) {
  const Leaves& leaves = terms_[term].leaves;
  Place filler = leaves[0];
  if (filler == kNowhere) filler = home_ == kNoHome ? place : at_home_;
  TruthRow row;
  row.table = cases(term, leaves);
  for (uint32_t k = 0; k < kTruthInputs; ++k) {
    const Place input = leaves[k] == kNowhere ? filler : leaves[k];
    row.in[k] = static_cast<uint16_t>(input);
    row.bases = static_cast<uint16_t>(row.bases | (input >> 16) << 2 * k);
  }
  row.out = static_cast<uint16_t>(place);
  row.bases = static_cast<uint16_t>(row.bases | (place >> 16) << 12);
  rows_.push_back(row);
}

// Among what `in` is made of, that which follows from most places is written, and read from there
// from now on. Only waiting values are made of anything.
bool Maker::write_largest(std::array<uint32_t, 3>& in) {
  const auto size = [this](uint32_t term) {
    return terms_[term].kind == Term::Kind::kGate ? terms_[term].leaves.count() + 1 : 0;
  };
  const uint32_t term = *std::max_element(
      in.begin(), in.end(), [&](uint32_t x, uint32_t y) { return size(x) < size(y); });
  const auto found = std::find_if(waiting_.begin(), waiting_.end(),
                                  [&](const Waiting& row) { return row.term == term; });
  if (size(term) == 0 || found == waiting_.end()) return false;
  const Place place = found->slot;
  write_waiting(static_cast<size_t>(found - waiting_.begin()));
  std::replace(in.begin(), in.end(), term, leaf(place));
  return true;
}

bool Maker::join(Term& term) {
  bool fits = false;
  do {
    term.leaves = {};
    term.gates = 1;
    fits = true;
    for (const uint32_t part : term.in) {
      fits = term.leaves.add(terms_[part].leaves, home_) && fits;
      term.gates += terms_[part].gates;
    }
    fits = fits && term.gates <= kMostGates;
  } while (!fits && write_largest(term.in));
  return fits;
}

bool Maker::take(const ir::Unit& u, const LastReads& reads, uint32_t unit) {
  const ir::OpcodeRow& row = ir::opcode_row(u.opcode());
  const bool has_c = row.c.kind != ir::FieldKind::kNone;
  Term gate;
  gate.kind = Term::Kind::kGate;
  gate.op = u.opcode();
  gate.in[1] = read(u.base_b(), u.b, reads.ends_b(unit));
  if (has_c) gate.in[2] = read(u.base_c(), u.c, reads.ends_c(unit));
  if (row.a.reads()) gate.in[0] = read(u.base_a(), u.a, true);
  if (!join(gate)) return false;
  const uint32_t term = add(gate);
  if (reads.ends_b(unit)) forget(u.base_b(), u.b);
  if (has_c && reads.ends_c(unit)) forget(u.base_c(), u.c);
  const Place place = place_of(u.base_a(), u.a);
  forget(u.base_a(), u.a);
  if (reads.ends_a(unit)) return true;
  write_readers(place);
  if (u.base_a() == Base::kFrame) {
    waiting_.push_back({place, term});
    if (waiting_.size() > kMostWaiting) write_waiting(0);
  } else {
    write(place, term);
  }
  return true;
}

std::vector<TruthRow> Maker::finish() {
  while (!waiting_.empty()) write_waiting(waiting_.size() - 1);
  return std::move(rows_);
}

// Lines, still without rows.
std::vector<TruthSeries> logic_lines(const ir::LinkedPou& pou, std::span<const ir::Unit> code,
                                     uint32_t least) {
  std::vector<TruthSeries> lines;
  TruthSeries line;
  const auto end_line = [&](uint32_t next) {
    if (line.units != 0 && line.units >= least) lines.push_back(line);
    line.first = next;
    line.units = 0;
  };
  auto merge = pou.merges.begin();
  for (uint32_t unit = 0; unit < code.size(); ++unit) {
    while (merge != pou.merges.end() && merge->unit < unit) ++merge;
    if (merge != pou.merges.end() && merge->unit == unit) end_line(unit);
    const Opcode op = code[unit].opcode();
    if (is_logic(op)) {
      ++line.units;
      continue;
    }
    if (ir::opcode_row(op).extended) ++unit;
    end_line(unit + 1);
  }
  end_line(0);
  return lines;
}

// A variable of the instance or of the globals, wherever the line reads more; kNowhere: of neither.
Place most_read(std::span<const ir::Unit> line) {
  std::array<uint32_t, 4> counts{};
  std::array<Place, 4> some{};
  const auto count = [&](Base base, uint16_t offset) {
    ++counts[static_cast<size_t>(base)];
    some[static_cast<size_t>(base)] = place_of(base, offset);
  };
  for (const ir::Unit& u : line) {
    count(u.base_b(), u.b);
    if (ir::opcode_row(u.opcode()).c.kind != ir::FieldKind::kNone) count(u.base_c(), u.c);
  }
  const auto self = static_cast<size_t>(Base::kSelf);
  const auto global = static_cast<size_t>(Base::kGlobal);
  const size_t most = counts[self] >= counts[global] ? self : global;
  return counts[most] == 0 ? kNowhere : some[most];
}

bool make_rows(std::span<const ir::Unit> code, const base::Bytes& pool, const LastReads& reads,
               Place at_home, TruthSeries& series) {
  Maker maker(pool, at_home);
  for (uint32_t i = 0; i < series.units; ++i) {
    if (!maker.take(code[series.first + i], reads, series.first + i)) return false;
  }
  series.rows = maker.finish();
  series.home = at_home == kNowhere ? kNoHome : static_cast<SlotHome>(at_home >> 16);
  return true;
}

}  // namespace

std::vector<TruthSeries> truth_tables(const ir::LinkedPou& pou, std::span<const ir::Unit> code,
                                      const base::Bytes& pool, uint32_t least, bool all) {
  std::vector<TruthSeries> lines = logic_lines(pou, code, least);
  if (lines.empty()) return lines;
  const LastReads reads(pou, code);
  for (TruthSeries& line : lines) {
    const Place at_home = most_read(code.subspan(line.first, line.units));
    if (make_rows(code, pool, reads, at_home, line)) continue;
    make_rows(code, pool, reads, kNowhere, line);
  }
  if (!all) std::erase_if(lines, [](const TruthSeries& s) { return 2 * s.rows.size() > s.units; });
  return lines;
}

void put_truth_tables(const TruthSeries& series, std::vector<ir::Unit>& prepared) {
  ir::Unit& head = prepared[series.first];
  head = {static_cast<uint16_t>(kTruthTables), series.home, 0, 0};
  head.set_bc(static_cast<uint32_t>(prepared.size()) - series.first);
  prepared.push_back(ir::Unit::extension(series.units, static_cast<uint32_t>(series.rows.size())));
  for (const TruthRow& row : series.rows) {
    for (const ir::Unit& unit : std::bit_cast<std::array<ir::Unit, kUnitsOfTruthRow>>(row)) {
      prepared.push_back(unit);
    }
  }
}

}  // namespace vm
