// Code over values: arithmetic, comparisons, conversions and characters of strings, for operands
// that are computed already and have types. It writes instructions through the builder and reads
// types; it knows no source, reports nothing, and has no state of its own.
#pragma once

#include "frontend/dialect.h"
#include "frontend/lower/builder.h"
#include "frontend/lower/target.h"
#include "frontend/parse/code_nodes.h"
#include "ir/types/types.h"
#include "stdlib/native/natives.h"

namespace frontend {

class ValueCode {
 public:
  ValueCode(Builder& build, const ir::TypeTable& types, Dialect dialect)
      : build_(build), types_(types), dialect_(dialect) {}

  // --- arithmetic and comparisons (operator.cc)
  ir::ValueId number_op(BinaryOp op, ir::TypeId type, ir::ValueId a, ir::ValueId b);
  Typed time_arithmetic(BinaryOp op, Typed left, Typed right);
  ir::ValueId scale_time(BinaryOp op, ir::ValueId time, Typed factor);
  ir::ValueId power(Typed base, Typed exponent, ir::TypeId own);
  ir::ValueId compare_scalars(BinaryOp op, ir::TypeId type, ir::ValueId a, ir::ValueId b);
  ir::ValueId compare_places(BinaryOp op, const ir::Place& a, const ir::Place& b);
  ir::ValueId extreme_of(bool largest, ir::TypeId type, ir::ValueId a, ir::ValueId b);

  // --- conversions (convert.cc, convert_bcd.cc, string_convert.cc)
  ir::ValueId explicit_conversion(Typed from, ir::TypeId to, bool truncate);
  ir::ValueId machine_convert(ir::ValueId value, ir::Scalar from, ir::Scalar to,
                              bool truncate = false);
  ir::ValueId check_range(ir::ValueId value, ir::TypeId from, ir::TypeId to);
  // Traps unless it holds.
  void require(ir::ValueId condition, ir::TrapKind kind = ir::TrapKind::kConversion);
  ir::ValueId from_time(Typed from, ir::TypeId to);
  ir::ValueId to_time(Typed from, ir::TypeId to);
  ir::ValueId time_to_time(Typed from, ir::TypeId to);
  ir::ValueId floor_modulo(ir::ValueId value, int64_t divisor);
  ir::ValueId narrow_character(ir::ValueId wide_character);
  // convert_bcd.cc. `or_all_bits`: those are the result for what is no BCD, in place of a trap.
  ir::ValueId from_bcd(Typed from, ir::TypeId to, bool or_all_bits = false);
  ir::ValueId to_bcd(Typed from, ir::TypeId to);
  ir::ValueId clamp(ir::ValueId number, ir::Scalar wide, ir::Scalar narrow);

  // --- parts, characters and natives (value.cc, character.cc, standard_time.cc)
  ir::ValueId zero(ir::TypeId type);
  ir::ValueId part_of(ir::ValueId word, ir::Scalar machine, uint32_t offset, uint32_t size);
  ir::ValueId string_value(const ir::Place& place);
  ir::ValueId load_character(const ir::Place& string, ir::ValueId position);
  void store_character(const ir::Place& string, ir::ValueId position, ir::ValueId value);
  ir::ValueId moment_part(ir::ValueId ns, uint32_t part);
  ir::ValueId native(stdlib::NativeId id, ir::ValueList operands);

  // --- handles (reference.cc)
  ir::Place target_place(ir::ValueId handle, ir::TypeId type) const;
  ir::ValueId moved(ir::ValueId handle, ir::ValueId count, ir::TypeId element);

 private:
  const ir::TypeTable& types() const { return types_; }
  ir::Scalar scalar(ir::TypeId type) const { return types_.scalar(type); }
  ir::TypeId elementary(ir::Kind kind) const { return types_.elementary(kind); }
  bool wide(ir::TypeId type) const { return types_[type].kind == ir::Kind::kWstring; }

  Builder& build_;
  const ir::TypeTable& types_;
  const Dialect dialect_;
};

}  // namespace frontend
