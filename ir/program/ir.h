// The intermediate representation: a typed program in SSA form, per POU, with
// symbolic places instead of addresses. Produced by frontend/lower, checked by
// verify.h, run by evaluate.h (the oracle), turned into objects by ir/lower.
//
// Values and blocks. A value is the result of one instruction or one block
// parameter; ValueIds index Pou::values. Jumps and branches pass arguments to the
// parameters of their target. A use must be dominated by its definition. Scalars
// only: structures, arrays, strings and instances live in places.
//
// Places. base, then steps, from left to right:
//   kLocal  base_index = Pou::locals         kSelf    the POU's own instance
//   kGlobal the globals pseudo instance      kConst   constant of `constant`/`type` (read only)
//   kArg    local number base_index of callee `pou` (see Calls)
//   kPointee the target of addr value `value`, of type base_type
// Steps: kMember(index) of a structure, or of the instance that a place has
// already entered (kSelf and kGlobal are entered); kIndex(value or constant),
// one per dimension, each bounds-checked (kIndex trap); kEnter: from an instance
// slot to the instance's own variables; kDeref: from an in-out slot (a member or
// local of Section kInOut) to its target (kReference trap when unbound).
//
// Calls. Function arguments travel through kArg places: evaluate everything
// first, then store or copy each argument, bind in-outs with `address` + `store`
// of addr, then `call`, then load results from kArg places. No other call may
// come between the first kArg write and the call, and kArg results are valid
// until the next call. All inputs, in-outs of the callee are written at each call;
// a callee initialises its own other locals. FB inputs are stored into the
// instance (place ... kEnter, kMember), then `call_instance`, then outputs are
// loaded from it.
//
// Execution order is program order; all trapping is precise.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/hash.h"
#include "base/ids.h"
#include "ir/types/constants.h"
#include "ir/types/types.h"

namespace ir {

struct PouTag;
struct BlockTag;
struct ValueTag;
using PouId = base::Id<PouTag>;      // index into Program::pous
using BlockId = base::Id<BlockTag>;  // index into Pou::blocks
using ValueId = base::Id<ValueTag>;  // index into Pou::values

enum class Op : uint8_t {
#define OP(id, text, operands, result) id,
#include "ir/program/ops.def"
#undef OP
};

enum class TrapKind : uint8_t {
#define TRAP(id, text, title, help) id,
#include "ir/program/traps.def"
#undef TRAP
};
inline constexpr uint32_t kTrapCount = 12;
const char* trap_name(TrapKind kind);   // "division-by-zero"
const char* trap_title(TrapKind kind);
const char* trap_help(TrapKind kind);

enum class PlaceBase : uint8_t { kLocal, kSelf, kGlobal, kConst, kArg, kPointee };
enum class StepKind : uint8_t { kMember, kIndex, kEnter, kDeref };

struct Step {
  StepKind kind = StepKind::kMember;
  uint32_t index = 0;   // kMember: member number
  ValueId value;        // kIndex: any integer scalar; invalid: `constant_index`
  int64_t constant_index = 0;
  friend bool operator==(const Step&, const Step&) = default;
};

struct Place {
  PlaceBase base = PlaceBase::kSelf;
  uint32_t base_index = 0;  // kLocal, kArg
  PouId pou;                // kArg
  ValueId value;            // kPointee
  ConstId constant;         // kConst
  TypeId base_type;         // type of the base itself
  std::vector<Step> steps;
  TypeId type;              // type of the whole place
  friend bool operator==(const Place&, const Place&) = default;
};

// An index into Pou::places; equal places may share one.
struct PlaceTag;
using PlaceId = base::Id<PlaceTag>;

struct Target {
  BlockId block;
  std::vector<ValueId> args;
};

struct Inst {
  Op op = Op::kReturn;
  Scalar scalar = Scalar::kBool;
  ValueId result;                 // invalid when there is none
  std::vector<ValueId> operands;
  uint64_t imm = 0;               // kConst
  PlaceId place;
  PlaceId place2;                 // kCopy source
  ConstId constant;               // kInit; invalid: the type's default
  PouId pou;                      // kCallFunction
  uint32_t native = 0;            // kCallNative: row of stdlib/registry
  int64_t low = 0;                // kCheckRange
  int64_t high = 0;
  TrapKind trap = TrapKind::kAssert;
  std::vector<Target> targets;
  uint32_t line = 0;              // 1-based line in Pou::file; 0 for none
};

struct Block {
  std::vector<ValueId> params;
  std::vector<Inst> insts;  // the last one is a terminator
};

struct Value {
  Scalar scalar = Scalar::kBool;
};

enum class LocalKind : uint8_t { kInput, kOutput, kInOut, kReturn, kTemp };

// A variable in the POU's frame: parameters and result of a function, VAR_TEMP
// and a function's VAR. Parameters come first, in declaration order.
struct Local {
  std::string name;
  TypeId type;
  LocalKind kind = LocalKind::kTemp;
};

enum class PouKind : uint8_t { kFunction, kFunctionBlock, kProgram };

struct Pou {
  std::string name;
  PouKind kind = PouKind::kFunction;
  TypeId self;                 // instance type of a function block or program
  std::string file;
  uint32_t line = 0;
  std::vector<Local> locals;
  std::vector<Value> values;
  std::vector<Place> places;
  std::vector<Block> blocks;   // blocks[0] is the entry and has no parameters
  base::Digest source_hash{};  // of the POU's own source text
};

struct Task {
  std::string name;
  int64_t period_ns = 10'000'000;
  int64_t watchdog_ns = 0;  // 0: ten periods
  uint32_t priority = 0;    // 0 is the highest, as in IEC 61131-3
};

struct ProgramInstance {
  std::string name;
  TypeId type;
  uint32_t task = 0;   // index into Program::tasks
  ConstId init;        // overrides, or invalid
};

struct Program {
  std::string name;  // configuration or project name
  TypeTable types;
  ConstTable constants;
  TypeId globals;    // Kind::kGlobals; always valid
  std::vector<Pou> pous;
  std::vector<Task> tasks;                  // at least one
  std::vector<ProgramInstance> instances;   // in declaration order

  PouId find_pou(std::string_view name) const;       // without case
  PouId pou_of_instance_type(TypeId type) const;
};

}  // namespace ir
