// A relocatable object: the code of one POU, free of every offset. The same POU
// gives the same object whatever happens to the types, globals and POUs that it
// uses, as long as it uses them in the same way; relinking follows moved offsets
// (A12), and the object's digest is the POU's identity on controllers (E1).
//
// Code holds ordinary units whose fields are table indices instead of offsets:
//   near operand, base frame   slot, or slots.size() + place (a part of a slot)
//   near operand, base self, global            place
//   near operand, base const                   constant
//   BC32, P32, OFF, OFF32                      place (base must agree; const: constant)
//   CODE callee (or prototype), RANGE range, BOUNDS bound, TYPE and SIZE region, CAP and TRAP
//   literal FRAME filled by the linker (zero)
// Jumps are final: distances in units of the object (the linker adjusts them when
// it has to insert far loads and stores).
#pragma once

#include <cstdint>
#include <string>
#include <unordered_map>
#include <vector>

#include "base/hash.h"
#include "base/result.h"
#include "ir/bytecode/code.h"
#include "ir/program/ir.h"

namespace ir {

enum class SlotKind : uint8_t {
  kParam,      // parameter or result of this function; written by the caller if kInput/kInOut
  kLocal,      // named local or aggregate temporary
  kTemp,       // scalar temporary
  kArg,        // slot `param` of callee number `callee`, in the next frame
  kNativeArg,  // 8-byte slot number `param` of the next frame
};

struct Slot {
  SlotKind kind = SlotKind::kTemp;
  LocalKind local = LocalKind::kTemp;  // of kParam
  bool aggregate = false;              // holds a value of region.type (struct, array, string)
  Class cls = Class::kB;               // else: class of the scalar
  Region region;        // kA: what it points to; aggregates and named scalars: their type
  uint32_t callee = 0;  // kArg
  uint32_t param = 0;   // kArg, kNativeArg
  std::string name;     // of named locals, for the debugger
};

// kFixed: `slot` is the offset itself, of an image that does not tell what it leads to.
enum class PlaceRoot : uint8_t { kSelf, kGlobal, kSlot, kRegion, kFixed };

// A constant byte offset, still symbolic: root and steps. kMember steps count by
// member number, kIndex steps by constant index (one per dimension). No other steps.
struct ObjectPlace {
  PlaceRoot root = PlaceRoot::kSelf;
  uint32_t slot = 0;  // kSlot, kFixed
  Region region;      // kRegion: what the addr points to
  Steps steps;
  Region result;  // what is at the place
  friend bool operator==(const ObjectPlace&, const ObjectPlace&) = default;
};

// An entry of the constant pool: raw scalar bytes, or an initial value of a type.
struct ObjectConstant {
  base::InlineVector<uint8_t, 8> bytes;  // scalars: 1, 2, 4 or 8; kA: a value, as it is laid out
  Class cls = Class::kB;
  TypeId type;  // valid: `value` (or the type's default) laid out by the linker
  ConstId value;
};

struct Bound {
  TypeId array;
  uint8_t dim = 0;
  std::string name;  // of the variable, for the trap's text
};

struct Range {
  int64_t low = 0;
  int64_t high = 0;
  std::string name;
  friend bool operator==(const Range&, const Range&) = default;
};

// At a jump target: the slots that hold a value there, whichever way was taken.
struct Merge {
  uint32_t unit = 0;
  std::vector<uint16_t> slots;  // sorted; scalars and addrs (aggregates always count as written)
};

struct LineEntry {
  uint32_t unit = 0;  // from this unit on
  uint32_t line = 0;
};

// What is in code as it was when it was compiled, where a name of it says nothing: functions that
// the optimiser has taken in, and constants and types that are named in the source, whose values
// may have become numbers (E-04).
enum class HeldKind : uint8_t { kFunction, kGlobal, kType };
struct HeldName {
  HeldKind kind = HeldKind::kFunction;
  std::string name;
  friend auto operator<=>(const HeldName&, const HeldName&) = default;
};

struct Object {
  std::string name;
  PouKind kind = PouKind::kFunction;
  TypeId self;
  uint32_t recursion_depth = 0;  // as ir::Pou's
  std::string file;
  SourceContent content;  // as ir::Pou's; no part of the canonical bytes
  // For an object that was made from an image (linker/unlink.h): what it is known as; 0: by its
  // canonical bytes. And does its code hold sizes and offsets of types as plain numbers? Then it
  // goes with the layouts that these types have there.
  base::Digest known_as{};
  bool fixed = false;
  std::vector<std::string> taken_in;  // POUs, as ir::Pou's; no part of the canonical bytes
  std::vector<HeldName> held;         // of an object that was made from an image: all of them
  std::vector<Slot> slots;            // kParam first, in declaration order
  std::vector<ObjectPlace> places;
  std::vector<ObjectConstant> constants;
  std::vector<Region> regions;
  std::vector<Bound> bounds;
  std::vector<Range> ranges;
  std::vector<std::string> callees;  // POUs that CODE fields name
  std::vector<Unit> code;
  std::vector<Merge> merges;     // sorted by unit
  std::vector<LineEntry> lines;  // sorted by unit
};

// POUs by folded name.
using PouNames = std::unordered_map<std::string, PouId>;
PouNames pou_names(const Program& program);

// Canonical bytes: types, members, globals and callees by name and text, so equal
// objects of different compilations are equal bytes.
base::Bytes canonical_bytes(const Object& object, const Program& program);
// Their digest; `names` are those of the program.
base::Digest identity(const Object& object, const Program& program, const PouNames& names);
// For `stc dump --object`.
std::string disassemble(const Object& object, const Program& program);

}  // namespace ir
