// Phase: functions of one name or of open types. Chooses among overloads (overloads.cc), and makes
// the instance that a call needs of a function with parameters of open types, ANY_NUM or ARRAY[*]
// (open_functions.cc). Reads expressions and interfaces; adds POUs.
#pragma once

#include "frontend/sema/phase.h"

namespace frontend {

class OpenFunctions : public Phase {
 public:
  using Phase::Phase;

  Callee select_function(const Expr& call, uint32_t first);
  void check_overloads();
  // Is the type one of ANY, ANY_NUM and so on?
  static bool belongs(const ir::TypeTable& types, std::string_view group, ir::TypeId type);

 private:
  using ParameterTypes = std::vector<ir::TypeId>;  // by number in PouInfo::variables
  std::vector<Match> match(const Expr& call, const PouInfo& callee) const;
  uint32_t select_overload(const Expr& call, uint32_t first);
  std::optional<uint32_t> distance(const Expr& call, uint32_t pou);
  Callee bind_open(const Expr& call, uint32_t pou);
  bool bind_generic(const Match& match, const Spec& spec, NameMap<Note>& generic);
  bool bind_array(const Match& match, const Spec& spec, NameMap<Note>& generic);
  bool bind_element(ir::TypeId given, const Spec& spec, base::SourceSpan span,
                    NameMap<Note>& generic);
  uint32_t string_variant(const Expr& call, uint32_t pou);
  uint32_t instance_of(uint32_t pou, const ParameterTypes& types, NameMap<ir::TypeId> generic);
  std::string signature(const PouInfo& pou);
  void check_overloads_of(uint32_t first);
};

}  // namespace frontend
