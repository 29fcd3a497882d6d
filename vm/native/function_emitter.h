// How a Function becomes machine code, as far as that is the same on every machine: the order of
// blocks and of what is seldom, edges and their moves, exits, jump tables, calls, and which
// operation is which.
//
// `Self` (x64/emitter.h, arm64/emitter.h) derives from it and has what is done in another way on
// each machine. `Registers` are its constants:
//   Assembler, Address, at(base, offset), indexed(base, index, scale, offset)
//   kIntegers, kIntegerCount, kFloatCount   what the allocator gives, by its numbers
//   kScratch, kFloatScratch                 free inside of one operation
//   kFrame, kSelf, kData, kContext, kFuel, kStack   stay what they are
//   kId, kPointer, kPouNumber               of the callee; kId also takes addresses of units
//   kRecord, kValue                         free at calls
//   kArguments                              of a C function, six of them
// Members of FunctionEmitter are defined in function_emitter_impl.h, which only emitter.cc of each
// machine includes.
#pragma once

#include <type_traits>

#include "vm/exec/context.h"
#include "vm/native/code_buffer.h"
#include "vm/native/emit.h"
#include "vm/native/jump_tables.h"

namespace vm::native {

// Code that all functions of one piece of memory share.
struct Shared {
  Label enter;      // uint64_t (const void* to, frame, self, data + 2 GiB, Context*)
  Label leave;      // everything but pc and POU is in its register
  Label interpret;  // entry of a POU without code: its number is in kPouNumber
  // Calls resolve_for_code or move_for_code, and every register but the scratch stays what it is.
  Label ask_for_handle = 0;
};

template <class Self, class Registers>
class FunctionEmitter {
 protected:
  using Assembler = typename Registers::Assembler;
  using Address = typename Registers::Address;

  FunctionEmitter(const PouCode& pou, const Shared& shared, Assembler& assembler)
      : pou_(pou),
        f_(*pou.function),
        places_(*pou.places),
        shared_(shared),
        a_(assembler),
        tables_(f_, places_, pou.table_ways) {}

  // All of it; what an earlier call has made is forgotten.
  void function();
  Entries& entries() { return entries_; }

  uint8_t integer_register(const Place& place) const {
    if (place.number >= Registers::kIntegerCount) return Registers::kScratch;
    return Registers::kIntegers[place.number];
  }
  uint8_t float_register(const Place& place) const {
    if (place.number >= Registers::kFloatCount) return Registers::kFloatScratch;
    return static_cast<uint8_t>(place.number);
  }
  // The register that an address begins with; the data memory's where it is kData.
  uint8_t base_register(const Mem& mem, const Place& pointer) const;
  Address spill(uint32_t slot) const { return Registers::at(Registers::kStack, int64_t{slot} * 8); }
  Address variable(uint32_t number) const;
  Address context(size_t offset) const {
    return Registers::at(Registers::kContext, static_cast<int64_t>(offset));
  }

  void load_place(uint8_t to, const Place& from);
  void load_float(uint8_t to, const Place& from, uint8_t width);
  Label exit_label(uint32_t exit);

  const PouCode& pou_;
  const Function& f_;
  const Allocated& places_;
  const Shared& shared_;
  Assembler& a_;
  int32_t frame_bytes_ = 0;  // of the machine's stack

 private:
  struct EdgeStub {  // an edge with moves that something jumps to
    Label label;
    Block block;
    uint32_t target;
  };
  struct TableStub {
    Label label;
    std::vector<Label> entries;
  };
  struct StopStub {  // a helper that trapped
    Label label;
    uint32_t unit;
  };
  struct CallStub {  // out of fuel at a call: the interpreter calls
    Label label;
    uint32_t side;
    uint32_t exit;
  };

  Self& self() { return static_cast<Self&>(*this); }
  const Self& self() const { return static_cast<const Self&>(*this); }

  void entries_of_loops();
  void entries_after_calls();
  void block(Block b);
  void node(const Step& step);
  void end(Block b);
  void branch(Block b);
  void loop_end(Block b);
  void take_turns(Block b);
  void give_back(uint32_t fuel);
  bool only_asks(Block head) const;
  void again(Block from, Block head);
  void jump_by_table(Block b, const JumpTable& table);
  Label label_of(const JumpTable::Way& way);

  void moves(const std::vector<Move>& all);
  void move(const Move& m);
  void move_to_spill(const Move& m);
  void store_place(const Address& to, const Place& from, uint8_t width);

  void stubs();
  void exit_stub(uint32_t exit);
  void store_slots(uint32_t exit, size_t count);
  void store_slot(const SlotValue& slot, const Place& place);
  void leave_at(const ir::Unit* unit);
  void leave_at_unit_in_scratch();
  void tables();

  void call(const Node& node);
  void call_slowly(uint32_t number);
  void enter(const Node& node, const Step& step);
  void push_record(uint32_t call);
  void pop_record();
  void comes_back(uint32_t call);
  void inlined_exit(uint32_t exit);
  void activation(uint32_t inlined);
  void helper(const Node& node, const Step& step);

  Entries entries_;
  std::vector<Label> blocks_;
  std::vector<Label> exits_;
  std::vector<EdgeStub> edges_;
  JumpTables tables_;
  std::vector<TableStub> table_stubs_;
  std::vector<StopStub> stops_;
  std::vector<CallStub> call_stubs_;
  std::vector<Label> inlined_;  // by Function::inlined: makes the activation
  Label leave_ = 0;
};

}  // namespace vm::native
