#include "vm/native/recipes.h"

#include <array>

namespace vm::native {
namespace {

using Table = std::array<Recipe, ir::kOpcodeCount>;

Recipe make(Shape shape, Op op, uint8_t width, uint8_t from = 0, Cond cond = Cond::kEq,
            bool is_signed = false, bool floating = false, bool towards_zero = false) {
  return {shape, op, width, from, cond, is_signed, floating, towards_zero};
}

#define ROW(name, ...) table[static_cast<size_t>(ir::Opcode::name)] = make(__VA_ARGS__)
#define WORDS(M) M(8, 1) M(16, 2) M(32, 4) M(64, 8)
#define FLOATS(M) M(F32, 4) M(F64, 8)
#define INTEGERS(M) \
  M(I8, 1, true)    \
  M(I16, 2, true)   \
  M(I32, 4, true) M(I64, 8, true) M(U8, 1, false) M(U16, 2, false) M(U32, 4, false) M(U64, 8, false)

void add_words(Table& table) {
#define M(s, w)                                                \
  ROW(MOV_##s, Shape::kMove, Op::kConst, w);                   \
  ROW(ADD_##s, Shape::kBinary, Op::kAdd, w);                   \
  ROW(SUB_##s, Shape::kBinary, Op::kSub, w);                   \
  ROW(MUL_##s, Shape::kBinary, Op::kMul, w);                   \
  ROW(AND_##s, Shape::kBinary, Op::kAnd, w);                   \
  ROW(OR_##s, Shape::kBinary, Op::kOr, w);                     \
  ROW(XOR_##s, Shape::kBinary, Op::kXor, w);                   \
  ROW(NOT_##s, Shape::kUnary, Op::kNot, w);                    \
  ROW(NEG_##s, Shape::kUnary, Op::kNeg, w);                    \
  ROW(SHL_##s, Shape::kShift, Op::kShl, w);                    \
  ROW(SHR_##s, Shape::kShift, Op::kShr, w);                    \
  ROW(ROL_##s, Shape::kShift, Op::kRol, w);                    \
  ROW(ROR_##s, Shape::kShift, Op::kRor, w);                    \
  ROW(EQ_##s, Shape::kCompare, Op::kCompare, w, 0, Cond::kEq); \
  ROW(NE_##s, Shape::kCompare, Op::kCompare, w, 0, Cond::kNe); \
  ROW(CMOV_##s, Shape::kChoose, Op::kSelect, w);               \
  ROW(TOBOOL_##s, Shape::kToBool, Op::kCompare, w);            \
  ROW(CHECK_STEP_##s, Shape::kCheckStep, Op::kExitIf, w);      \
  ROW(LD_##s, Shape::kLoadAt, Op::kLoad, w);                   \
  ROW(ST_##s, Shape::kStoreAt, Op::kStore, w);                 \
  ROW(LDFAR_##s, Shape::kLoadFar, Op::kLoad, w);               \
  ROW(STFAR_##s, Shape::kStoreFar, Op::kStore, w);
  WORDS(M)
#undef M
}

void add_bool(Table& table) {
  ROW(MOV_B, Shape::kMove, Op::kConst, 1);
  ROW(AND_B, Shape::kBinary, Op::kAnd, 1);
  ROW(OR_B, Shape::kBinary, Op::kOr, 1);
  ROW(XOR_B, Shape::kBinary, Op::kXor, 1);
  ROW(ANDN_B, Shape::kBinary, Op::kAndNot, 1);
  ROW(ORN_B, Shape::kBinary, Op::kOrNot, 1);
  ROW(NOT_B, Shape::kUnary, Op::kNotBool, 1);
  ROW(EQ_B, Shape::kCompare, Op::kCompare, 1, 0, Cond::kEq);
  ROW(NE_B, Shape::kCompare, Op::kCompare, 1, 0, Cond::kNe);
  ROW(CMOV_B, Shape::kChoose, Op::kSelect, 1);
  ROW(B_TO_8, Shape::kSame, Op::kConst, 1);
  ROW(LD_B, Shape::kLoadAt, Op::kLoad, 1);
  ROW(ST_B, Shape::kStoreAt, Op::kStore, 1);
  ROW(LDFAR_B, Shape::kLoadFar, Op::kLoad, 1);
  ROW(STFAR_B, Shape::kStoreFar, Op::kStore, 1);
}

void add_integers(Table& table) {
#define M(s, w, sg)                                                                  \
  ROW(DIV_##s, Shape::kDivide, sg ? Op::kDivS : Op::kDivU, w, 0, Cond::kEq, sg);     \
  ROW(MOD_##s, Shape::kDivide, sg ? Op::kModS : Op::kModU, w, 0, Cond::kEq, sg);     \
  ROW(MIN_##s, Shape::kExtreme, Op::kSelectCmp, w, w, sg ? Cond::kLtS : Cond::kLtU); \
  ROW(MAX_##s, Shape::kExtreme, Op::kSelectCmp, w, w, sg ? Cond::kGtS : Cond::kGtU); \
  ROW(LT_##s, Shape::kCompare, Op::kCompare, w, 0, sg ? Cond::kLtS : Cond::kLtU);    \
  ROW(LE_##s, Shape::kCompare, Op::kCompare, w, 0, sg ? Cond::kLeS : Cond::kLeU);    \
  ROW(GT_##s, Shape::kCompare, Op::kCompare, w, 0, sg ? Cond::kGtS : Cond::kGtU);    \
  ROW(GE_##s, Shape::kCompare, Op::kCompare, w, 0, sg ? Cond::kGeS : Cond::kGeU);    \
  ROW(CHECK_##s, Shape::kCheckRange, Op::kExitIf, 8, w, Cond::kEq, sg);              \
  ROW(INDEX_##s, Shape::kIndex, Op::kAddr, 4, w, Cond::kEq, sg);                     \
  ROW(INDEX_PLACE_##s, Shape::kIndexPlace, Op::kAddr, 4, w, Cond::kEq, sg);
  INTEGERS(M)
#undef M
#define M(s, w, sg)                                                                         \
  ROW(s##_TO_F32, Shape::kFromInteger, Op::kIntToFloat, 4, w, Cond::kEq, sg, true);         \
  ROW(s##_TO_F64, Shape::kFromInteger, Op::kIntToFloat, 8, w, Cond::kEq, sg, true);         \
  ROW(ROUND_F32_##s, Shape::kToInteger, Op::kFloatToInt, w, 4, Cond::kEq, sg);              \
  ROW(ROUND_F64_##s, Shape::kToInteger, Op::kFloatToInt, w, 8, Cond::kEq, sg);              \
  ROW(TRUNC_F32_##s, Shape::kToInteger, Op::kFloatToInt, w, 4, Cond::kEq, sg, false, true); \
  ROW(TRUNC_F64_##s, Shape::kToInteger, Op::kFloatToInt, w, 8, Cond::kEq, sg, false, true);
  INTEGERS(M)
#undef M
  // An unsigned number of 64 bits is no signed one.
  for (const ir::Opcode op :
       {ir::Opcode::U64_TO_F32, ir::Opcode::U64_TO_F64, ir::Opcode::ROUND_F32_U64,
        ir::Opcode::ROUND_F64_U64, ir::Opcode::TRUNC_F32_U64, ir::Opcode::TRUNC_F64_U64}) {
    table[static_cast<size_t>(op)] = {};
  }
  ROW(ABS_I8, Shape::kAbsolute, Op::kNeg, 1);
  ROW(ABS_I16, Shape::kAbsolute, Op::kNeg, 2);
  ROW(ABS_I32, Shape::kAbsolute, Op::kNeg, 4);
  ROW(ABS_I64, Shape::kAbsolute, Op::kNeg, 8);
}

void add_floats(Table& table) {
#define M(s, w)                                                              \
  ROW(MOV_##s, Shape::kMove, Op::kConst, w, 0, Cond::kEq, false, true);      \
  ROW(ADD_##s, Shape::kBinary, Op::kFAdd, w, 0, Cond::kEq, false, true);     \
  ROW(SUB_##s, Shape::kBinary, Op::kFSub, w, 0, Cond::kEq, false, true);     \
  ROW(MUL_##s, Shape::kBinary, Op::kFMul, w, 0, Cond::kEq, false, true);     \
  ROW(DIV_##s, Shape::kBinary, Op::kFDiv, w, 0, Cond::kEq, false, true);     \
  ROW(MIN_##s, Shape::kBinary, Op::kFMin, w, 0, Cond::kEq, false, true);     \
  ROW(MAX_##s, Shape::kBinary, Op::kFMax, w, 0, Cond::kEq, false, true);     \
  ROW(NEG_##s, Shape::kUnary, Op::kFNeg, w, 0, Cond::kEq, false, true);      \
  ROW(ABS_##s, Shape::kUnary, Op::kFAbs, w, 0, Cond::kEq, false, true);      \
  ROW(SQRT_##s, Shape::kUnary, Op::kFSqrt, w, 0, Cond::kEq, false, true);    \
  ROW(EQ_##s, Shape::kCompare, Op::kFCompare, w, 0, Cond::kEq);              \
  ROW(NE_##s, Shape::kCompare, Op::kFCompare, w, 0, Cond::kNe);              \
  ROW(LT_##s, Shape::kCompare, Op::kFCompare, w, 0, Cond::kLtS);             \
  ROW(LE_##s, Shape::kCompare, Op::kFCompare, w, 0, Cond::kLeS);             \
  ROW(CMOV_##s, Shape::kChoose, Op::kFSelect, w, 0, Cond::kEq, false, true); \
  ROW(LD_##s, Shape::kLoadAt, Op::kLoad, w, 0, Cond::kEq, false, true);      \
  ROW(ST_##s, Shape::kStoreAt, Op::kStore, w, 0, Cond::kEq, false, true);    \
  ROW(LDFAR_##s, Shape::kLoadFar, Op::kLoad, w, 0, Cond::kEq, false, true);  \
  ROW(STFAR_##s, Shape::kStoreFar, Op::kStore, w, 0, Cond::kEq, false, true);
  FLOATS(M)
#undef M
  ROW(F32_TO_F64, Shape::kUnary, Op::kFloatWidth, 8, 4, Cond::kEq, false, true);
  ROW(F64_TO_F32, Shape::kUnary, Op::kFloatWidth, 4, 8, Cond::kEq, false, true);
  ROW(BITS_32_F32, Shape::kUnary, Op::kBitsToFloat, 4, 4, Cond::kEq, false, true);
  ROW(BITS_64_F64, Shape::kUnary, Op::kBitsToFloat, 8, 8, Cond::kEq, false, true);
  ROW(BITS_F32_32, Shape::kUnary, Op::kFloatToBits, 4, 4);
  ROW(BITS_F64_64, Shape::kUnary, Op::kFloatToBits, 8, 8);
}

void add_conversions(Table& table) {
#define M(from, to)                                                                      \
  ROW(SEXT_##from##_##to, Shape::kExtend, Op::kSext, to / 8, from / 8, Cond::kEq, true); \
  ROW(ZEXT_##from##_##to, Shape::kExtend, Op::kZext, to / 8, from / 8);
  M(8, 16)
  M(8, 32)
  M(8, 64)
  M(16, 32)
  M(16, 64)
  M(32, 64)
#undef M
#define M(from, to) ROW(NARROW_##from##_##to, Shape::kSame, Op::kConst, to / 8, from / 8);
  M(16, 8) M(32, 8) M(32, 16) M(64, 8) M(64, 16) M(64, 32)
#undef M
}

void add_special(Table& table) {
  ROW(MOV_A, Shape::kMove, Op::kConst, 4);
  ROW(MOV_S, Shape::kMove, Op::kConst, 8);
  ROW(MOV_W, Shape::kMove, Op::kConst, 8);
  for (const ir::Opcode op : {ir::Opcode::LEA,
                              ir::Opcode::LEA_AT,
                              ir::Opcode::LD_REF,
                              ir::Opcode::LD_REF_AT,
                              ir::Opcode::ST_REF_AT,
                              ir::Opcode::STR,
                              ir::Opcode::STR_AT,
                              ir::Opcode::WSTR,
                              ir::Opcode::WSTR_AT,
                              ir::Opcode::INST,
                              ir::Opcode::INST_AT,
                              ir::Opcode::CALL,
                              ir::Opcode::CALL_INST,
                              ir::Opcode::CALL_INST_AT,
                              ir::Opcode::CALL_OWN,
                              ir::Opcode::CALL_METHOD,
                              ir::Opcode::CALL_METHOD_AT,
                              ir::Opcode::CALL_REF,
                              ir::Opcode::CALL_METHOD_REF,
                              ir::Opcode::CALL_VIRTUAL,
                              ir::Opcode::TASK_TIME,
                              ir::Opcode::ADVANCE_TIME,
                              ir::Opcode::SIZE_OF,
                              ir::Opcode::RESOLVE,
                              ir::Opcode::HANDLE_ADD,
                              ir::Opcode::HANDLE_STEP,
                              ir::Opcode::HANDLE_INDEX_I64,
                              ir::Opcode::HANDLE_INDEX_U64}) {
    table[static_cast<size_t>(op)].shape = Shape::kSpecial;
  }
}

Table all_recipes() {
  Table table;
  add_words(table);
  add_bool(table);
  add_integers(table);
  add_floats(table);
  add_conversions(table);
  add_special(table);
  return table;
}

}  // namespace

const Recipe& recipe_of(ir::Opcode op) {
  static const Table kTable = all_recipes();
  return kTable[static_cast<size_t>(op)];
}

}  // namespace vm::native
