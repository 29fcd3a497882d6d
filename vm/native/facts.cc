#include "vm/native/facts.h"

#include <algorithm>
#include <bit>

namespace vm::native {
namespace {

using ir::Opcode;

constexpr size_t kMostLivenessWords = size_t{8} << 20;

// May the execution go on in another POU or in the interpreter? The pointers of some loops are
// moved by the interpreter when they leave their variable.
bool leaves(Opcode op) {
  const bool moves = op == Opcode::HANDLE_ADD || op == Opcode::HANDLE_STEP;
  return moves || is_call(op) || ir::opcode_row(op).traps;
}

bool is_far(Opcode op) { return op >= Opcode::LDFAR_B && op <= Opcode::STFAR_F64; }
bool is_far_store(Opcode op) { return op >= Opcode::STFAR_B && op <= Opcode::STFAR_F64; }
bool names_id(Opcode op) {
  return op == Opcode::INST || op == Opcode::CALL_INST || op == Opcode::CALL_METHOD ||
         op == Opcode::HANDLE_INST;
}
uint64_t key_of(const Access& access) {
  const bool floating = access.cls == ir::Class::kF32 || access.cls == ir::Class::kF64;
  const bool boolean = access.cls == ir::Class::kB;
  return uint64_t{access.offset} << 16 | uint64_t{ir::class_size(access.cls)} << 8 |
         static_cast<uint64_t>(access.base) << 4 | (floating ? 2u : 0u) | (boolean ? 1u : 0u);
}

void add(Accesses& out, const ir::Field& field, ir::Base base, uint16_t offset) {
  if (!field.is_near()) return;
  out.of[out.count++] = {base, offset, field.cls, field.reads(), field.writes(), false};
}

}  // namespace

bool is_call(Opcode op) { return ir::opcode_row(op).calls; }
bool is_switch(Opcode op) { return op >= Opcode::SWITCH_8 && op <= Opcode::SWITCH_64; }

Accesses accesses_of(const ir::Unit& unit) {
  const Opcode op = unit.opcode();
  const ir::OpcodeRow& row = ir::opcode_row(op);
  Accesses out;
  add(out, row.a, unit.base_a(), unit.a);
  add(out, row.b, unit.base_b(), unit.b);
  add(out, row.c, unit.base_c(), unit.c);
  if (is_far(op)) {
    out.of[out.count++] = {unit.base_b(),     unit.bc(),        row.a.cls,
                           !is_far_store(op), is_far_store(op), false};
  } else if (op == Opcode::LD_REF) {
    out.of[out.count++] = {unit.base_b(), unit.bc(), ir::Class::kA, true, false, false};
  } else if (names_id(op)) {
    out.of[out.count++] = {unit.base_b(), unit.bc(), ir::Class::k32, true, false, true};
  }
  return out;
}

base::Result<Facts> Facts::of(const ir::Image& image, const ImageFacts& common,
                              const ir::LinkedPou& pou, const BodyOf& body_of,
                              const std::vector<uint32_t>* unwalked) {
  Facts facts;
  facts.common_ = &common;
  facts.image_ = &image;
  facts.pou_ = &pou;
  facts.code_ = common.code_of(image, pou);
  std::string why;
  if (!facts.find_blocks(why) || !facts.find_loops(why)) {
    return base::Error{base::Refusal::kTooLarge, why};
  }
  facts.find_bodies(body_of);
  facts.find_pinned();
  facts.find_variables();
  facts.find_overlaps();
  facts.walked_.assign(facts.loops_.size(), false);
  if (unwalked != nullptr) facts.find_walked(*unwalked);
  facts.find_reach();
  if (!facts.fits(why)) return base::Error{base::Refusal::kTooLarge, why};
  facts.find_loop_effects();
  if (!facts.find_liveness(why)) return base::Error{base::Refusal::kTooLarge, why};
  facts.find_deferred();
  return facts;
}

bool Facts::find_blocks(std::string& why) {
  std::vector<bool> begins(code_.size() + 1, false);
  begins[0] = true;
  for (const ir::Merge& merge : pou_->merges) begins[merge.unit] = true;
  for (uint32_t i = 0; i < code_.size(); i = next(i)) {
    const Opcode op = code_[i].opcode();
    if (op == Opcode::TRY || op == Opcode::END_TRY || op == Opcode::TRAP_KIND) {
      why = "it has __TRY";
      return false;
    }
    if (op == Opcode::JT || op == Opcode::JF || ir::opcode_row(op).ends) begins[next(i)] = true;
  }
  block_at_.assign(code_.size(), kNone);
  for (uint32_t i = 0; i < code_.size(); i = next(i)) {
    if (begins[i]) blocks_.push_back({i, 0, 0});
    block_at_[i] = static_cast<Block>(blocks_.size() - 1);
    blocks_.back().behind = next(i);
    blocks_.back().last = i;
  }
  for (Block b = 0; b < blocks_.size(); ++b) {
    if (is_switch(code_[blocks_[b].last].opcode())) find_forks(b);
  }
  return true;
}

void Facts::successors(Block block, Block out[2], uint32_t& count) const {
  count = 0;
  if (const Fork* const fork = this->fork(block)) {
    if (fork->below == kNone) return;
    out[count++] = fork->below;
    if (fork->above != fork->below) out[count++] = fork->above;
    return;
  }
  const uint32_t last = blocks_[block].last;
  const Opcode op = code_[last].opcode();
  if (op == Opcode::JT || op == Opcode::JF) {
    out[count++] = block_at_[jump_target(last)];
    out[count++] = block + 1;
  } else if (op == Opcode::JMP || op == Opcode::LOOP) {
    out[count++] = block_at_[jump_target(last)];
  } else if (!ir::opcode_row(op).ends) {
    out[count++] = block + 1;
  }
}

// Back edges make loops; every other way into one must lead through its head.
bool Facts::find_loops(std::string& why) {
  std::vector<uint32_t> last_of(blocks_.size(), kNone);
  for (Block b = 0; b < blocks_.size(); ++b) {
    Block next_blocks[2];
    uint32_t count = 0;
    successors(b, next_blocks, count);
    for (uint32_t i = 0; i < count; ++i) {
      if (next_blocks[i] <= b) last_of[next_blocks[i]] = b;
    }
  }
  loop_of_.assign(blocks_.size(), kNone);
  std::vector<uint32_t> open;
  for (Block b = 0; b < blocks_.size(); ++b) {
    while (!open.empty() && loops_[open.back()].last < b) open.pop_back();
    if (last_of[b] != kNone) {
      Loop loop;
      loop.head = b;
      loop.last = last_of[b];
      loop.parent = open.empty() ? kNone : open.back();
      if (loop.parent != kNone) {
        // Overlapping loops become nested ones.
        for (uint32_t p = loop.parent; p != kNone; p = loops_[p].parent) {
          loops_[p].last = std::max(loops_[p].last, loop.last);
        }
      }
      open.push_back(static_cast<uint32_t>(loops_.size()));
      loops_.push_back(loop);
    }
    loop_of_[b] = open.empty() ? kNone : open.back();
  }
  for (Block b = 0; b < blocks_.size(); ++b) {
    Block next_blocks[2];
    uint32_t count = 0;
    successors(b, next_blocks, count);
    for (uint32_t i = 0; i < count; ++i) {
      for (uint32_t l = loop_of_[next_blocks[i]]; l != kNone; l = loops_[l].parent) {
        const bool inside = b >= loops_[l].head && b <= loops_[l].last;
        if (!inside && next_blocks[i] != loops_[l].head) {
          why = "a jump leads into the middle of a loop";
          return false;
        }
      }
    }
  }
  return true;
}

void Facts::find_pinned() {
  pinned_.assign(pou_->slots.size(), false);
  for (uint32_t i = 0; i < code_.size(); i = next(i)) {
    const ir::OpcodeRow& row = ir::opcode_row(code_[i].opcode());
    const bool by_b = row.b.kind == ir::FieldKind::kBase;
    const bool by_c = row.c.kind == ir::FieldKind::kBase;
    if (!by_b && !by_c) continue;
    if ((by_b ? code_[i].base_b() : code_[i].base_c()) != ir::Base::kFrame) continue;
    const uint32_t offset = by_b ? code_[i + 1].x() : code_[i + 1].y();
    const uint32_t slot = offset < pou_->frame_size ? slot_number(*pou_, offset) : kNone;
    if (slot != kNone) pinned_[slot] = true;
  }
}

void Facts::find_variables() {
  named_.reserve(code_.size() * 2);
  first_named_.resize(code_.size());
  named_count_.resize(code_.size());
  for (uint32_t i = 0; i < code_.size(); i = next(i)) {
    first_named_[i] = static_cast<uint32_t>(named_.size());
    for (const Access& access : accesses_of(code_[i])) {
      if (access.base == ir::Base::kConst) continue;
      const uint32_t number =
          numbers_.add(key_of(access), static_cast<uint32_t>(variables_.size()));
      named_.push_back({number, access.reads, access.writes});
      ++named_count_[i];
      if (number != variables_.size()) {
        variables_[number].constant &= access.id;
        variables_[number].written |= access.writes;
        continue;
      }
      Variable v;
      v.base = base_of(access.base);
      v.offset = access.offset;
      v.width = static_cast<uint8_t>(ir::class_size(access.cls));
      v.floating = access.cls == ir::Class::kF32 || access.cls == ir::Class::kF64;
      v.boolean = access.cls == ir::Class::kB && !common_->clean_bools;
      v.constant = access.id;
      v.written = access.writes;
      if (access.base == ir::Base::kFrame && access.offset < pou_->frame_size) {
        const uint32_t slot = slot_number(*pou_, access.offset);
        v.slot = slot != kNone && !pinned_[slot] && !pou_->slots[slot].aggregate &&
                 pou_->slots[slot].offset == access.offset;
      }
      variables_.push_back(v);
    }
  }
}

uint32_t Facts::variable(const Access& access) const {
  return access.base == ir::Base::kConst ? kNone : numbers_.find(key_of(access));
}

uint32_t Facts::find_variable(const Access& access) const { return numbers_.find(key_of(access)); }

void Facts::find_overlaps() {
  overlaps_.resize(variables_.size());
  std::vector<uint32_t>& order = by_place_;
  order.resize(variables_.size());
  for (uint32_t i = 0; i < order.size(); ++i) order[i] = i;
  std::sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) {
    if (variables_[a].base != variables_[b].base) return variables_[a].base < variables_[b].base;
    return variables_[a].offset < variables_[b].offset;
  });
  for (size_t i = 0; i < order.size(); ++i) {
    const Variable& v = variables_[order[i]];
    for (size_t k = i + 1; k < order.size(); ++k) {
      const Variable& w = variables_[order[k]];
      if (w.base != v.base || w.offset >= v.offset + v.width) break;
      overlaps_[order[i]].push_back(order[k]);
      overlaps_[order[k]].push_back(order[i]);
    }
  }
}

void Facts::find_loop_effects() {
  loop_calls_.assign(loops_.size(), false);
  loop_reads_.resize(loops_.size());
  loop_killed_.resize(loops_.size());
  std::vector<uint32_t> changed;
  const auto make_set = [](std::vector<uint32_t>& list) {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
  };
  for (uint32_t l = 0; l < loops_.size(); ++l) {
    Loop& loop = loops_[l];
    changed.clear();
    const uint32_t behind = blocks_[loop.last].behind;
    for (uint32_t i = blocks_[loop.head].first; i < behind; i = next(i)) {
      if (is_call(code_[i].opcode()) && !has_body(i)) loop_calls_[l] = true;
      for (const auto& [v, reads, writes] : named(i)) {
        if (reads) loop_reads_[l].push_back(v);
        if (!writes) continue;
        changed.push_back(v);
        loop_killed_[l].insert(loop_killed_[l].end(), overlaps_[v].begin(), overlaps_[v].end());
      }
      if (writes_memory(i)) killed(i, loop_killed_[l]);
      if (changed.size() > 4 * variables_.size() + 64) make_set(changed);
      if (loop_reads_[l].size() > 4 * variables_.size() + 64) make_set(loop_reads_[l]);
      if (loop_killed_[l].size() > 4 * variables_.size() + 64) make_set(loop_killed_[l]);
    }
    loop.kills_all = loop_calls_[l];
    make_set(loop_killed_[l]);
    changed.insert(changed.end(), loop_killed_[l].begin(), loop_killed_[l].end());
    make_set(changed);
    make_set(loop_reads_[l]);
    loop.modified = changed;
  }
}

bool Facts::find_liveness(std::string& why) {
  words_ = (variables_.size() + 63) / 64;
  size_t rows = blocks_.size();
  for (uint32_t i = 0; i < code_.size(); i = next(i)) rows += leaves(code_[i].opcode()) ? 1 : 0;
  if (words_ * rows > kMostLivenessWords) {
    why = "it has too many variables and branches";
    return false;
  }
  live_in_.assign(words_ * blocks_.size(), 0);
  std::vector<uint64_t> results(words_, 0);
  std::vector<uint64_t> slots(words_, 0);
  for (uint32_t v = 0; v < variables_.size(); ++v) {
    if (!variables_[v].slot) continue;
    const ir::FrameSlot& slot = pou_->slots[slot_number(*pou_, variables_[v].offset)];
    const bool result =
        slot.kind == ir::SlotKind::kParam &&
        (slot.local == ir::LocalKind::kOutput || slot.local == ir::LocalKind::kReturn);
    slots[v / 64] |= uint64_t{1} << (v % 64);
    if (!result) continue;
    results[v / 64] |= uint64_t{1} << (v % 64);
    results_.push_back(v);
  }
  std::vector<uint64_t> live(words_);
  std::vector<uint32_t> order;
  const auto walk = [&](Block b, bool record) {
    Block next_blocks[2];
    uint32_t count = 0;
    successors(b, next_blocks, count);
    std::fill(live.begin(), live.end(), 0);
    for (uint32_t i = 0; i < count; ++i) {
      for (size_t w = 0; w < words_; ++w) live[w] |= live_in_[size_t{next_blocks[i]} * words_ + w];
    }
    order.clear();
    for (uint32_t i = blocks_[b].first; i < blocks_[b].behind; i = next(i)) order.push_back(i);
    for (auto at = order.rbegin(); at != order.rend(); ++at) {
      const Opcode op = code_[*at].opcode();
      if (op == Opcode::RET) live = results;
      if (record && leaves(op)) {
        const auto row = static_cast<uint32_t>(live_row_.all().size());
        live_row_[*at] = row;
        for (size_t w = 0; w < words_; ++w) live_behind_.push_back(live[w] & slots[w]);
      }
      for (const auto& [v, reads, writes] : named(*at)) {
        if (writes && !reads) live[v / 64] &= ~(uint64_t{1} << (v % 64));
      }
      for (const auto& [v, reads, writes] : named(*at)) {
        if (reads) live[v / 64] |= uint64_t{1} << (v % 64);
      }
    }
  };
  // Without loops the first walk has seen everything that comes after a block.
  const bool once = loops_.empty();
  for (bool changed = true; changed;) {
    changed = false;
    for (Block b = static_cast<Block>(blocks_.size()); b-- > 0;) {
      walk(b, once);
      uint64_t* const in = live_in_.data() + size_t{b} * words_;
      for (size_t w = 0; w < words_; ++w) {
        changed |= !once && in[w] != live[w];
        in[w] = live[w];
      }
    }
  }
  for (Block b = 0; b < blocks_.size() && !once; ++b) walk(b, true);
  return true;
}

bool Facts::killed_in(uint32_t loop, uint32_t variable) const {
  const std::vector<uint32_t>& killed = loop_killed_[loop];
  return std::binary_search(killed.begin(), killed.end(), variable);
}

bool Facts::live_out(Block block, uint32_t variable) const {
  Block next_blocks[2];
  uint32_t count = 0;
  successors(block, next_blocks, count);
  for (uint32_t i = 0; i < count; ++i) {
    if (live_in(next_blocks[i], variable)) return true;
  }
  return false;
}

// Displacements of instructions are signed numbers of 32 bits.
bool Facts::fits(std::string& why) const {
  constexpr uint64_t kMost = (uint64_t{1} << 31) - (uint64_t{1} << 20);
  bool good = true;
  for (const Variable& v : variables_) good &= v.base == MemBase::kData || v.offset < kMost;
  for (const Reach& reach : reach_.all()) {
    for (const Reach::Part& part : reach.parts) {
      good &= part.base == ir::Base::kGlobal || part.end < kMost;
    }
  }
  if (!good) why = "its variables lie too far apart";
  return good;
}

}  // namespace vm::native
