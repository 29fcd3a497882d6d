// Store: what the sources and the library declare, by name, and the records that declarations
// became. It reports nothing and resolves nothing. Collection fills it (collection.cc), and what
// is used for the first time is added while bodies are looked at; records have stable addresses.
#pragma once

#include <deque>
#include <map>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "frontend/sema/model.h"

namespace frontend {

// What a type made by open_arrays.cc stands for.
struct OpenArray {
  ir::TypeId element;
  uint32_t dims = 0;
  friend bool operator==(const OpenArray&, const OpenArray&) = default;
};

struct Declarations {
  // The instance type's POU, or null.
  const PouInfo* pou_of(ir::TypeId instance) const;
  const PouInfo* find_pou(std::string_view qualified) const;
  // The block or interface around a POU, which may be one itself; kNoPou: none.
  uint32_t block_of(uint32_t pou) const;
  PouScope scope_of(uint32_t pou) const { return pou == kNoPou ? PouScope() : PouScope(pous[pou]); }
  uint32_t block_of(const PouScope& scope) const { return block_of(scope.number()); }
  const StructureField* find_field(ir::TypeId structure, std::string_view name) const;
  // The number of a member that is no BIT; -1: there is none.
  int32_t find_member(ir::TypeId structure, std::string_view name) const;
  // A literal of an enumeration whose later values are computed just now; null: it is none. The
  // other argument becomes the type of its numbers.
  const ir::EnumLiteral* forming_literal(std::string_view name, ir::TypeId* base) const;
  // The number of a literal of an enumeration; -1: there is none.
  int32_t find_literal(ir::TypeId enumeration, std::string_view name) const;
  const OpenArray* open_array(ir::TypeId type) const;  // null: it is no ARRAY[*]
  // Keeps a name that no source has.
  std::string_view keep_name(std::string name);

  std::deque<PouInfo> pous;        // grows when library blocks are used
  std::deque<Variable> variables;  // by VarId
  std::vector<Name> any_parts;     // any_inputs.cc: variables whose pvalue and so on is named
  bool any_parts_known = false;
  bool globals_placed = false;  // all of global_order are members; later ones at once
  bool complete = false;        // all interfaces are resolved; later ones at once

  // By name; types and POUs by their full name.
  NameMap<uint32_t> pou_names;
  NameMap<SpecId> types;
  std::optional<NameMap<SpecId>> block_names;  // call_instances.cc: by their last names
  NameMap<VarId> globals;
  NameMap<GlobalList> lists;
  NameMap<std::vector<EnumRef>> literals;
  // Enumerations whose values are computed just now: their literals so far, which the value of a
  // later one may name.
  struct Forming {
    ir::TypeId base;
    const std::vector<ir::EnumLiteral>* literals = nullptr;
  };
  std::vector<Forming> forming;
  std::vector<VarId> global_order;
  const ResourceDecl* resource = nullptr;  // the one that is compiled
  size_t outer_globals = 0;  // of global_order: outside every RESOURCE, when there are several

  std::unordered_map<ir::TypeId, uint32_t> pou_by_type;
  std::unordered_map<ir::TypeId, NameMap<StructureField>> structures;
  std::unordered_map<ir::TypeId, NameMap<uint32_t>> enumerations;  // the numbers of their literals
  std::unordered_map<ir::TypeId, OpenArray> open_arrays;
  // Instances of functions with open parameters: by function and types.
  std::map<std::pair<uint32_t, std::vector<uint32_t>>, uint32_t> instances;

  std::deque<std::string> made_names;  // names and declarations that no source has
  std::deque<PouDecl> made_decls;
};

}  // namespace frontend
