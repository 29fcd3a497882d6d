// What declarations mean: the records that the passes of sema fill and lowering
// reads. All of them belong to one Sema and live as long as it does.
#pragma once

#include <cstdint>
#include <vector>

#include "frontend/parse/tree.h"
#include "frontend/sema/names.h"
#include "ir/program/ir.h"

namespace frontend {

struct VariableTag;
using VarId = base::Id<VariableTag>;

// Declarations are resolved when somebody first needs them, in any order; meeting
// one that is busy means that it depends on itself.
enum class Progress : uint8_t { kNew, kBusy, kDone };

enum class Storage : uint8_t { kMember, kLocal, kGlobal };

inline constexpr uint32_t kNoPou = 0xffffffffu;

struct Variable {
  Name name;
  const VarDecl* decl = nullptr;  // null: a function's result
  VarSection section = VarSection::kLocal;
  bool constant = false;
  bool retain = false;
  bool used = false;
  bool runtime_init = false;  // the initialiser runs at each call
  Progress progress = Progress::kNew;
  Storage storage = Storage::kMember;
  uint32_t index = 0;  // member or local number
  uint32_t pou = kNoPou;
  VarId external;    // the global that a VAR_EXTERNAL means
  ir::TypeId type;   // invalid: could not be resolved (already reported)
  ir::ConstId init;  // invalid: the type's default
};

// A write to the output image, found in a body.
struct OutputWrite {
  ir::DirectAddress address;
  base::SourceSpan span;
};

struct PouInfo {
  const PouDecl* decl = nullptr;
  bool library = false;
  ir::PouId id;
  ir::TypeId self;  // instance type; invalid for functions
  NameMap<VarId> names;
  std::vector<VarId> variables;  // in declaration order
  std::vector<VarId> locals;     // by local number
  std::vector<VarId> members;    // by member number
  VarId result;
  std::vector<OutputWrite> writes;  // filled by lowering, like callees
  std::vector<uint32_t> callees;
};

// A type expression after resolution. `init` is the default of a derived type.
struct TypeUse {
  ir::TypeId type;
  ir::ConstId init;
};

struct SpecInfo {
  Name name;  // of the TYPE declaration whose whole content this is
  ExprId default_value;
  Progress progress = Progress::kNew;
  TypeUse use;
};

struct EnumRef {
  SpecId spec;
  uint32_t index = 0;
};

// The type of an expression before its context has spoken.
enum class Flex : uint8_t {
  kNone,     // `type` it is
  kInteger,  // any numeric type; `type` if the context does not care
  kReal,     // any real type
  kText,     // string literal: also CHAR or WCHAR
  kEnum,     // literal of several enumerations: the context's one
};

struct Note {
  ir::TypeId type;  // invalid: erroneous, already reported
  Flex flex = Flex::kNone;
  Progress progress = Progress::kNew;
  bool constant = false;
  bool calls = false;  // contains a call of a POU
  bool can_trap = false;
  VarId variable;  // kName: the variable meant
};

}  // namespace frontend
