// Paths through program instances: VAR_CONFIG gives addresses and initial values to variables of
// single instances, VAR_ACCESS names variables for the outside (IEC 61131-3, Table 16). What it
// finds goes to the program of the Sema that it works for.
#pragma once

#include <string>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "frontend/sema/phase.h"

namespace frontend {

class InstancePaths : public Phase {
 public:
  using Phase::Phase;

  // The VAR_CONFIG and VAR_ACCESS among `blocks`, when all instances are there.
  void configure(const std::vector<VarBlock>& blocks);
  // Reports each AT %I*, %Q*, %M* that has no address then.
  void check_open_addresses();

 private:
  struct Path;
  void configure_variable(const VarDecl& decl);
  void add_access(const VarDecl& decl);
  bool walk(ExprId expr, Path& path);
  bool global(VarId id, Path& path);
  void view(const AddressView& view, Path& path);
  bool head(const Expr& expr, Path& path);
  bool member(const Expr& expr, Path& path);
  bool element(const Expr& expr, Path& path);
  bool check_type(const VarDecl& decl, const Path& path);
  ir::ConstId with_initial(ir::ConstId before, ir::TypeId type, const std::vector<uint32_t>& steps,
                           size_t at, ExprId init);
  bool holds_open(ir::TypeId type);
  using Known = std::unordered_set<std::string>;  // folded paths that VAR_CONFIG names
  void check_part(ir::TypeId type, const std::string& path, base::SourceSpan span,
                  const Known& known);
  void check_members(ir::TypeId type, const std::string& prefix, base::SourceSpan span,
                     const Known& known);

  std::unordered_map<ir::TypeId, bool> holds_open_;
};

}  // namespace frontend
