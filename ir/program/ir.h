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
//   kTarget  what handle `value` (u64) refers to, taken as a base_type (see References)
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
// Objects (docs/adr/0006-objects.md). A method is a POU of kind kMethod with the `self`
// type of its block (function block, program or interface) and the name "Block.Method";
// actions and property accessors ("Block.Prop.GET") are methods. It has a frame and
// parameters as a function, and kSelf places as a block. A type that extends another
// begins with copies of its base's members (types.h), so an inherited variable
// is the member of the same number in base and derived type: self.x.
//   Arguments and results of methods travel through kArg places of the method that the
// call names, exactly as those of functions; for a virtual call that is the prototype.
//   call_method  `place`: an instance slot whose type is or extends the method's self;
//                or one u64 operand: a reference to such an instance (kReference trap when
//                it is none); or neither: the own instance
//   call_body    the body of a base: SUPER^(). Inputs and outputs are members of self
//   call_virtual runs what Program::overrides says for the instance's type and the
//                prototype; kReference trap when there is no row
// A prototype is a method of a class, or of an interface (its body traps). find_overrides()
// fills Program::overrides from names; call it when all POUs are there.
//   References to instances are u64 handles (docs/adr/0005-references-are-handles.md). An
// interface variable is a reference whose target type is the interface. Inputs and outputs of
// a call_reference are places behind the reference: target(v : T)!.x.
//   A global of program type, `Main : Main`, is another way to the program instance of
// that name: global.Main!.x, call_instance global.Main. It has no initial value.
//
// Caught traps (docs/adr/0007-caught-traps.md). `try` enters the block targets[0];
// every block of the body names the handler targets[1] in Block::handler. A trap in the body, or in
// what it calls, goes on at the handler, which has no parameters, finds all stores done before the
// trap, and may read trap_kind first. `end_try` leaves the body, whose blocks return and jump out
// in no other way. trap_again raises the caught trap anew, as if it had not been
// caught. Handlers may have handlers: that of the try around them. kFuel, kWatchdog and kStack are
// never caught.
//
// References (docs/adr/0005). A POINTER TO, REF_TO or REFERENCE TO is a u64 handle; 0 is NULL.
// Handles are loaded, stored, passed and compared as u64; nothing is checked until use.
//
//   ADR(x), REF(x), r REF= x   v = handle u64 PLACE     any place but kConst and kArg. Of a local
//                                                       too: it is gone when its POU returns
//   ADR(fb), REF(fb)           v = handle u64 self.fb   the slot, not entered
//   ADR(io), io an in-out      v = handle u64 local.io^
//   THIS                       v = handle u64 self
//   p^ := x                    store i16 target(vp : INT), vx
//   p^.a[i]                    load i16 target(vp : Motor).a[vi]
//   p^ := q^ (structures)      copy target(vp : Motor), target(vq : Motor)
//   p^.fb.x, fbp^.x            load i16 target(vp : S).fb!.x    load i16 target(vp : Fb)!.x
//   fbp^(), ref()              call_instance target(vp : Fb)
//   strings behind a pointer   s = string str target(vp : S80)  natives take it; copy works too
//   REFERENCE TO as in-out     a = address addr target(vr : INT)  then store addr arg(F).x, a
//   p + n (bytes)              v = move_handle u64 vp, vn       n: u64 or i64; far: lost
//   p[n]                       the same with n * SIZEOF(target), then target(v : T)
//   SIZEOF(T)                  v = size_of u32 T                an instance: what its variables
//   take pointer to DWORD, back     v = flat u32 vp                  v = unflat u64 vd
//
// A path from kTarget moves the handle along members and bounds-checked indices and checks only
// the part that is used: live, inside the used bytes of its area, over no instance or in-out slot
// (kReference trap). Where base_type is or holds instances, exactly a base_type must be there,
// or an instance of a type that extends it. A string behind a handle has the declared capacity,
// or what is left there if that is less. Members of a union (TypeTable::overlaps) are places that
// overlap; nothing else is special about them.
//
// Execution order is program order; all trapping is precise.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/hash.h"
#include "base/ids.h"
#include "base/inline_vector.h"
#include "base/slim_vector.h"
#include "ir/program/source_content.h"
#include "ir/program/task_policy.h"
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
inline constexpr uint32_t kTrapCount = 15;
const char* trap_name(TrapKind kind);  // "division-by-zero"
// By a `try`; the others end the scan of their task, whatever is around them.
constexpr bool can_be_caught(TrapKind kind) {
  return kind != TrapKind::kFuel && kind != TrapKind::kWatchdog && kind != TrapKind::kStack &&
         kind != TrapKind::kOverrun && kind != TrapKind::kNotANumber && kind != TrapKind::kIoLost;
}
const char* trap_title(TrapKind kind);
const char* trap_help(TrapKind kind);

enum class PlaceBase : uint8_t { kLocal, kSelf, kGlobal, kConst, kArg, kPointee, kTarget };
enum class StepKind : uint8_t { kMember, kIndex, kEnter, kDeref };

struct Step {
  StepKind kind = StepKind::kMember;
  uint32_t index = 0;  // kMember: member number
  ValueId value;       // kIndex: any integer scalar; invalid: `constant_index`
  int64_t constant_index = 0;
  friend bool operator==(const Step&, const Step&) = default;
};

using Steps = base::InlineVector<Step, 1>;

struct Place {
  PlaceBase base = PlaceBase::kSelf;
  uint32_t base_index = 0;  // kLocal, kArg
  PouId pou;                // kArg
  ValueId value;            // kPointee, kTarget
  ConstId constant;         // kConst
  TypeId base_type;         // type of the base itself
  TypeId type;              // type of the whole place
  Steps steps;
  friend bool operator==(const Place&, const Place&) = default;
};

// An index into Pou::places; equal places may share one.
struct PlaceTag;
using PlaceId = base::Id<PlaceTag>;

using ValueList = base::InlineVector<ValueId, 2>;

struct Target {
  BlockId block;
  ValueList args;
};
using Targets = base::SlimVector<Target>;

// One line of the cache, as a program has more of them than lines of text. What belongs to single
// operations shares its room.
struct Inst {
  Op op = Op::kReturn;
  Scalar scalar = Scalar::kBool;
  TrapKind trap = TrapKind::kAssert;
  ValueId result;     // invalid when there is none
  uint32_t line = 0;  // 1-based line in Pou::file; 0 for none
  PlaceId place;
  PlaceId place2;  // kCopy source
  union {
    ConstId constant = {};  // kInit; invalid: the type's default
    PouId pou;              // calls of functions and methods
    TypeId type;            // kIsType, kCallReference, kSizeOf
    uint32_t native;        // kCallNative: row of stdlib/native/natives.def
  };
  ValueList operands;
  union {
    uint64_t imm = 0;  // kConst
    int64_t low;       // kCheckRange, kSwitch
  };
  int64_t high = 0;
  Targets targets;

  Inst() {}
};
static_assert(sizeof(Inst) == 64);

struct Block {
  std::vector<ValueId> params;
  BlockId handler;          // of the innermost try around it; invalid: none
  std::vector<Inst> insts;  // the last one is a terminator
};

struct Value {
  Scalar scalar = Scalar::kBool;
};

enum class LocalKind : uint8_t { kInput, kOutput, kInOut, kReturn, kTemp };

// A variable in the POU's frame: parameters and result of a function or method,
// VAR_TEMP, and VAR of functions and methods. Parameters come first, in declaration order.
struct Local {
  std::string name;
  TypeId type;
  LocalKind kind = LocalKind::kTemp;
};

enum class PouKind : uint8_t { kFunction, kFunctionBlock, kProgram, kMethod };
inline constexpr uint32_t kPouKindCount = 4;
// Is it what runs when an instance is called?
constexpr bool is_body(PouKind kind) {
  return kind == PouKind::kFunctionBlock || kind == PouKind::kProgram;
}
// Does it take arguments in its frame?
constexpr bool has_parameters(PouKind kind) { return !is_body(kind); }

// A transition of a chart, or, without `from`, the start of a network at its initial step. Members
// of the POU's instance type that are steps, sorted.
struct ChartMove {
  std::vector<uint32_t> from;
  std::vector<uint32_t> to;
  friend bool operator==(const ChartMove&, const ChartMove&) = default;
};

struct Pou {
  std::string name;
  PouKind kind = PouKind::kFunction;
  TypeId self;  // instance type of a function block, program or method
  // How often it may be active at once (`{attribute 'recursion_depth' := '20'}`); 0: it takes
  // part in no circle of calls. One activation more traps (kStack).
  uint32_t recursion_depth = 0;
  std::string file;
  uint32_t line = 0;
  std::vector<Local> locals;
  std::vector<Value> values;
  std::vector<Place> places;
  std::vector<Block> blocks;   // blocks[0] is the entry and has no parameters
  std::vector<ChartMove> chart;  // of a body that is a chart, for later versions: no code uses it
  SourceContent content;
  // Functions whose code the optimiser has put in here, and POUs whose defaults are passed (E-04).
  std::vector<PouId> taken_in;
};

struct Task {
  std::string name;
  int64_t period_ns = 10'000'000;
  int64_t watchdog_ns = 0;  // 0: ten periods
  uint32_t priority = 0;    // 0 is the highest, as in IEC 61131-3
  // Start code: runs at cold start, after all initial values and before the first scan, and in
  // the first cycle after a change of variables, before all others. Its period is 0.
  bool once = false;
  // SINGLE: the number of a BOOL member of the globals; kNoEvent: none. Each rising edge
  // releases the task. It is looked at when a cycle starts and when a task ends; its
  // level before the first look is FALSE. A task begins once in a cycle at most. While the
  // event is TRUE, the period rests; with period 0 only edges release the task.
  uint32_t event = 0xffffffff;
  TaskPolicy policy = {};
};
inline constexpr uint32_t kNoEvent = 0xffffffff;
// The task of a program instance that runs when others call it, and only then.
inline constexpr uint32_t kNoTask = 0xffffffff;

struct ProgramInstance {
  std::string name;
  TypeId type;
  uint32_t task = 0;  // index into Program::tasks, or kNoTask
  ConstId init;       // overrides, or invalid
  OldNameId old_name = {};
};

// A function block instance that a task runs by itself, after the task's programs:
// variable `member` of the program instance of that number.
struct BlockTask {
  uint32_t program = 0;
  uint32_t member = 0;
  uint32_t task = 0;
};

// A name under which the outside reaches a variable (VAR_ACCESS).
struct AccessPath {
  std::string name;
  std::string path;
  bool writable = false;
};

// The address of a variable of one instance, which its declaration left open (VAR_CONFIG).
struct LocatedPath {
  std::string path;
  DirectAddress address;
};

// A virtual call that names `prototype` runs `target` on instances of `type`.
struct Override {
  TypeId type;
  PouId prototype;
  PouId target;
  friend bool operator==(const Override&, const Override&) = default;
};

// A function that makes values of a new version from those of the running one, or, for undo, the
// other way round (docs/adr/0014-migrations.md).
struct MigratedName {
  std::string parameter;
  std::string member;  // of `type`, in the version that is read or made
  bool output = false;
};
struct Migration {
  PouId function;
  TypeId type;  // a program, function block, structure or the globals
  // The type that it was, of the running version, when it was another one; else "".
  std::string from = {};
  bool inverse = false;
  std::vector<MigratedName> values;
};

// A global that is declared outside every RESOURCE of several, and that code of this one names: its
// value is exchanged with the others (docs/adr/0017-resources.md).
struct SharedGlobal {
  uint32_t member = 0;   // of the globals; plain data, not located
  bool written = false;  // by code of this resource, and so by no other
};

struct Program {
  std::string name;  // configuration or project name; of several resources: "Plant.Line"
  TypeTable types;
  ConstTable constants;
  TypeId globals;  // Kind::kGlobals; always valid
  std::vector<Pou> pous;
  std::vector<Task> tasks;                 // at least one
  std::vector<ProgramInstance> instances;  // in declaration order
  std::vector<BlockTask> block_tasks;
  std::vector<AccessPath> access;
  std::vector<LocatedPath> located;
  std::vector<Override> overrides;  // sorted by type, then prototype; no pair twice
  std::vector<Migration> migrations;
  std::vector<SharedGlobal> shared;  // by member; none where there is one resource
  Schedule schedule = Schedule::kSendFirst;

  PouId find_pou(std::string_view name) const;    // without case
  PouId pou_of_instance_type(TypeId type) const;  // its body
};

// One row for every prototype that a virtual call in the program names and every block
// that is of its type: the method of that name in the block or its nearest base.
// Blocks that have none (abstract ones) get no row.
std::vector<Override> find_overrides(const Program& program);

}  // namespace ir
