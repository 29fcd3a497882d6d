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

// Of 64 cases at once.
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
Place place_of(Base base, uint16_t offset) { return static_cast<uint32_t>(base) << 16 | offset; }

// The places in memory that a value follows from.
class Leaves {
 public:
  bool has(Place place) const { return std::find(begin(), end(), place) != end(); }
  // False: there is no room.
  bool add(Place place) {
    if (has(place)) return true;
    if (count_ == kTruthInputs) return false;
    places_[count_++] = place;
    return true;
  }
  bool add(const Leaves& others) {
    return std::all_of(others.begin(), others.end(), [this](Place place) { return add(place); });
  }
  uint32_t count() const { return count_; }
  uint32_t index(Place place) const {
    return static_cast<uint32_t>(std::find(begin(), end(), place) - begin());
  }
  const Place* begin() const { return places_.data(); }
  const Place* end() const { return places_.data() + count_; }

 private:
  std::array<Place, kTruthInputs> places_{};
  uint32_t count_ = 0;
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
};

class Maker {
 public:
  explicit Maker(const base::Bytes& pool) : pool_(pool), terms_(1) {}

  void take(const ir::Unit& u, const LastReads& reads, uint32_t unit);
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
  uint32_t join(Opcode op, std::array<uint32_t, 3> in);
  void write(Place place, uint32_t term);
  uint64_t cases(uint32_t term, const Leaves& leaves) const;

  const base::Bytes& pool_;
  std::vector<Term> terms_;  // the first stands for operands that there are not
  std::vector<Waiting> waiting_;
  std::vector<TruthRow> rows_;
};

uint32_t Maker::leaf(Place place) {
  Term term;
  term.kind = Term::Kind::kLeaf;
  term.leaves.add(place);
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
  if (t.kind == Term::Kind::kLeaf) return kCases[leaves.index(*t.leaves.begin())];
  return apply(t.op, cases(t.in[0], leaves), cases(t.in[1], leaves), cases(t.in[2], leaves));
}

void Maker::write(Place place, uint32_t term) {
  const Leaves& leaves = terms_[term].leaves;
  TruthRow row;
  row.table = cases(term, leaves);
  for (uint32_t k = 0; k < kTruthInputs; ++k) {
    const Place input = k < leaves.count() ? leaves.begin()[k] : k == 0 ? place : leaves.begin()[0];
    row.in[k] = static_cast<uint16_t>(input);
    row.bases = static_cast<uint16_t>(row.bases | (input >> 16) << 2 * k);
  }
  row.out = static_cast<uint16_t>(place);
  row.bases = static_cast<uint16_t>(row.bases | (place >> 16) << 12);
  rows_.push_back(row);
}

// Of what `in` is made of, that which follows from most places is written, and read from there
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

uint32_t Maker::join(Opcode op, std::array<uint32_t, 3> in) {
  Term term;
  bool fits = false;
  do {
    term = {Term::Kind::kGate, op, 1, 0, in, {}};
    fits = true;
    for (const uint32_t part : in) {
      fits = term.leaves.add(terms_[part].leaves) && fits;
      term.gates += terms_[part].gates;
    }
    fits = fits && term.gates <= kMostGates;
  } while (!fits && write_largest(in));
  return add(term);
}

void Maker::take(const ir::Unit& u, const LastReads& reads, uint32_t unit) {
  const ir::OpcodeRow& row = ir::opcode_row(u.opcode());
  const bool has_c = row.c.kind != ir::FieldKind::kNone;
  std::array<uint32_t, 3> in{};
  in[1] = read(u.base_b(), u.b, reads.ends_b(unit));
  if (has_c) in[2] = read(u.base_c(), u.c, reads.ends_c(unit));
  if (row.a.reads()) in[0] = read(u.base_a(), u.a, true);
  const uint32_t term = join(u.opcode(), in);
  if (reads.ends_b(unit)) forget(u.base_b(), u.b);
  if (has_c && reads.ends_c(unit)) forget(u.base_c(), u.c);
  const Place place = place_of(u.base_a(), u.a);
  forget(u.base_a(), u.a);
  if (reads.ends_a(unit)) return;
  write_readers(place);
  if (u.base_a() != Base::kFrame) return write(place, term);
  waiting_.push_back({place, term});
  if (waiting_.size() > kMostWaiting) write_waiting(0);
}

std::vector<TruthRow> Maker::finish() {
  while (!waiting_.empty()) write_waiting(waiting_.size() - 1);
  terms_.resize(1);
  return std::exchange(rows_, {});
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

}  // namespace

std::vector<TruthSeries> truth_tables(const ir::LinkedPou& pou, std::span<const ir::Unit> code,
                                      const base::Bytes& pool, uint32_t least, bool all) {
  std::vector<TruthSeries> lines = logic_lines(pou, code, least);
  if (lines.empty()) return lines;
  const LastReads reads(pou, code);
  Maker maker(pool);
  for (TruthSeries& line : lines) {
    for (uint32_t i = 0; i < line.units; ++i) {
      maker.take(code[line.first + i], reads, line.first + i);
    }
    line.rows = maker.finish();
  }
  if (!all) std::erase_if(lines, [](const TruthSeries& s) { return 2 * s.rows.size() > s.units; });
  return lines;
}

void put_truth_tables(const TruthSeries& series, std::vector<ir::Unit>& prepared) {
  ir::Unit& head = prepared[series.first];
  head = {static_cast<uint16_t>(kTruthTables), 0, 0, 0};
  head.set_bc(static_cast<uint32_t>(prepared.size()) - series.first);
  prepared.push_back(ir::Unit::extension(series.units, static_cast<uint32_t>(series.rows.size())));
  for (const TruthRow& row : series.rows) {
    for (const ir::Unit& unit : std::bit_cast<std::array<ir::Unit, kUnitsOfTruthRow>>(row)) {
      prepared.push_back(unit);
    }
  }
}

}  // namespace vm
