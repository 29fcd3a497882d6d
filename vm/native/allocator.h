// The work of allocate(): the state of registers at one point, as it moves through the blocks.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "vm/native/uses.h"

namespace vm::native {

inline constexpr Val kCopy = 0xfffffffeu;  // in a register: a second copy of a value for one node

class Allocator {
 public:
  Allocator(const Function& function, const Target& target, const AllocatorOptions& options);
  base::Result<Allocated> run();

 private:
  struct Held {
    Val v = kNone;
    int8_t reg = -1;
    bool saved = false;
    bool clean = false;
    uint32_t home = kNone;
    uint32_t slot = kNone;
  };
  using Snapshot = std::vector<Held>;
  struct Pred {
    Block block = 0;
    uint32_t target = 0;
  };

  // allocate.cc: inside of a block
  void node(uint32_t number);
  bool stays_in_memory(const Node& node);
  void operands(const Node& node, const Demands& demands, Step& step);
  Place fixed_operand(Val v, uint32_t reg, const Demands& demands);
  Place operand(const Node& node, uint32_t i, uint32_t forbidden);
  void clobber(const Demands& demands);
  void call_operands(const Node& node, const Demands& demands, Step& step);
  void result(const Node& node, const Demands& demands, Step& step);
  void lose_homes(const Node& node);
  void lose_home(uint32_t variable);
  void take_home(Val v, uint32_t variable, bool clean);
  void record_exit(uint32_t exit);
  void end(Block block);

  // allocator_state.cc
  bool is_constant(Val v) const { return f_.values[v].constant; }
  bool floating(Val v) const { return f_.values[v].floating; }
  // kNone: it is used no more on any way from here.
  uint32_t next_use(Val v, uint32_t from);
  void find_live_out(Block block);
  void add_live(Val v);
  void remove_live(Val v);
  void clear_state();
  Place memory_of(Val v) const;  // kNowhere: it is in a register only
  Place place_of(Val v) const;
  Place place_of(const Held& held) const;
  Place in_register(Val v) const {
    return {Place::kRegister, floating(v), false, static_cast<uint32_t>(reg_[v]), 0};
  }
  uint32_t spill_slot(Val v);
  void put(Val v, uint32_t reg);
  void free_register(Val v);
  void evict(bool floats, uint32_t reg);
  uint32_t take_register(bool floats, uint32_t locked, int hint = -1);
  uint32_t ensure(Val v, uint32_t locked);
  void move(Place to, Place from, uint8_t width);
  void fail(const char* why) {
    if (!why_) why_ = why;
  }

  // allocate_blocks.cc: where ways meet
  void begin(Block block);
  bool lives_into(Block block, Val v, const std::vector<Val>& params) const;
  void restore(const Snapshot& snapshot, Block block);
  void meet(Block block);
  Held met(Val v, Block block);
  static void keep_homes_of_reloads(const BasicBlock& block, Snapshot& state);
  void choose_for_loop(Block block, Snapshot& state);
  uint32_t home_of_parameter(Val p, const Snapshot& state) const;
  void place_parameters(Block block, Snapshot& state);
  void stamp(const Snapshot& snapshot);
  const Held* stamped(Val v) const;
  std::vector<Move> edge(Block from, uint32_t target, const Snapshot& have, const Snapshot& want);
  std::vector<Move> resume_moves(Block head, const Snapshot& state);

  const Function& f_;
  const Target& t_;
  Uses uses_;
  Allocated out_;
  std::vector<Step>* steps_ = nullptr;
  uint32_t position_ = 0;
  uint32_t count_[2];
  uint64_t random_ = 0;
  const char* why_ = nullptr;

  std::array<Val, kMostRegisters> regs_[2];
  std::vector<int8_t> reg_;
  std::vector<uint8_t> saved_;
  std::vector<uint8_t> clean_;
  std::vector<uint32_t> slot_;
  std::vector<uint32_t> home_;
  std::vector<Val> holder_;  // by variable
  std::vector<Val> live_;
  std::vector<uint32_t> live_at_;
  std::vector<uint32_t> free_slots_;
  std::vector<Val> hint_;          // the parameter of a loop head that the value becomes
  std::vector<int8_t> parameter_;  // registers of loop heads' parameters where they begin

  std::span<const Pred> preds(Block block) const {
    return {preds_.data() + first_pred_[block], preds_.data() + first_pred_[block + 1]};
  }
  std::vector<uint32_t> first_pred_;  // by block, in `preds_`
  std::vector<Pred> preds_;
  std::vector<uint32_t> users_;
  std::vector<Snapshot> ends_;
  std::vector<Snapshot> heads_;
  const Snapshot* stamped_ = nullptr;
  std::vector<uint32_t> stamp_of_;
  std::vector<uint32_t> stamp_index_;
  uint32_t stamp_ = 0;
  std::vector<uint32_t> live_out_;  // by value: == block_stamp_
  uint32_t block_stamp_ = 0;
  uint32_t block_end_ = 0;
  std::vector<Val> wanted_, was_;  // of end()
};

}  // namespace vm::native
