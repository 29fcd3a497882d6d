// Namespaces (IEC 61131-3 edition 3, 6.9): what a name means where it is written. Every
// declaration has one qualified name, A.B.Pump: the key of tables in Declarations and the name in
// the program. Only find() knows the way from a written name to it: the namespaces around the
// place, from the inside out; then USING; then the names that vendors gave the standard library.
// docs/adr/0010-namespaces.md.
//
// Made of the tree before anything is collected; declare() with each declaration of the project,
// check() when all of them are known, find() from then on. Views live as long as this.
#pragma once

#include <optional>
#include <unordered_set>

#include "frontend/sema/model.h"

namespace frontend {

class Sema;

// Names of different sorts do not hide each other.
enum class NameSort : uint8_t { kDeclaration, kVariable, kLiteral, kList };

class Namespaces {
 public:
  explicit Namespaces(Sema& sema);

  // Makes a declaration known; its qualified name.
  std::string_view declare(NameSort sort, ScopeId scope, const Name& name,
                           Access access = Access::kDefault);
  std::string_view qualified(ScopeId scope, std::string_view name);
  std::string_view keep(std::string text);
  // Reports what USING names without there being such a namespace.
  void check();

  // The qualified name that is meant; the written one where nobody of the project declares it.
  // Reports ambiguous and INTERNAL names, once each.
  std::string_view find(NameSort sort, const Name& name);
  std::string_view find(NameSort sort, Range32 qualifiers, const Name& name);
  // The full name that `x` or `A.B.x` means in code; "": it is neither, or `A.B` is no namespace.
  std::string_view find(NameSort sort, const PouScope& scope, const Expr& expr);
  // The global variable of that name; invalid: there is none.
  VarId find_global(const Name& name);
  // The same for `A.x` or `List.x` in code.
  VarId find_global(const PouScope& scope, const Expr& member);
  // The list of globals that `L` or `A.L` in code means; null: it means none.
  const GlobalList* list(const PouScope& scope, const Expr& head);
  // Is `A.f` in code a name of a namespace, and of no variable there?
  bool declares(const PouScope& scope, const Expr& expr);
  // A list of globals or a namespace: what stands after the dot is no member of a value.
  bool is_scope(const PouScope& scope, const Expr& head) {
    return list(scope, head) != nullptr || is_namespace(scope, head);
  }
  // Do several USINGs give this literal? Then its context decides, as among enumerations.
  bool is_ambiguous(const Name& literal) const {
    return several_.contains(literal.span.begin.offset);
  }
  // Does `A.B` in code name a namespace?
  bool is_namespace(const PouScope& scope, const Expr& expr);
  // The same when no variable hides it.
  bool is_path(const Expr& expr) const;
  // Is the place inside of the namespace that `scope` is?
  bool inside(base::SourcePos at, ScopeId scope) const;

 private:
  struct Declared {
    ScopeId scope;
    Access access = Access::kDefault;
  };
  using Table = NameMap<Declared>;
  static constexpr uint32_t kNoRegion = 0xffffffffu;

  // A piece of source in a namespace, or with USINGs of its own. They nest.
  struct Region {
    base::SourceSpan span;
    uint32_t outer = kNoRegion;
    std::string_view path;
    std::vector<Range32> written;          // USING
    std::vector<std::string_view> usings;  // the namespaces that are meant
    size_t used = 0;                       // by those around it, too
  };

  void add_scopes();
  void add_pous(const std::vector<PouDecl>& pous);
  void nest_regions();
  void resolve_using(Region& region, Range32 written);
  uint32_t region_at(base::SourcePos at) const;
  std::string_view path_at(base::SourcePos at) const;

  std::string_view find(NameSort sort, std::string_view written, base::SourceSpan span);
  Table::const_iterator find_around(const Table& table, std::string_view written,
                                    std::string_view path) const;
  Table::const_iterator find_used(NameSort sort, const Name& name);
  std::string_view find_in_library(NameSort sort, std::string_view written);
  std::string_view library_alias(std::string_view name);
  // The innermost namespace around whose own INTERNAL keeps `from` out; nullopt: none does.
  std::optional<std::string_view> closed_to(const Declared& declared, std::string_view from) const;
  void report_internal(std::string_view name, std::string_view path, base::SourceSpan span);
  bool first_report(base::SourceSpan span);
  const Expr* head_of(const Expr& expr) const;
  std::string path_of(const Expr& expr) const;
  std::string path_of(Range32 names) const;

  Sema& sema_;
  std::vector<std::string_view> paths_;  // by scope
  NameMap<bool> known_;                  // the paths
  NameMap<bool> words_;                  // what they consist of
  std::vector<Region> regions_;          // by begin
  Table declared_[4];                    // by NameSort
  std::unordered_set<std::string> texts_;
  std::unordered_set<uint32_t> reported_;  // begin of the place
  std::unordered_set<uint32_t> several_;   // literals of several namespaces
};

}  // namespace frontend
