// Instruction selection: IR blocks -> machine instructions.
//
// A pure value with a single use in its own block is not computed where it is
// defined but where it is used, so that an expression becomes a tree whose leaves
// are memory operands and whose root writes its destination: `x := a AND NOT b OR c`
// is two instructions. A load stays pending until its last use or until something
// may overwrite its place, whichever comes first. What can trap or has an effect
// is never moved.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/result.h"
#include "ir/lower/flow.h"
#include "ir/lower/machine.h"
#include "ir/lower/tables.h"
#include "ir/lower/values.h"
#include "ir/program/alias.h"

namespace ir::codegen {

// Where a place is: a symbolic offset from a fixed root, or from what an addr
// register points to.
struct Location {
  bool behind_addr = false;
  Operand addr;  // register, when behind_addr
  // The path is behind a handle that is not resolved yet: `place` counts from there.
  bool behind_handle = false;
  Operand handle;
  Base base = Base::kFrame;
  ObjectPlace place;
  ConstId constant;  // base kConst; place is then the whole constant
  TypeId constant_type;
};

class Selector {
 public:
  // Adds the named slots to `object`, and to its tables as it goes.
  Selector(const Program& program, const Pou& pou, Object& object);
  base::Result<Machine> run();

 private:
  enum class State : uint8_t { kUnseen, kPending, kInRegister };
  struct ValueState {
    State state = State::kUnseen;
    uint32_t register_number = kNoNumber;
    uint32_t remaining = 0;        // uses not yet selected
    uint32_t depth = 0;            // of a pending tree
    Operand memory;                // a pending load's operand
    const Place* place = nullptr;  // a pending load's place
  };
  struct CachedAddress {
    Operand addr;
    Region region;
    bool by_reference = false;  // forgotten at calls
    bool known = true;
  };
  // What a scalar at a fixed place is, once it was asked for: places are named again and again.
  struct FixedPlace {
    Operand operand;
    Class cls = Class::kB;
  };
  // By prefix_key().
  struct Addresses {
    base::ByteTable numbers;
    std::vector<CachedAddress> rows;
  };

  // select.cc
  void add_named_slots();
  void clean_given_texts();
  void select_block(uint32_t position);
  void select_inst(const Inst& inst);
  void select_value(const Inst& inst);
  void select_load(const Inst& inst);
  void load_memory(const Inst& inst, Operand memory);
  void pend_load(const Inst& inst, Operand memory);
  void select_check(const Inst& inst);
  bool deferrable(const Inst& inst) const;
  void defer(const Inst& inst);

  // pending.cc
  using Conflicts = std::function<bool(const Place&)>;
  using OwnValues = base::InlineVector<ValueId, 8>;
  OwnValues own_values(const Inst& inst) const;
  void flush(const OwnValues& own, const Conflicts& conflicts);
  void flush_all(const Inst& inst);
  void flush_writes(const Inst& inst, const Place& written);
  void flush_call(const Inst& inst);
  void flush_native(const Inst& inst);
  void materialise(ValueId value);
  ValueList operands_of(const Inst& inst) const;
  void count_in_tree(ValueId value, OwnValues& counted) const;
  bool reads(ValueId value, const Conflicts& conflicts) const;
  void consume(ValueId value);
  Operand use(ValueId value);
  void assign(Operand dest, ValueId value);

  // compute.cc
  void compute(const Inst& inst, Operand dest);
  void compute_binary(const Inst& inst, Operand dest);
  void compute_logic(const Inst& inst, Operand dest);
  void compute_not(const Inst& inst, Operand dest);
  void compute_compare(const Inst& inst, bool negated, Operand dest);
  void compute_bool_order(const Inst& inst, bool negated, Operand dest);
  void compute_select(const Inst& inst, Operand dest);
  void compute_conversion(const Inst& inst, Operand dest);
  bool take_not(ValueId& value);
  const Inst* pending_definition(ValueId value) const;

  // registers.cc
  Operand new_register(Class cls, Region region, bool single_use);
  Operand register_for(ValueId value);
  Region region_of(ValueId value) const;
  Region region_of(ValueId value, uint32_t depth) const;
  Class class_of_value(ValueId value) const;
  void emit(Opcode op, Operand a, Operand b = {}, Operand c = {}, uint32_t x = 0, uint32_t y = 0);
  Operand legal_source(const Field& field, Operand operand);
  void move(Class cls, Operand dest, Operand source);
  bool retarget(Operand dest, Operand source);
  MachineBlock& block() { return machine_.blocks.back(); }

  // place.cc
  Location locate(const Place& place);
  void walk(Location& at, const Place& place, size_t next);
  Location root_of(const Place& place);
  void step_index(Location& at, const Place& place, size_t number);
  void step_dynamic_index(Location& at, Operand index, Scalar index_scalar,
                          const std::string& name);
  void step_enter(Location& at);
  void step_dereference(Location& at);
  size_t resume_from_cache(Location& at, const Place& place);
  const CachedAddress* find_address(const std::string& key) const;
  void keep_address(const std::string& key, const CachedAddress& address);
  void remember(const Place& place, size_t steps, const Location& at);
  const std::string& prefix_key(const Place& place, size_t steps);  // until the next one
  void behind(Location& at, Operand addr, Region region) const;
  uint32_t offset_of(const Location& at) { return tables_.place(at.place); }
  Operand field_of(const Location& at);
  uint32_t extension_of(const Location& at);
  bool is_scalar_leaf(const Location& at) const;
  Operand operand_of(const Location& at, Class cls);
  // Nothing when it is not fixed, or was not asked for.
  Operand fixed_operand(PlaceId place, Class cls) const {
    const FixedPlace& fixed = fixed_[place.index];
    return fixed.cls == cls ? fixed.operand : Operand();
  }
  Operand fix_operand(PlaceId place, const Location& at, Class cls);

  // reference.cc
  Location locate_target(const Place& place);
  Location unresolved(const Place& place);
  void index_handle(Location& at, Operand index, Scalar scalar, uint32_t bound, Region element);
  void resolve(Location& at, Operand dest);
  void compute_handle(const Inst& inst, Operand dest);
  void handle_into(const Location& at, Operand dest);
  void instance_handle_into(const Location& at, Operand dest);

  // place_facts.cc
  std::string place_name(const Place& place, size_t steps) const;
  std::optional<uint64_t> constant_scalar(const Place& place) const;

  // memory.cc
  void select_store(const Inst& inst);
  void store_operand(const Location& at, Class cls, Operand source);
  void select_copy(const Inst& inst);
  void select_init(const Inst& inst);
  void bind_reference(const Inst& inst);
  void compute_address(const Inst& inst, Operand dest);
  void compute_string(const Inst& inst, Operand dest);
  void load_into(const Location& at, Class cls, Operand dest);
  Operand address_of(const Location& at);
  void address_into(const Location& at, Operand dest);
  Operand string_of(const Location& at, TypeId type);
  void string_into(const Location& at, TypeId type, Operand dest);
  void copy_value(const Location& to, TypeId to_type, const Location& from, TypeId from_type);
  uint64_t default_bits(TypeId type) const;
  Location initial_value(TypeId type, ConstId constant);
  void copy_whole(const Location& to, TypeId type, const Location& from);

  // call.cc
  void select_call(const Inst& inst);
  void select_call_instance(const Inst& inst);
  void select_object_call(const Inst& inst);
  void select_call_on_place(const Inst& inst, uint32_t callee);
  void select_native(const Inst& inst);
  void forget_references();

  // end.cc
  void select_end(const Inst& inst, const FlowBlock& flow_block);
  void select_edge(const FlowBlock& flow_block);
  void select_branch(const Inst& inst, const FlowBlock& flow_block);
  void select_switch(const Inst& inst, const FlowBlock& flow_block);
  void pass_arguments(const Target& target);
  void parallel_move(std::vector<std::pair<Operand, Operand>> moves);

  void fail(base::Refusal refusal, std::string text);
  const TypeTable& types() const { return program_.types; }

  const Program& program_;
  const Pou& pou_;
  Object& object_;
  Tables tables_;
  Flow flow_;
  Values values_;
  Machine machine_;
  std::vector<ValueState> states_;
  std::vector<FixedPlace> fixed_;  // by place
  std::vector<ValueId> pending_;
  std::vector<uint32_t> local_registers_;  // kNoNumber for aggregates
  Addresses addresses_;                    // of this block
  std::string prefix_key_;
  uint32_t line_ = 0;
  std::optional<base::Error> error_;
};

}  // namespace ir::codegen
