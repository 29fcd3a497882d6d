// The IEC type system as compiler, linker, VM and online change share it.
//
// A TypeTable owns and interns all types of one program; TypeIds are stable for
// its lifetime. Function blocks and programs are types too: their members are
// their variables. The global variables of a program are the members of one
// pseudo type (Kind::kGlobals). So layout, diff and planning treat globals,
// program areas and instance areas alike (A3, A4).
//
// Storage (all layouts, little endian): BOOL one byte; STRING[n] n+1 bytes, NUL-
// terminated; WSTRING[n] 2*(n+1) bytes; structures and arrays embedded; a
// function block inside something is a 4-byte instance ID slot (0 = none), its
// data lives in an area of its own; an in-out member is a 4-byte Addr slot. A member
// of the globals that is a program is such a slot too: it names the program instance
// of that name, which exists anyway. References
// (POINTER TO, REF_TO, REFERENCE TO) are 8-byte handles, scalars like any LWORD: they
// name an area or a local and an offset in it (docs/adr/0005-references-are-handles.md).
// The members of a UNION, or of a STRUCT declared OVERLAP, lie on top of each other.
//
// A function block that extends another (`base`) begins with all members of its base,
// in the same order, and has them at the same offsets: what works on an instance
// of the base works on one of the derived type. To everything that goes by members
// (paths, layouts, changes) they are members like others.
// Sizes and member offsets are not part of a type: see layout.h.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "base/ids.h"
#include "base/name_case.h"

namespace ir {

enum class Scalar : uint8_t {
#define SCALAR(id, text, bytes) id,
#include "ir/types/scalars.def"
#undef SCALAR
};
inline constexpr uint32_t kScalarCount = 14;
std::string_view scalar_name(Scalar scalar);
constexpr uint32_t scalar_size(Scalar scalar) {
  constexpr uint8_t kBytes[] = {
#define SCALAR(id, text, bytes) bytes,
#include "ir/types/scalars.def"
#undef SCALAR
  };
  return kBytes[static_cast<size_t>(scalar)];
}
constexpr bool is_signed(Scalar scalar) { return scalar >= Scalar::kI8 && scalar <= Scalar::kI64; }
constexpr bool is_integer(Scalar scalar) { return scalar >= Scalar::kI8 && scalar <= Scalar::kU64; }
constexpr bool is_float(Scalar scalar) { return scalar == Scalar::kF32 || scalar == Scalar::kF64; }

enum class Kind : uint8_t {
#define ELEMENTARY(id, name, scalar, group) id,
#include "ir/types/elementary.def"
#undef ELEMENTARY
  kString,         // capacity
  kWstring,        // capacity
  kEnum,           // base, literals
  kSubrange,       // base, low, high
  kArray,          // base = element type, dims
  kPointer,        // base = target; POINTER TO
  kRefTo,          // base = target; REF_TO
  kReferenceTo,    // base = target; REFERENCE TO
  kStruct,         // members
  kUnion,          // members, which overlap
  kFunctionBlock,  // members
  kProgram,        // members
  kGlobals,        // members; exactly one per program
  kInterface,      // interfaces = its parents; never the type of a variable, only what a reference
                   // names
};
inline constexpr uint32_t kElementaryCount = 25;
inline constexpr uint32_t kKindCount = 39;

enum class Group : uint8_t { kBit, kSigned, kUnsigned, kReal, kDuration, kDate, kChar, kNone };
constexpr bool is_elementary(Kind kind) { return static_cast<uint32_t>(kind) < kElementaryCount; }
constexpr bool is_reference(Kind kind) {
  return kind >= Kind::kPointer && kind <= Kind::kReferenceTo;
}
constexpr bool is_structure(Kind kind) { return kind == Kind::kStruct || kind == Kind::kUnion; }
std::string_view elementary_name(Kind kind);
Group elementary_group(Kind kind);  // kNone for other kinds

struct TypeTag;
struct ConstTag;
using TypeId = base::Id<TypeTag>;
// An initial value in the program's ConstTable (constants.h).
using ConstId = base::Id<ConstTag>;
// What `{renamed from := 'old'}` says, kept in the TypeTable; invalid: no rule.
struct OldNameTag;
using OldNameId = base::Id<OldNameTag>;

// kStamp: a DWORD of start code, which no source sees and nobody lists. In a block: 0 in a new
// instance, see stamps.h; in the globals: not 0 where start code runs for a change.
enum class Section : uint8_t { kLocal, kInput, kOutput, kInOut, kGlobal, kStamp };

// What direct address an AT declaration names (I/O and marker memory).
enum class DirectArea : uint8_t { kNone, kInput, kOutput, kMarker };
struct DirectAddress {
  DirectArea area = DirectArea::kNone;
  uint32_t bit_offset = 0;  // %IX2.3 -> 19; %QW4 -> 64 (word number times 16)
  uint32_t bit_size = 0;    // 1, 8, 16, 32, 64
  friend bool operator==(const DirectAddress&, const DirectAddress&) = default;
};

// As bit_offset: the instance says where, in VAR_CONFIG (AT %I*).
inline constexpr uint32_t kOpenAddress = 0xffffffff;

struct Member {
  std::string name;  // as first written; compared without case
  TypeId type;
  Section section = Section::kLocal;
  bool constant = false;
  bool retain = false;
  ConstId init;           // invalid: the type's default
  DirectAddress address;  // for AT declarations
  OldNameId old_name;
};

// Is it a variable by itself, that people can see?
inline bool is_listed(const Member& member) {
  return member.section != Section::kInOut && member.section != Section::kStamp;
}

struct Dimension {
  int64_t low = 0;
  int64_t high = 0;
  uint64_t count() const { return static_cast<uint64_t>(high - low) + 1; }
  friend bool operator==(const Dimension&, const Dimension&) = default;
};

struct EnumLiteral {
  std::string name;
  int64_t value = 0;
  OldNameId old_name = {};
};

struct Type {
  Kind kind = Kind::kBool;
  std::string name;  // declared name; "" for anonymous ones
  TypeId base;       // see Kind
  int64_t low = 0;   // subrange
  int64_t high = 0;
  // Strings, in characters. Structures and unions with {attribute 'pack_mode'}: how many bytes a
  // member is aligned to at most, 1, 2, 4 or 8 (member_alignment()); 0: as its type.
  uint32_t capacity = 0;
  std::vector<Dimension> dims;
  std::vector<Member> members;
  // The members overlap: all at offset 0, or where `address` (no area, only a bit offset)
  // of a member says. Always so for kUnion; of a kStruct: OVERLAP, or members AT %Bn.
  bool overlap = false;
  std::vector<EnumLiteral> literals;
  // All interfaces that a function block implements, those of its base and parents of interfaces
  // included; all parents of an interface.
  std::vector<TypeId> interfaces;
  ConstId init;  // default initial value when it is not all zero
  OldNameId old_name;

  // The elements of an array, over all dimensions.
  uint64_t element_count() const;
};

// What a member is aligned to whose type is aligned to `align`.
inline uint32_t member_alignment(const Type& structure, uint32_t align) {
  const bool packed = structure.capacity != 0 && structure.capacity < align;
  return packed ? structure.capacity : align;
}

class TypeTable {
 public:
  TypeTable();  // holds the elementary types from the start

  TypeId elementary(Kind kind) const { return TypeId(static_cast<uint32_t>(kind)); }
  TypeId string(uint32_t capacity);
  TypeId wstring(uint32_t capacity);
  // Anonymous arrays and subranges are interned by content.
  TypeId array(TypeId element, std::vector<Dimension> dims);
  TypeId subrange(TypeId base, int64_t low, int64_t high);
  // References are interned by target, which may be declared before its content is known
  // and may lead back to the reference.
  TypeId pointer(TypeId target) { return reference(Kind::kPointer, target); }
  TypeId ref_to(TypeId target) { return reference(Kind::kRefTo, target); }
  TypeId reference_to(TypeId target) { return reference(Kind::kReferenceTo, target); }
  TypeId reference(Kind kind, TypeId target);
  // A named type, or an anonymous structure or enumeration. Its content may be
  // filled in later through edit(), which is how recursive declarations resolve.
  TypeId declare(Type type);
  Type& edit(TypeId id) { return types_[id.index]; }

  const Type& operator[](TypeId id) const { return types_[id.index]; }
  OldNameId add_old_name(std::string name);
  const std::string& old_name(OldNameId id) const { return old_names_[id.index]; }
  bool knows(OldNameId id) const { return !id.valid() || id.index < old_names_.size(); }
  const std::vector<std::string>& old_names() const { return old_names_; }
  void set_old_names(std::vector<std::string> names) { old_names_ = std::move(names); }

  // Watches what interning gives out: the types from number `next` on must come one after the
  // other, each when the one before it has come. So it is told whether code that is made anew needs
  // the types that were added for it, in the same order, and none that was added for others.
  void expect_in_turn(uint32_t next) {
    next_in_turn_ = next;
    in_turn_ = true;
  }
  bool came_in_turn(uint32_t end) const { return in_turn_ && next_in_turn_ == end; }

  uint32_t size() const { return static_cast<uint32_t>(types_.size()); }
  void reserve(uint32_t count) { types_.reserve(count); }
  bool contains(TypeId id) const { return id.index < types_.size(); }

  // Elementary or a reference, at any depth of subrange or enumeration?
  bool is_scalar(TypeId id) const {
    const Kind root = root_kind(id);
    return is_elementary(root) || ir::is_reference(root);
  }
  // The machine scalar of a scalar type.
  Scalar scalar(TypeId id) const;
  // Elementary kind below subranges and enumerations; the kind itself otherwise.
  Kind root_kind(TypeId id) const {
    const Kind kind = contains(id) ? types_[id.index].kind : Kind::kStruct;
    return kind == Kind::kSubrange || kind == Kind::kEnum ? kind_below(id) : kind;
  }
  bool has_members(TypeId id) const;
  bool is_reference(TypeId id) const {
    return contains(id) && ir::is_reference(types_[id.index].kind);
  }
  // Do members lie on top of each other (Type::overlap)?
  bool overlaps(TypeId id) const {
    return contains(id) && (types_[id.index].kind == Kind::kUnion ||
                            (types_[id.index].kind == Kind::kStruct && types_[id.index].overlap));
  }
  bool is_instance(TypeId id) const {  // function block or program
    return contains(id) && (types_[id.index].kind == Kind::kFunctionBlock ||
                            types_[id.index].kind == Kind::kProgram);
  }
  // Is `id` the type `wanted`, or does it extend or implement it?
  bool is_a(TypeId id, TypeId wanted) const;
  // Index of the member with that name (without case); -1 when there is none.
  int32_t find_member(TypeId id, std::string_view name) const;
  // "INT", "ARRAY[1..3,0..9] OF Motor", "STRING[20]", "Recipe": what people read.
  // Two structurally equal anonymous types have the same text.
  std::string text(TypeId id) const;
  // The same in a message: of a type without a name that says much, the beginning.
  std::string shown(TypeId id) const;

 private:
  TypeId intern(std::string key, Type type);
  Kind kind_below(TypeId id) const;  // of a subrange or enumeration: see root_kind()

  std::vector<Type> types_;
  std::unordered_map<std::string, TypeId> interned_;
  std::vector<std::string> old_names_;
  uint32_t next_in_turn_ = 0;
  bool in_turn_ = true;
};

// Comparison and folding of IEC identifiers (base/name_case.h).
using base::fold_name;
using base::same_name;

}  // namespace ir
