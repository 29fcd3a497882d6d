// Verified bytecode of one POU -> Function.
//
// Blocks are built in their order, so all ways into a block but those back to a loop head are known
// when it begins; there each live variable is one value or becomes a parameter. A variable that
// nothing read or wrote yet has no value: its memory is loaded when something wants it, before a
// loop for what the loop reads.
#pragma once

#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

#include "stdlib/native/natives.h"

#include "vm/native/facts.h"
#include "vm/native/number_table.h"
#include "vm/native/recipes.h"

namespace vm::native {

class Builder {
 public:
  explicit Builder(const Facts& facts);
  Function run();

 private:
  struct Pred {
    Block block = 0;
    uint32_t target = 0;  // which of its ways
  };
  // What holds where a block ends.
  struct State {
    std::vector<Val> value;      // by variable; kNone: in memory only
    std::vector<uint8_t> dirty;  // by variable: memory is older
  };

  // build.cc
  void find_preds();
  void begin(Block block);
  void merge(Block block);
  void enter_loop(Block block, uint32_t loop);
  void forget_shared();
  Val merged(Block block, uint32_t variable);
  bool is_long_ago(uint32_t variable) const;
  Val at_end_of(Block pred, uint32_t variable);
  void make_parameter(Block block, uint32_t variable);
  void finish(Block block);
  void pass_back(Block block, Block head);
  void store_behind(uint32_t loop);
  void store_before_loop(Block block);
  void end_with_jump(Block target);
  void release(Block pred);

  // build_ops.cc
  void unit(uint32_t number);
  void arithmetic(const Recipe& recipe);
  void shift(const Recipe& recipe);
  // build_division.cc
  void divide(const Recipe& recipe);
  void divide_by_constant(const Recipe& recipe, Val left, uint64_t divisor);
  Val quotient_by_constant(bool is_signed, uint8_t width, Val left, uint64_t divisor);
  Val quotient_of_32_bits(bool is_signed, Val left, uint64_t divisor);
  Val unsigned_quotient(Val left, unsigned bits, uint64_t divisor);
  Val signed_quotient(Val left, uint64_t divisor);
  // build_ops.cc
  void convert(const Recipe& recipe);
  void to_integer(const Recipe& recipe);
  void check_range(const Recipe& recipe);
  void index(const Recipe& recipe, bool of_place);
  void load_at(const Recipe& recipe);
  void store_at(const Recipe& recipe);
  void special();
  Val read_field_id(ir::Base base, uint32_t offset);
  std::optional<Mem> area_of(const Mem& slot);
  Val instance_area(const Mem& slot, Val id);
  void instance(const Mem& slot, Val id);
  bool is_slow(CallKind kind, uint32_t pou) const;
  void call_instance(CallKind kind, uint32_t pou, const Mem& slot, Val id);
  void call(CallKind kind, uint32_t pou, Node made);
  void call_body(Node made);
  void helper();
  void fork(const Fork& fork);
  void leave();

  // build_references.cc
  struct Object {
    Val row = kNone;  // of Context::areas
    Val id = kNone;
    Val type = kNone;
  };
  Val of_context(size_t offset, uint8_t width);
  Val of_table(Val table, Val row, size_t offset, uint8_t width);
  Object object_of(Val handle);
  Val area_of(const Object& object, bool may_be_own);
  void leave_unless_one_of(const std::vector<ir::TypeId>& kinds, Val type);
  Val target_of(Val type, uint32_t prototype);
  void call_reference();
  bool handle();
  void resolve();
  void move_handle();

  // build_memory.cc
  struct Piece {
    uint32_t at = 0;
    uint8_t width = 0;
  };
  Val pool_address(uint32_t offset);
  void make_string(Val address);
  void call_function(stdlib::NativeFunction function, std::span<const Val> arguments, Val result);
  void native();
  void copy_text();
  template <class Visit>
  void each_variable_in(const Mem& mem, uint32_t size, Visit visit) const;
  bool cut(const Mem places[2], uint32_t size, size_t most, std::vector<Piece>& out) const;
  Val read_piece(const Mem& from, const Piece& piece);
  void known_pieces(const Mem& to, std::span<const Piece> pieces, std::span<const Val> values);
  void copy();

  // build_values.cc
  Val constant(uint64_t bits, uint8_t width, bool floating);
  Val zero() { return constant(0, 8, false); }
  Node node(Op op, uint8_t width, Val a = kNone, Val b = kNone, Val c = kNone, Val d = kNone) const;
  Val value_of(Node node, bool floating);  // a pure operation; an equal one before serves
  Val fold(const Node& node);
  void add_shifted(Node& node) const;
  void append(Node node);
  Val int_op(Op op, uint8_t width, Val a, Val b = kNone, Val c = kNone, Val d = kNone);
  Val extended(Val v, uint8_t width, bool is_signed);
  Val read(uint32_t variable);
  Val read_field(ir::Base base, uint32_t offset, ir::Class cls);
  Val read_a();
  Val read_b();
  Val read_c();
  void write(uint32_t variable, Val v);
  void write_a(Val v);
  void write_field(ir::Base base, uint32_t offset, ir::Class cls, Val v);
  Val load(const Mem& mem, uint8_t width, bool floating, bool boolean);
  Val load_id(const Mem& mem);
  void remember(const Mem& mem, uint8_t width, Val value, bool boolean);
  Mem behind(Val address, uint32_t offset) const;
  Mem place(ir::Base base, uint32_t offset) const;
  Val address_of(const Mem& mem);
  void kill_memory();
  void forget_everything();
  const std::vector<uint32_t>& deferred() const;  // in the block's loop
  void store_slot(uint32_t variable);
  void store_deferred();
  uint32_t exit_here(bool everything);
  void exit_if(Cond cond, uint8_t width, Val a, Val b);
  bool is_constant(Val v) const { return f_.values[v].constant; }
  uint64_t bits(Val v) const { return f_.values[v].bits; }

  const Facts& facts_;
  Function f_;
  std::span<const Pred> preds(Block block) const {
    return {preds_.data() + first_pred_[block], preds_.data() + first_pred_[block + 1]};
  }
  std::vector<uint32_t> first_pred_;  // by block, in `preds_`
  std::vector<Pred> preds_;
  std::vector<State> ends_;                        // by block, while something needs it
  std::vector<uint32_t> users_;                    // of ends_
  std::vector<std::vector<uint32_t>> parameters_;  // variables, by block
  State now_;
  std::vector<uint32_t> named_at_;  // by variable: the last unit that read or wrote it
  Block block_ = 0;
  uint32_t unit_ = 0;
  ir::Unit u_;
  ir::Unit x_;
  bool ended_ = false;
  struct {
    Val value = kNone;
    uint8_t width = 0;
  } switched_;  // what the forks of the last SWITCH ask
  uint32_t handle_sites_ = 0;
  uint32_t version_ = 0;            // of memory that no variable names
  uint32_t epoch_ = 0;              // values of earlier epochs are reached through variables only
  std::vector<uint32_t> epoch_of_;  // by value
  NumberTable known_;               // pure nodes, by their hash
  NumberTable constants_[8];        // by bits; of 4 or 8 bytes floating, integers
};

// The hash is equal for operations that give the same value while `version` of memory is the same.
uint64_t hash_of(const Node& node, uint32_t version);
bool same(const Node& a, const Node& b);

// Comparisons into the branches and selections that alone use them; what nothing uses is dead.
void simplify(Function& function);
// What nothing uses any more.
void drop_unused(Function& function);

}  // namespace vm::native
