// What the sources of a project name, and every place that names it: an index over one compilation
// that is kept (Sema and its tree), for all files and languages. Made by index() when somebody
// asks; it refers to the compilation by value only, and is stale after the next edit.
//
// Positions are those of the compilation's sources, where the text stands now
// (base::SourceMap::current).
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "base/ids.h"
#include "base/source.h"
#include "ir/types/types.h"

namespace stdlib {
struct FunctionRow;
}

namespace frontend {
class Sema;
struct PouInfo;
struct VariableTag;
using VarId = base::Id<VariableTag>;
}  // namespace frontend

namespace frontend::questions {

inline constexpr uint32_t kNoCode = 0xffffffffu;

enum class SymbolKind : uint8_t {
  kVariable,
  kField,       // of a structure or union
  kEnumerator,  // of an enumeration
  kType,
  kFunction,
  kFunctionBlock,
  kProgram,
  kClass,
  kInterface,
  kMethod,
  kAction,
  kProperty,
  kTransition,
  kTask,
  kInstance,  // of a program, in a RESOURCE
  kStandardFunction,
  kAddress,  // %IX0.0 in code
};
std::string_view word_of(SymbolKind kind);

struct Symbol {
  SymbolKind kind = SymbolKind::kVariable;
  std::string name;          // qualified: Plant.Pump.level
  base::SourceSpan defined;  // the name in its declaration; invalid: the compiler has it built in
  bool library = false;      // it is declared in the standard library
  ir::TypeId type;           // of what has one
  VarId variable;            // kVariable
  uint32_t pou = kNoCode;    // what has code, and kInterface
  const stdlib::FunctionRow* row = nullptr;  // kStandardFunction
  ir::DirectAddress address;                 // kAddress, and of a variable AT %IX0.0
};

enum class Role : uint8_t { kDeclared, kRead, kWritten, kReadWritten };

struct Occurrence {
  base::SourceSpan span;
  uint32_t symbol = 0;  // Index::symbols
  Role role = Role::kRead;
};

struct Index {
  std::vector<Symbol> symbols;
  std::vector<Occurrence> occurrences;      // by position
  std::vector<std::vector<uint32_t>> uses;  // by symbol: in `occurrences`

  // The occurrence at a position, or just before it; null: there is none.
  const Occurrence* at(base::SourcePos pos) const;
};

// Everything that sources other than the library's name.
Index index(Sema& sema);

}  // namespace frontend::questions
