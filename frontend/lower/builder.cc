#include "frontend/lower/builder.h"

#include <algorithm>

namespace frontend {
namespace {

size_t hash_of(const ir::Place& place) {
  uint64_t hash = static_cast<uint64_t>(place.base);
  auto mix = [&hash](uint64_t part) { hash = (hash ^ part) * 0x9e3779b97f4a7c15u; };
  mix(place.base_index);
  mix(place.constant.index);
  mix(place.pou.index);
  for (const ir::Step& step : place.steps) {
    mix(static_cast<uint64_t>(step.kind) << 32 | step.index);
    mix(step.value.index);
    mix(static_cast<uint64_t>(step.constant_index));
  }
  return static_cast<size_t>(hash ^ (hash >> 29));
}

}  // namespace

using ir::BlockId;
using ir::Inst;
using ir::Op;
using ir::Place;
using ir::Scalar;
using ir::ValueId;
using ir::ValueList;

BlockId Builder::new_block() {
  pou_.blocks.emplace_back();
  return BlockId(static_cast<uint32_t>(pou_.blocks.size() - 1));
}

void Builder::end_block() {
  pou_.blocks[current_.index].insts.assign(std::make_move_iterator(insts_.begin()),
                                           std::make_move_iterator(insts_.end()));
  insts_.clear();
  current_ = {};
}

void Builder::start(BlockId block) {
  if (current_.valid()) end_block();
  current_ = block;
  pou_.blocks[block.index].handler = handler_;
  order_.push_back(block);
}

ValueId Builder::new_value(Scalar scalar) {
  pou_.values.push_back({scalar});
  return ValueId(static_cast<uint32_t>(pou_.values.size() - 1));
}

ValueId Builder::add_param(BlockId block, Scalar scalar) {
  ValueId value = new_value(scalar);
  pou_.blocks[block.index].params.push_back(value);
  return value;
}

Inst& Builder::emit(Op op, Scalar scalar) {
  if (!current_.valid()) start(new_block());
  Inst& inst = insts_.emplace_back();
  inst.op = op;
  inst.scalar = scalar;
  inst.line = line_;
  return inst;
}

ValueId Builder::result(Inst& inst) {
  inst.result = new_value(inst.scalar);
  return inst.result;
}

// Most places are named again and again: equal ones share a number.
ir::PlaceId Builder::intern(const Place& place) {
  if (pou_.places.size() * 2 >= place_table_.size()) grow_place_table();
  size_t mask = place_table_.size() - 1;
  size_t slot = hash_of(place) & mask;
  for (; place_table_[slot] != 0; slot = (slot + 1) & mask) {
    if (pou_.places[place_table_[slot] - 1] == place) return ir::PlaceId(place_table_[slot] - 1);
  }
  pou_.places.push_back(place);
  place_table_[slot] = static_cast<uint32_t>(pou_.places.size());
  return ir::PlaceId(place_table_[slot] - 1);
}

void Builder::grow_place_table() {
  place_table_.assign(std::max<size_t>(32, place_table_.size() * 2), 0);
  size_t mask = place_table_.size() - 1;
  for (uint32_t i = 0; i < pou_.places.size(); ++i) {
    size_t slot = hash_of(pou_.places[i]) & mask;
    while (place_table_[slot] != 0) slot = (slot + 1) & mask;
    place_table_[slot] = i + 1;
  }
}

ValueId Builder::constant(Scalar scalar, uint64_t bits) {
  Inst& inst = emit(Op::kConst, scalar);
  inst.imm = bits;
  return result(inst);
}

ValueId Builder::load(const Place& place, Scalar scalar) {
  Inst& inst = emit(Op::kLoad, scalar);
  inst.place = intern(place);
  return result(inst);
}

void Builder::store(const Place& place, Scalar scalar, ValueId value) {
  Inst& inst = emit(Op::kStore, scalar);
  inst.place = intern(place);
  inst.operands = {value};
}

void Builder::copy(const Place& target, const Place& source) {
  Inst& inst = emit(Op::kCopy, Scalar::kBool);
  inst.place = intern(target);
  inst.place2 = intern(source);
}

void Builder::init(const Place& place, ir::ConstId constant) {
  Inst& inst = emit(Op::kInit, Scalar::kBool);
  inst.place = intern(place);
  inst.constant = constant;
}

ValueId Builder::address(const Place& place) {
  Inst& inst = emit(Op::kAddress, Scalar::kAddr);
  inst.place = intern(place);
  return result(inst);
}

ValueId Builder::handle(const Place& place) {
  Inst& inst = emit(Op::kHandle, Scalar::kU64);
  inst.place = intern(place);
  return result(inst);
}

ValueId Builder::move_handle(ValueId handle, ValueId bytes) {
  return binary(Op::kMoveHandle, Scalar::kU64, handle, bytes);
}

ValueId Builder::flat(ValueId handle) { return unary(Op::kFlat, Scalar::kU32, handle); }

ValueId Builder::unflat(ValueId address) { return unary(Op::kUnflat, Scalar::kU64, address); }

ValueId Builder::size_of(ir::TypeId type) {
  Inst& inst = emit(Op::kSizeOf, Scalar::kU32);
  inst.type = type;
  return result(inst);
}

ValueId Builder::string(const Place& place, bool wide) {
  Inst& inst = emit(Op::kString, wide ? Scalar::kWstr : Scalar::kStr);
  inst.place = intern(place);
  return result(inst);
}

ValueId Builder::unary(Op op, Scalar scalar, ValueId operand) {
  Inst& inst = emit(op, scalar);
  inst.operands = {operand};
  return result(inst);
}

ValueId Builder::binary(Op op, Scalar scalar, ValueId a, ValueId b) {
  Inst& inst = emit(op, scalar);
  inst.operands = {a, b};
  return result(inst);
}

ValueId Builder::compare(Op op, Scalar scalar, ValueId a, ValueId b) {
  Inst& inst = emit(op, scalar);
  inst.operands = {a, b};
  inst.result = new_value(Scalar::kBool);
  return inst.result;
}

ValueId Builder::select(Scalar scalar, ValueId condition, ValueId if_false, ValueId if_true) {
  Inst& inst = emit(Op::kSelect, scalar);
  inst.operands = {condition, if_false, if_true};
  return result(inst);
}

ValueId Builder::check_range(Scalar scalar, ValueId value, int64_t low, int64_t high) {
  Inst& inst = emit(Op::kCheckRange, scalar);
  inst.operands = {value};
  inst.low = low;
  inst.high = high;
  return result(inst);
}

ValueId Builder::check_step(Scalar scalar, ValueId value) {
  return unary(Op::kCheckStep, scalar, value);
}

void Builder::call_function(ir::PouId pou) { emit(Op::kCallFunction, Scalar::kBool).pou = pou; }

void Builder::call_instance(const Place& place) {
  Inst& inst = emit(Op::kCallInstance, Scalar::kBool);
  inst.place = intern(place);
}

ValueId Builder::this_handle() { return result(emit(Op::kThis, Scalar::kU64)); }

ValueId Builder::is_type(ValueId handle, ir::TypeId type) {
  Inst& inst = emit(Op::kIsType, Scalar::kBool);
  inst.operands = {handle};
  inst.type = type;
  return result(inst);
}

void Builder::call_method(ir::PouId pou) { emit(Op::kCallMethod, Scalar::kBool).pou = pou; }

void Builder::call_method(ir::PouId pou, const Place& place) {
  Inst& inst = emit(Op::kCallMethod, Scalar::kBool);
  inst.pou = pou;
  inst.place = intern(place);
}

void Builder::call_method(ir::PouId pou, ValueId handle) {
  Inst& inst = emit(Op::kCallMethod, Scalar::kBool);
  inst.pou = pou;
  inst.operands = {handle};
}

void Builder::call_virtual(ir::PouId prototype, ValueId handle) {
  Inst& inst = emit(Op::kCallVirtual, Scalar::kBool);
  inst.pou = prototype;
  inst.operands = {handle};
}

void Builder::call_body(ir::PouId pou) { emit(Op::kCallBody, Scalar::kBool).pou = pou; }

ValueId Builder::call_native(uint32_t native, Scalar scalar, ValueList operands) {
  Inst& inst = emit(Op::kCallNative, scalar);
  inst.native = native;
  inst.operands = std::move(operands);
  return result(inst);
}

void Builder::call_native(uint32_t native, ValueList operands) {
  Inst& inst = emit(Op::kCallNative, Scalar::kBool);
  inst.native = native;
  inst.operands = std::move(operands);
}

ValueId Builder::task_time() { return result(emit(Op::kTaskTime, Scalar::kI64)); }

void Builder::advance_time(ValueId ns) {
  emit(Op::kAdvanceTime, Scalar::kI64).operands.push_back(ns);
}

void Builder::jump(BlockId block, ValueList args) {
  emit(Op::kJump, Scalar::kBool).targets.push_back({block, std::move(args)});
  end_block();
}

void Builder::branch(ValueId condition, BlockId if_true, BlockId if_false) {
  Inst& inst = emit(Op::kBranch, Scalar::kBool);
  inst.operands = {condition};
  inst.targets = {{if_true, {}}, {if_false, {}}};
  end_block();
}

void Builder::switch_on(Scalar scalar, ValueId value, int64_t low,
                        const std::vector<BlockId>& targets, BlockId otherwise) {
  Inst& inst = emit(Op::kSwitch, scalar);
  inst.operands = {value};
  inst.low = low;
  inst.high = low + static_cast<int64_t>(targets.size()) - 1;
  inst.targets.push_back({otherwise, {}});
  for (const BlockId target : targets) inst.targets.push_back({target, {}});
  end_block();
}

void Builder::ret() {
  emit(Op::kReturn, Scalar::kBool);
  end_block();
}

void Builder::trap(ir::TrapKind kind) {
  emit(Op::kTrap, Scalar::kBool).trap = kind;
  end_block();
}

ValueId Builder::trap_kind() { return result(emit(Op::kTrapKind, Scalar::kU32)); }

void Builder::trap_again(ValueId kind) {
  emit(Op::kTrapAgain, Scalar::kBool).operands = {kind};
  end_block();
}

void Builder::begin_try(BlockId body, BlockId handler) {
  emit(Op::kTry, Scalar::kBool).targets = {{body, {}}, {handler, {}}};
  end_block();
}

void Builder::end_try(BlockId behind) {
  emit(Op::kEndTry, Scalar::kBool).targets = {{behind, {}}};
  end_block();
}

BlockId Builder::set_handler(BlockId handler) {
  const BlockId before = handler_;
  handler_ = handler;
  return before;
}

uint32_t Builder::temporary(ir::TypeId type) {
  pou_.locals.push_back({"#" + std::to_string(temporaries_++), type, ir::LocalKind::kTemp});
  return static_cast<uint32_t>(pou_.locals.size() - 1);
}

}  // namespace frontend
