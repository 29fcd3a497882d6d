// Writes the instructions of one POU, block by block. Code after a terminator goes
// into blocks that nothing reaches; finish() removes those.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "ir/program/ir.h"

namespace frontend {

class Builder {
 public:
  explicit Builder(ir::Pou& pou) : pou_(pou) { start(new_block()); }

  void set_line(uint32_t line) { line_ = line; }
  uint32_t line() const { return line_; }

  ir::BlockId new_block();
  void start(ir::BlockId block);
  ir::ValueId add_param(ir::BlockId block, ir::Scalar scalar);
  // False after a terminator.
  bool reachable() const { return current_.valid(); }
  // Blocks in the order in which they were started; what was written is in those that have ended.
  std::span<const ir::BlockId> blocks() const { return order_; }

  ir::ValueId constant(ir::Scalar scalar, uint64_t bits);
  ir::ValueId load(const ir::Place& place, ir::Scalar scalar);
  void store(const ir::Place& place, ir::Scalar scalar, ir::ValueId value);
  void copy(const ir::Place& target, const ir::Place& source);
  void init(const ir::Place& place, ir::ConstId constant);
  ir::ValueId address(const ir::Place& place);
  ir::ValueId handle(const ir::Place& place);
  ir::ValueId move_handle(ir::ValueId handle, ir::ValueId bytes);
  ir::ValueId flat(ir::ValueId handle);
  ir::ValueId unflat(ir::ValueId address);
  ir::ValueId size_of(ir::TypeId type);
  ir::ValueId string(const ir::Place& place, bool wide);
  ir::ValueId unary(ir::Op op, ir::Scalar scalar, ir::ValueId operand);
  ir::ValueId binary(ir::Op op, ir::Scalar scalar, ir::ValueId a, ir::ValueId b);
  // kEq, kNe, kLt, kLe of two values of `scalar`.
  ir::ValueId compare(ir::Op op, ir::Scalar scalar, ir::ValueId a, ir::ValueId b);
  ir::ValueId select(ir::Scalar scalar, ir::ValueId condition, ir::ValueId if_false,
                     ir::ValueId if_true);
  ir::ValueId check_range(ir::Scalar scalar, ir::ValueId value, int64_t low, int64_t high);
  ir::ValueId check_step(ir::Scalar scalar, ir::ValueId value);
  void call_function(ir::PouId pou);
  void call_instance(const ir::Place& place);
  // Objects: on the own instance, on a place, on what a reference leads to.
  ir::ValueId this_handle();
  ir::ValueId is_type(ir::ValueId handle, ir::TypeId type);
  void call_method(ir::PouId pou);
  void call_method(ir::PouId pou, const ir::Place& place);
  void call_method(ir::PouId pou, ir::ValueId handle);
  void call_virtual(ir::PouId prototype, ir::ValueId handle);
  void call_body(ir::PouId pou);
  ir::ValueId call_native(uint32_t native, ir::Scalar result, ir::ValueList operands);
  void call_native(uint32_t native, ir::ValueList operands);
  ir::ValueId task_time();
  ir::ValueId trap_kind();
  void advance_time(ir::ValueId ns);

  void jump(ir::BlockId block, ir::ValueList args = {});
  void branch(ir::ValueId condition, ir::BlockId if_true, ir::BlockId if_false);
  // `targets`: of low, low + 1, ...
  void switch_on(ir::Scalar scalar, ir::ValueId value, int64_t low,
                 const std::vector<ir::BlockId>& targets, ir::BlockId otherwise);
  void ret();
  void trap(ir::TrapKind kind);
  // The last caught trap goes on; `kind` is its kind.
  void trap_again(ir::ValueId kind);
  void begin_try(ir::BlockId body, ir::BlockId handler);
  void end_try(ir::BlockId behind);
  // The handler of the blocks that are started from here on; invalid: none. Returns the one before.
  ir::BlockId set_handler(ir::BlockId handler);

  // A variable of the frame that no source name means.
  uint32_t temporary(ir::TypeId type);

  void finish();

 private:
  ir::Inst& emit(ir::Op op, ir::Scalar scalar);
  void end_block();  // after its terminator
  ir::ValueId result(ir::Inst& inst);
  ir::PlaceId intern(const ir::Place& place);
  void grow_place_table();
  ir::ValueId new_value(ir::Scalar scalar);

  ir::Pou& pou_;
  ir::BlockId current_;
  std::vector<ir::Inst> insts_;  // of the current block; it gets no more room than they need
  ir::BlockId handler_;
  std::vector<ir::BlockId> order_;     // in which blocks were started: the final order
  std::vector<uint32_t> place_table_;  // open addressing; place number + 1, 0: free
  uint32_t line_ = 0;
  uint32_t temporaries_ = 0;
};

}  // namespace frontend
