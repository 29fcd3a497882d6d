#include "ir/lower/opcodes.h"

#include <array>
#include <string>
#include <string_view>
#include <unordered_map>

namespace ir::codegen {
namespace {

constexpr std::string_view kWidth[kScalarCount] = {"B",  "8",  "16",  "32",  "64", "8", "16",
                                                   "32", "64", "F32", "F64", "A",  "S", "W"};
constexpr std::string_view kSign[kScalarCount] = {"B",   "I8",  "I16", "I32", "I64", "U8", "U16",
                                                  "U32", "U64", "F32", "F64", "A",   "S",  "W"};

using ClassRow = std::array<Opcode, kClassCount>;
using ScalarRow = std::array<Opcode, kScalarCount>;
using ScalarGrid = std::array<ScalarRow, kScalarCount>;

class NameIndex {
 public:
  NameIndex() {
    for (uint32_t i = 0; i < kOpcodeCount; ++i) {
      const auto op = static_cast<Opcode>(i);
      index_.emplace(opcode_row(op).name, op);
    }
  }
  ClassRow by_class(const std::string& stem) const {
    ClassRow row{};
    for (uint32_t i = 0; i < kClassCount; ++i) {
      row[i] = find(stem + std::string(class_name(static_cast<Class>(i))));
    }
    return row;
  }
  ScalarRow by_scalar(const std::string& stem,
                      const std::string_view (&suffixes)[kScalarCount]) const {
    ScalarRow row{};
    for (uint32_t i = 0; i < kScalarCount; ++i) row[i] = find(stem + std::string(suffixes[i]));
    return row;
  }
  ScalarGrid by_pair(const std::string& stem, const std::string& joint,
                     const std::string_view (&suffixes)[kScalarCount]) const {
    ScalarGrid grid{};
    for (uint32_t i = 0; i < kScalarCount; ++i) {
      grid[i] = by_scalar(stem + std::string(suffixes[i]) + joint, suffixes);
    }
    return grid;
  }

 private:
  Opcode find(const std::string& name) const {
    const auto found = index_.find(name);
    return found == index_.end() ? kNoOpcode : found->second;
  }
  std::unordered_map<std::string_view, Opcode> index_;
};

// Made once from opcodes.def, then constant.
struct OpcodeTables {
  NameIndex names;
  ClassRow move = names.by_class("MOV_");
  ClassRow conditional_move = names.by_class("CMOV_");
  ClassRow load = names.by_class("LD_");
  ClassRow store = names.by_class("ST_");
  ScalarRow add = names.by_scalar("ADD_", kWidth);
  ScalarRow sub = names.by_scalar("SUB_", kWidth);
  ScalarRow mul = names.by_scalar("MUL_", kWidth);
  ScalarRow div = names.by_scalar("DIV_", kSign);
  ScalarRow mod = names.by_scalar("MOD_", kSign);
  ScalarRow neg = names.by_scalar("NEG_", kWidth);
  ScalarRow abs = names.by_scalar("ABS_", kSign);
  ScalarRow sqrt = names.by_scalar("SQRT_", kSign);
  ScalarRow min = names.by_scalar("MIN_", kSign);
  ScalarRow max = names.by_scalar("MAX_", kSign);
  ScalarRow band = names.by_scalar("AND_", kWidth);
  ScalarRow bor = names.by_scalar("OR_", kWidth);
  ScalarRow bxor = names.by_scalar("XOR_", kWidth);
  ScalarRow bnot = names.by_scalar("NOT_", kWidth);
  ScalarRow shl = names.by_scalar("SHL_", kWidth);
  ScalarRow shr = names.by_scalar("SHR_", kWidth);
  ScalarRow rol = names.by_scalar("ROL_", kWidth);
  ScalarRow ror = names.by_scalar("ROR_", kWidth);
  ScalarRow eq = names.by_scalar("EQ_", kWidth);
  ScalarRow ne = names.by_scalar("NE_", kWidth);
  ScalarRow lt = names.by_scalar("LT_", kSign);
  ScalarRow le = names.by_scalar("LE_", kSign);
  ScalarRow gt = names.by_scalar("GT_", kSign);
  ScalarRow ge = names.by_scalar("GE_", kSign);
  ScalarRow index = names.by_scalar("INDEX_", kSign);
  ScalarRow index_place = names.by_scalar("INDEX_PLACE_", kSign);
  ScalarRow check = names.by_scalar("CHECK_", kSign);
  ScalarRow switch_on = names.by_scalar("SWITCH_", kWidth);
  ScalarRow check_step = names.by_scalar("CHECK_STEP_", kWidth);
  ScalarRow to_bool = names.by_scalar("TOBOOL_", kWidth);
  ScalarGrid sign_extend = names.by_pair("SEXT_", "_", kWidth);
  ScalarGrid zero_extend = names.by_pair("ZEXT_", "_", kWidth);
  ScalarGrid narrow = names.by_pair("NARROW_", "_", kWidth);
  ScalarGrid to_float = names.by_pair("", "_TO_", kSign);
  ScalarGrid round = names.by_pair("ROUND_", "_", kSign);
  ScalarGrid truncate = names.by_pair("TRUNC_", "_", kSign);
  ScalarGrid bits = names.by_pair("BITS_", "_", kWidth);
};

const OpcodeTables& tables() {
  static const OpcodeTables made;
  return made;
}

constexpr uint32_t at(Scalar scalar) { return static_cast<uint32_t>(scalar); }
constexpr uint32_t at(Class cls) { return static_cast<uint32_t>(cls); }

const ScalarRow* row_of(Op op) {
  const OpcodeTables& t = tables();
  switch (op) {
    case Op::kAdd:
      return &t.add;
    case Op::kSub:
      return &t.sub;
    case Op::kMul:
      return &t.mul;
    case Op::kDiv:
      return &t.div;
    case Op::kMod:
      return &t.mod;
    case Op::kNeg:
      return &t.neg;
    case Op::kAbs:
      return &t.abs;
    case Op::kSqrt:
      return &t.sqrt;
    case Op::kMin:
      return &t.min;
    case Op::kMax:
      return &t.max;
    case Op::kAnd:
      return &t.band;
    case Op::kOr:
      return &t.bor;
    case Op::kXor:
      return &t.bxor;
    case Op::kNot:
      return &t.bnot;
    case Op::kShl:
      return &t.shl;
    case Op::kShr:
      return &t.shr;
    case Op::kRol:
      return &t.rol;
    case Op::kRor:
      return &t.ror;
    case Op::kEq:
      return &t.eq;
    case Op::kNe:
      return &t.ne;
    case Op::kLt:
      return &t.lt;
    case Op::kLe:
      return &t.le;
    default:
      return nullptr;
  }
}

}  // namespace

Opcode operation_opcode(Op op, Scalar scalar) {
  const ScalarRow* row = row_of(op);
  return row == nullptr ? kNoOpcode : (*row)[at(scalar)];
}
Opcode greater_opcode(Scalar scalar) { return tables().gt[at(scalar)]; }
Opcode greater_or_equal_opcode(Scalar scalar) { return tables().ge[at(scalar)]; }
Opcode move_opcode(Class cls) { return tables().move[at(cls)]; }
Opcode conditional_move_opcode(Class cls) { return tables().conditional_move[at(cls)]; }
Opcode load_opcode(Class cls) { return tables().load[at(cls)]; }
Opcode store_opcode(Class cls) { return tables().store[at(cls)]; }
Opcode index_opcode(Scalar index) { return tables().index[at(index)]; }
Opcode index_place_opcode(Scalar index) { return tables().index_place[at(index)]; }
Opcode check_range_opcode(Scalar scalar) { return tables().check[at(scalar)]; }
Opcode switch_opcode(Scalar scalar) { return tables().switch_on[at(scalar)]; }
Opcode check_step_opcode(Scalar scalar) { return tables().check_step[at(scalar)]; }
Opcode extend_opcode(Scalar from, Scalar to) {
  const OpcodeTables& t = tables();
  return (is_signed(from) ? t.sign_extend : t.zero_extend)[at(from)][at(to)];
}
Opcode narrow_opcode(Scalar from, Scalar to) { return tables().narrow[at(from)][at(to)]; }
Opcode to_float_opcode(Scalar from, Scalar to) { return tables().to_float[at(from)][at(to)]; }
Opcode round_opcode(Scalar from, Scalar to) { return tables().round[at(from)][at(to)]; }
Opcode truncate_opcode(Scalar from, Scalar to) { return tables().truncate[at(from)][at(to)]; }
Opcode to_bool_opcode(Scalar from) { return tables().to_bool[at(from)]; }
Opcode bits_opcode(Scalar from, Scalar to) { return tables().bits[at(from)][at(to)]; }

}  // namespace ir::codegen
