// What the native tier works on: one POU as SSA over machine-like operations, made
// from verified bytecode (build.h), given registers (allocate.h), written as machine code
// (x64/). Values and blocks are numbers; everything lives in flat vectors.
//
// Where values are. A *variable* is a scalar that an instruction names directly: a slot of the own
// frame, a variable of the instance, a global, an argument in the next frame. A slot may be newer
// in a register than in memory ("dirty"), and so may a variable that an innermost loop changes,
// until that loop ends ("deferred"); every other variable is written through at once, so memory is
// right wherever something else may look: at a trap, at a call, for references.
//
// Registers hold the low `width` bytes of a value; what is above is arbitrary, except that values
// of 4 bytes (addresses among them) are zero-extended to 8. A BOOL is 0 or 1 in its low byte; what
// a hostile image or package put there may be another byte, so no check is left out because of it.
//
// Leaving. An *exit* gives the POU back to the interpreter at a unit: what is dirty is
// stored first, then the interpreter executes that unit itself. So what traps, suspends or happens
// seldom has no second meaning here.
#pragma once

#include <cstdint>
#include <vector>

#include "ir/bytecode/code.h"

namespace vm::native {

inline constexpr uint32_t kNone = 0xffffffffu;
using Val = uint32_t;    // index into Function::values
using Block = uint32_t;  // index into Function::blocks

enum class Op : uint8_t {
  kConst,  // imm
  kLoad,   // result := [mem]; a BOOL as 0 or 1
  kStore,  // [mem] := in[0]
  kAddr,   // result := data address of mem
  kPlace,  // result := machine address of mem; no memory ever holds it
  // a op b, of `width` bytes
  kAdd,
  kAddShifted,  // a + (b << imm); imm is 1, 2 or 3, width 8
  kSub,
  kMul,
  kAnd,
  kOr,
  kXor,
  kAndNot,
  kOrNot,  // BOOL
  kShl,    // in[1] is 4 bytes wide; 0 from the width on, as the bytecode says
  kShr,
  kSar,
  kRol,
  kRor,
  kDivS,  // in[1] is not 0: an exit stands before
  kDivU,
  kModS,
  kModU,
  kMulHighS,  // the upper half of the product, width 8
  kMulHighU,
  kNeg,
  kNot,
  kNotBool,
  kCompare,    // 0 or 1: in[0] cond in[1]
  kSelect,     // in[0] != 0 ? in[1] : in[2]
  kSelectCmp,  // in[2] cond in[3] ? in[0] : in[1]; `from` is the width that is compared
  kSext,       // of `from` bytes to 8
  kZext,
  // floating point, `width` 4 or 8
  kFAdd,
  kFSub,
  kFMul,
  kFDiv,
  kFMin,
  kFMax,
  kFNeg,
  kFAbs,
  kFSqrt,
  kFCompare,
  kFSelect,      // as kSelect
  kIntToFloat,   // in[0]: a signed number of 4 or 8 bytes (`from`)
  kFloatToInt,   // half to even (imm 0) or towards zero (imm 1), to 8 bytes signed; INT64_MIN: none
  kFloatWidth,   // of `from` to `width`
  kBitsToFloat,  // an integer's bits
  kFloatToBits,
  // data address of the bytes that the handle in[0] names, moved by the low half of imm, whose high
  // half says how many; leaves at `exit` when they are not there
  kResolve,
  kMoveHandle,  // the handle in[0] moved by in[1] bytes, with all of their 8 bytes
  // In front of a loop (walk.cc): how far behind the first byte of its variable the handle in[0]
  // is, which `site` knows from then on. What cannot be walked over is further away than its size.
  kReach,
  kReachPart,  // of what in[0], a kReach, has found: the member of KnownReach at byte `imm`
  kHandleAt,   // the handle that lies so far behind: in[0], at most one past the end
  // leaves at `exit` when in[0] cond in[1]
  kExitIf,
  // address of the instance whose ID is in[0]; leaves at `exit` when it is none
  kInstance,
  kTaskTime,
  kAdvanceTime,
  kPool,     // result := data address of the image's constants
  kContext,  // result := what the Context holds at byte `imm`; a pointer there is no data address
  kNative,   // the function at address `imm`, of data memory and in; what calls lose is lost
  kHelper,   // `unit` by its handler; every register is lost
  kCall,     // `call`; nothing but constants lives across, unless it becomes kEnter
  // begins the body of `call`, which follows; the result points to its instance: in[1], or mem
  kEnter,
};

// kNoBit, kAnyBit: a AND b is 0, is not 0.
enum class Cond : uint8_t {
  kEq,
  kNe,
  kLtS,
  kLeS,
  kGtS,
  kGeS,
  kLtU,
  kLeU,
  kGtU,
  kGeU,
  kNoBit,
  kAnyBit
};
Cond negated(Cond cond);
Cond swapped(Cond cond);  // for exchanged operands
// Compares the low `width` bytes, with zeros above.
bool holds(Cond cond, uint64_t a, uint64_t b, uint8_t width);

// kPointer: a machine address, of an instance whose code is inlined or of a part of a sum in a loop
// (kPlace); no memory ever holds it.
enum class MemBase : uint8_t { kFrame, kSelf, kData, kPointer };

// base + index * scale + disp. kData: data memory; disp is an offset of 32 bits. `inside`: kSelf,
// but in the area of an instance inside, which the image says to lie there.
struct Mem {
  MemBase base = MemBase::kFrame;
  uint8_t scale = 1;  // 1, 2, 4, 8
  Val index = kNone;
  int64_t disp = 0;
  Val pointer = kNone;
  bool inside = false;
};

// Node::imm of a kLoad that gives the area of an instance which is surely not the POU's own.
inline constexpr uint64_t kOtherInstance = 2;

struct Node {
  Op op = Op::kConst;
  uint8_t width = 0;
  uint8_t from = 0;
  Cond cond = Cond::kEq;
  bool boolean = false;    // kLoad of a BOOL that may be any byte, which becomes 0 or 1
  bool immutable = false;  // kLoad: no code writes there
  bool dead = false;
  uint8_t folded = 0xff;  // the operand that is what lies at `mem` (fold_loads)
  uint8_t site = 0;       // of Context::reaches
  Val result = kNone;
  Val in[4] = {kNone, kNone, kNone, kNone};
  uint64_t imm = 0;
  Mem mem;
  uint32_t variable = kNone;  // kLoad, kStore: whose memory it is
  uint32_t kills = kNone;     // Function::kills: variables whose memory may change; kNone: no other
  uint32_t exit = kNone;      // Function::exits
  uint32_t call = kNone;      // Function::calls
  uint32_t unit = 0;
};

struct Value {
  bool floating = false;
  uint8_t width = 0;
  bool constant = false;
  uint64_t bits = 0;      // of a constant
  uint32_t node = kNone;  // that makes it; kNone: a block parameter
  Block block = 0;
  uint32_t home = kNone;  // of a parameter: the variable that holds it on every way there, too
};

inline constexpr uint8_t kNoSite = 0xff;

// Variables that are dirty, and what they hold there.
struct SlotValue {
  uint32_t offset = 0;
  uint8_t width = 0;
  Val value = kNone;
  MemBase base = MemBase::kFrame;
  // The place is the data address of `address`, which is made where it is stored; `value` is the
  // index.
  bool is_address = false;
  Mem address = {};
  uint8_t site = kNoSite;  // else the handle that lies `value` bytes behind, as of kHandleAt
};
struct Exit {
  uint32_t unit = 0;
  bool fuel = false;       // its unit takes fuel that has just been taken
  uint32_t fuel_back = 0;  // was taken for turns of a loop that are not done
  // Inside of an inlined body (Function::inlined): the activation is made first. After its slots
  // come the instance's ID and the pointer to it when it has one.
  uint32_t inlined = kNone;
  std::vector<SlotValue> slots;
};

// kVirtual: in[2] of the node is the number of the POU. kSlow: the interpreter enters the callee,
// which returns here.
enum class CallKind : uint8_t { kFunction, kBody, kMethod, kOwn, kVirtual, kSlow };
struct Call {
  struct Target {
    uint32_t type = 0;
    uint32_t pou = 0;
  };
  CallKind kind = CallKind::kFunction;
  uint32_t pou = 0;         // of kBody the instance says it
  uint32_t frame_step = 0;  // bytes from this frame to the callee's
  uint32_t unit = 0;
  uint32_t known = kNone;  // the POU, when it is known before
  uint32_t behind = 0;     // the unit where the caller goes on
  bool inlined = false;    // a body stands in its place
  // One body for each type that the instance may be of, which in[3] of the node says; the exit for
  // all others.
  std::vector<Target> targets = {};
  uint32_t miss = kNone;
};

struct Inlined {
  uint32_t call = 0;
  const ir::Unit* units = nullptr;  // the callee's
  bool has_instance = false;
  bool leaves = false;  // some exit leaves in the middle of it
};

// kTakeFuel: [0] when more is left than it takes, else [1], and nothing is taken.
enum class EndKind : uint8_t { kJump, kLoop, kBranch, kTakeFuel, kReturn, kExit, kUnreachable };
struct End {
  EndKind kind = EndKind::kReturn;
  Op compare = Op::kCompare;  // kBranch: kCompare or kFCompare
  Cond cond = Cond::kNe;
  uint8_t width = 1;
  Val in[2] = {kNone, kNone};
  Block target[2] = {kNone, kNone};  // kBranch: [0] when it holds, else [1]
  std::vector<Val> args[2];
  uint32_t exit = kNone;  // kLoop: out of fuel (kNone: it takes none); kExit
  uint32_t fuel = 0;      // kTakeFuel
};

// A loop is its head and all blocks up to the last one that jumps back to it.
struct Loop {
  Block head = 0;
  Block last = 0;
  uint32_t parent = kNone;
  bool kills_all = false;
  std::vector<uint32_t> modified;  // variables, sorted
};

// In front of a loop: how the interpreter's state becomes the one there.
struct Reload {
  uint32_t variable = kNone;
  Val value = kNone;
};

struct BasicBlock {
  uint32_t unit = 0;  // first
  std::vector<Val> params;
  std::vector<uint32_t> nodes;
  End end;
  uint32_t loop = kNone;  // innermost that it is in
  bool head = false;
  // In front of a loop: an interrupted execution goes on here. Every value that lives here, and the
  // slots that are dirty.
  bool resumes = false;
  std::vector<Reload> reloads;
  std::vector<SlotValue> dirty;
};

struct Variable {
  MemBase base = MemBase::kFrame;
  uint32_t offset = 0;
  uint8_t width = 0;
  bool floating = false;
  bool boolean = false;   // a BOOL that may be any byte
  bool slot = false;      // of the own frame: may be dirty
  bool constant = false;  // an instance's ID: no code writes it
  bool written = false;   // by its name
  bool deferred = false;  // not a slot, and may be dirty in some loop
};

struct Function {
  std::vector<Value> values;
  std::vector<Node> nodes;
  std::vector<BasicBlock> blocks;  // in order of their units; only kLoop goes back
  std::vector<Loop> loops;
  std::vector<Variable> variables;
  std::vector<std::vector<uint32_t>> overlaps;  // by variable: others on the same bytes
  std::vector<std::vector<uint32_t>> kills;     // sets of variables
  std::vector<Exit> exits;
  std::vector<Call> calls;
  std::vector<Inlined> inlined;
};

// The block that execution falls into after `b`: what nothing leads to has no code.
inline Block next_block(const Function& f, Block b) {
  Block next = b + 1;
  while (next + 1 < f.blocks.size() && f.blocks[next].end.kind == EndKind::kUnreachable &&
         f.blocks[next].nodes.empty()) {
    ++next;
  }
  return next;
}

}  // namespace vm::native
