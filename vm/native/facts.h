// What the bytecode of one POU says before anything is built: its blocks and loops, which scalars
// it names, and what a store through an address may change. Nothing here depends on order.
#pragma once

#include <bit>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "base/result.h"
#include "ir/bytecode/image.h"
#include "ir/bytecode/pou_version.h"
#include "vm/native/lir.h"
#include "vm/native/number_table.h"

namespace vm::native {

constexpr MemBase base_of(ir::Base base) {
  if (base == ir::Base::kFrame) return MemBase::kFrame;
  return base == ir::Base::kSelf ? MemBase::kSelf : MemBase::kData;
}

// A scalar that a unit reads or writes where it lies.
struct Access {
  ir::Base base = ir::Base::kFrame;
  uint32_t offset = 0;
  ir::Class cls = ir::Class::kB;
  bool reads = false;
  bool writes = false;
  bool id = false;  // of an instance
};
struct Accesses {
  Access of[4];
  uint32_t count = 0;
  const Access* begin() const { return of; }
  const Access* end() const { return of + count; }
};
Accesses accesses_of(const ir::Unit& unit);

// What an address may point to, of the variables that code names directly.
struct Reach {
  struct Part {
    ir::Base base = ir::Base::kFrame;
    uint64_t begin = 0;
    uint64_t end = 0;
    friend bool operator==(const Part&, const Part&) = default;
  };
  bool everything = false;
  bool own_instance = false;  // any variable of it
  std::vector<Part> parts;
  bool join(const Reach& other);  // changed?
};

struct UnitRange {
  uint32_t first = 0;
  uint32_t behind = 0;
  uint32_t last = 0;  // the last instruction
};

// Numbers below `edge` go on at `below`, the others at `above`.
struct Fork {
  uint64_t edge = 0;
  Block below = kNone;  // kNone: nothing leads to this block
  Block above = kNone;
};

// Where the instances inside of all instances of a type lie, seen from these: of the slots from
// offset `slot` on, the first is at `first`, and each next one `stride` bytes behind.
struct Children {
  uint32_t slot = 0;
  uint32_t count = 0;
  int64_t first = 0;
  int64_t stride = 0;
};

// What all POUs of an image have in common.
struct ImageFacts {
  // `other_code` stands for that of the image, sorted by POU; borrowed.
  ImageFacts(const ir::Image& image, bool are_bools_clean,
             std::span<const ir::PouVersion> other_code = {});
  const ir::PouVersion* version_of(uint32_t pou) const;  // null: it has none
  std::span<const ir::Unit> code_of(const ir::Image& image, const ir::LinkedPou& pou) const;
  std::span<const ir::PouVersion> versions;
  // By their slots; what differs between instances of the type is left out.
  const std::vector<Children>& children(ir::TypeId type) const;
  std::vector<uint32_t> body_of;  // by type: the POU that runs when its instance is called; kNone
  // The type of a function block and those that extend it; null: they are many, or it is none.
  const std::vector<ir::TypeId>* kinds_of(ir::TypeId type) const;
  // What a call of the prototype runs, by type; none: too many.
  std::vector<ir::LinkedOverride> targets_of(uint32_t prototype) const;
  // Do values of the type hold IDs or in-outs, or is it an instance's?
  bool has_slots(ir::TypeId type) const;
  bool recursive_bodies = false;   // does any block call itself?
  bool recursive_methods = false;  // or any method?
  bool clean_bools = false;        // are all BOOLs in memory 0 or 1?

 private:
  bool same_for_all(ir::TypeId type, Children& children) const;
  const ir::Image& image_;
  std::vector<std::vector<uint32_t>> instances_of_;  // live ones, by type and what it is made from
  mutable ByKey<std::vector<Children>> children_;    // by type: as far as asked for
  std::vector<uint64_t> extensions_;              // base in the upper half, what extends it; sorted
  std::vector<uint32_t> by_prototype_;            // rows of Image::overrides, sorted
  mutable std::vector<bool> with_slots_;          // by type, when something has asked
  mutable ByKey<std::vector<ir::TypeId>> kinds_;  // by type: as far as asked for
};
// The frame slot that covers the offset, or the last one in front of it; kNone: there is none.
uint32_t slot_number(const ir::LinkedPou& pou, uint32_t offset);
// The POU that a CALL_INST or CALL_INST_AT runs; kNone: it depends.
uint32_t called_body(const ir::Image& image, const ImageFacts& common, const ir::LinkedPou& pou,
                     const ir::Unit& unit);

// May code of both be executed for one instance?
bool may_share_instance(const ir::Image& image, const ir::LinkedPou& a, const ir::LinkedPou& b);

// May an instance of the type, or of what extends it, be the one that the POU runs for?
bool may_be_own(const ir::Image& image, const ir::LinkedPou& pou, ir::TypeId type);

// What a body in the place of its call may do to memory that the caller names.
struct Effects {
  struct Use {
    bool everywhere = false;                          // through an address
    bool own_instance = false;                        // of the callee
    std::vector<std::pair<uint64_t, uint64_t>> data;  // of the globals: [begin, end)
  };
  Use reads, writes;
};
// A small POU, made once, to stand in the place of its calls.
struct Body {
  Function function;
  Effects effects;
};
Effects effects_of(const Function& body);

// In the place of a call: the body of a POU, on instances of `type` where the call may run several.
struct InPlace {
  const Body* body = nullptr;
  uint32_t pou = 0;
  ir::TypeId type = {};
};

class Facts {
 public:
  // The body that stands in the place of calls of a POU; null: it is called.
  using BodyOf = std::function<const Body*(uint32_t pou)>;
  // kTooLarge and others: why this POU stays with the interpreter. Borrows everything.
  // `unwalked`: first units of loops whose pointers are followed one by one; null: all of them.
  static base::Result<Facts> of(const ir::Image& image, const ImageFacts& common,
                                const ir::LinkedPou& pou, const BodyOf& body_of = {},
                                const std::vector<uint32_t>* unwalked = nullptr);

  const ir::Image& image() const { return *image_; }
  const ir::LinkedPou& pou() const { return *pou_; }
  const ir::Unit& unit(uint32_t number) const { return code_[number]; }
  const ir::Unit& extension(uint32_t number) const {
    return ir::opcode_row(code_[number].opcode()).extended ? code_[number + 1] : code_[number];
  }
  uint32_t next(uint32_t number) const {
    return number + (ir::opcode_row(code_[number].opcode()).extended ? 2 : 1);
  }
  uint32_t jump_target(uint32_t number) const {
    return static_cast<uint32_t>(number + 1 + static_cast<int32_t>(code_[number].bc()));
  }

  const std::vector<UnitRange>& blocks() const { return blocks_; }
  // A SWITCH is a tree of comparisons of its value less `low`: its own block and those of the JMPs
  // after it are the forks. Null: the block is no part of one.
  const Fork* fork(Block block) const {
    const auto found = forks_.find(block);
    return found == forks_.end() ? nullptr : &found->second;
  }
  Block block_at(uint32_t unit) const { return block_at_[unit]; }
  const std::vector<Loop>& loops() const { return loops_; }
  uint32_t loop_of(Block block) const { return loop_of_[block]; }  // innermost, or kNone
  // A call that no body stands for.
  bool has_call(uint32_t loop) const { return loop_calls_[loop]; }
  // Is it taken that what pointers lead to in the loop is no variable that it names?
  // walk_pointers() has to ask for that.
  bool is_walked(uint32_t loop) const { return loop != kNone && walked_[loop]; }
  // In the place of the call at the unit; none: it calls.
  std::span<const InPlace> bodies_at(uint32_t unit) const;
  bool has_body(uint32_t unit) const { return !bodies_at(unit).empty(); }
  // Is the variable's memory changed in the loop other than by its name?
  bool killed_in(uint32_t loop, uint32_t variable) const;
  // Variables that the loop may keep in registers, their memory being older until it ends or is
  // left; sorted.
  const std::vector<uint32_t>& deferred(uint32_t loop) const { return loop_deferred_[loop]; }
  // Variables that something in the loop reads, sorted.
  const std::vector<uint32_t>& reads(uint32_t loop) const { return loop_reads_[loop]; }

  const std::vector<Variable>& variables() const { return variables_; }
  const std::vector<std::vector<uint32_t>>& overlaps() const { return overlaps_; }
  uint32_t variable(const Access& access) const;       // kNone: a constant
  uint32_t find_variable(const Access& access) const;  // kNone: no code names it
  // Variables whose memory the unit may change beside what its fields name.
  void killed(uint32_t unit, std::vector<uint32_t>& out) const;
  // Variables whose memory the unit may read through an address.
  void seen(uint32_t unit, std::vector<uint32_t>& out) const;
  // May the two places of a COPY two places have bytes in common?
  bool may_overlap(uint32_t unit) const;
  uint32_t copied_bytes(uint32_t unit) const;
  // Does it change memory that no variable names?
  bool writes_memory(uint32_t unit) const;

  // Variables whose value at the block's beginning something reads before it is written.
  bool live_in(Block block, uint32_t variable) const {
    return live_in_[size_t{block} * words_ + variable / 64] >> (variable % 64) & 1;
  }
  bool live_out(Block block, uint32_t variable) const;
  // Visits the slots that are live after the unit, which calls or may leave.
  template <class Visit>
  void each_live_behind(uint32_t unit, Visit visit) const {
    const uint32_t* const row = live_row_.find(unit);
    if (row == nullptr) return;
    for (size_t w = 0; w < words_; ++w) {
      for (uint64_t left = live_behind_[*row * words_ + w]; left != 0; left &= left - 1) {
        visit(static_cast<uint32_t>(w * 64) + static_cast<uint32_t>(std::countr_zero(left)));
      }
    }
  }
  // Slots that the caller reads.
  const std::vector<uint32_t>& results() const { return results_; }
  // The POU that the unit calls; kNone: it depends.
  uint32_t callee(uint32_t unit) const;
  // The children of the own instance's slot at `offset`; null: they may lie anywhere.
  const Children* children(uint64_t offset) const;
  bool recursive_bodies() const { return common_->recursive_bodies; }
  bool recursive_methods() const { return common_->recursive_methods; }
  // What the reference of a call may name (ImageFacts::kinds_of); null: nobody knows.
  const std::vector<ir::TypeId>* kinds_called(uint32_t unit) const;
  bool has_slots(ir::TypeId type) const { return common_->has_slots(type); }
  const std::vector<ir::TypeId>* kinds_of(ir::TypeId type) const { return common_->kinds_of(type); }
  // Does the RESOLVE give the area of an instance of one of kinds_of() the type, from its
  // beginning?
  bool resolves_instance(uint32_t unit) const {
    return extension(unit).y() == 0 && kinds_of(ir::region_of_field(extension(unit).x()).type);
  }
  // Does machine code follow the handle of the RESOLVE to bytes of a variable? Else it finds an
  // instance, or a handler looks for it.
  bool follows_bytes(uint32_t unit) const;
  bool may_be_own(ir::TypeId type) const { return native::may_be_own(*image_, *pou_, type); }
  bool clean_bools() const { return common_->clean_bools; }
  void successors(Block block, Block out[2], uint32_t& count) const;

 private:
  bool find_blocks(std::string& why);
  void find_forks(Block block);
  bool find_loops(std::string& why);
  bool fits(std::string& why) const;
  void find_bodies(const BodyOf& body_of);
  bool find_body(const BodyOf& body_of, uint32_t unit, std::vector<InPlace>& out) const;
  void used_by_body(uint32_t pou, const Effects::Use& use, std::vector<uint32_t>& out) const;
  void find_pinned();
  void find_variables();
  void find_overlaps();
  void find_walked(const std::vector<uint32_t>& unwalked);
  void find_reach();
  Reach reach_of_unit(uint32_t unit) const;
  void find_targets();
  void find_loop_effects();
  void find_deferred();
  void touched(const Reach& reach, std::vector<uint32_t>& out) const;
  bool find_liveness(std::string& why);
  // What accesses_of() says of the unit, but for constants.
  struct Named {
    uint32_t variable = 0;
    bool reads = false;
    bool writes = false;
  };
  std::span<const Named> named(uint32_t unit) const {
    return std::span(named_).subspan(first_named_[unit], named_count_[unit]);
  }

  const ir::Image* image_ = nullptr;
  const ImageFacts* common_ = nullptr;
  const ir::LinkedPou* pou_ = nullptr;
  std::span<const ir::Unit> code_;
  std::vector<UnitRange> blocks_;
  std::vector<Block> block_at_;
  std::unordered_map<Block, Fork> forks_;
  std::vector<Loop> loops_;
  std::vector<uint32_t> loop_of_;
  std::vector<bool> loop_calls_;
  std::vector<bool> walked_;            // by loop
  ByKey<std::vector<InPlace>> bodies_;  // by unit
  std::vector<std::vector<uint32_t>> loop_reads_;
  std::vector<std::vector<uint32_t>> loop_killed_;
  std::vector<std::vector<uint32_t>> loop_deferred_;
  std::vector<bool> pinned_;  // by frame slot: something else knows where it is
  std::vector<Variable> variables_;
  std::vector<Named> named_;
  std::vector<uint32_t> first_named_;  // by unit
  std::vector<uint8_t> named_count_;
  NumberTable numbers_;  // of variables
  std::vector<std::vector<uint32_t>> overlaps_;
  std::vector<uint32_t> by_place_;  // variables by base, then offset
  ByKey<Reach> reach_;              // by offset of a frame slot with an address
  ByKey<Reach> targets_, sources_;  // by unit: what it writes, what COPY and walks read
  std::vector<uint32_t> results_;
  size_t words_ = 0;
  std::vector<uint64_t> live_in_;
  std::vector<uint64_t> live_behind_;  // rows of `words_`: a bit for each variable
  ByKey<uint32_t> live_row_;           // by unit
};

bool is_switch(ir::Opcode op);

// Does the unit leave the POU for another, so that all slots must be in memory?
bool is_call(ir::Opcode op);

}  // namespace vm::native
