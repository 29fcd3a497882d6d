// Phase: constants and initial values (fold.cc, fit.cc, initial_values.cc, initial_part.cc). Reads
// expressions and types; writes constants of the program.
#pragma once

#include "frontend/sema/phase.h"

namespace frontend {

// Whether a reference in an initial value may stand for an expression that no constant is: start
// code then binds it (start_values.h).
enum class Bound : uint8_t { kNow, kAtStart };

class Constants : public Phase {
 public:
  using Phase::Phase;

  // --- constants (fold*.cc, initial_values.cc)
  // Does `target`, an integer or a bit string, hold it, as a number or as its bits?
  bool fits(const Constant& value, ir::TypeId target) const;
  // nullopt when reported. `context` steers literals; may be invalid.
  std::optional<Constant> fold(ExprId expr, ir::TypeId context, Known least = Known::kByCall);
  std::optional<uint64_t> fold_bits(ExprId expr, ir::TypeId target, Known least = Known::kByCall);
  std::optional<int64_t> fold_integer(ExprId expr);
  // Of what is no pointer or reference: interfaces, and numbers of codesys and twincat.
  bool takes_null(ir::TypeId target) const;
  // Bits of a constant as a value of scalar type `target`; reports what does not fit.
  std::optional<uint64_t> fit(const Constant& value, ir::TypeId target, base::SourceSpan span);
  std::optional<std::string> fit_text(const Constant& value, ir::TypeId target,
                                      base::SourceSpan span);
  // Initial value of any type; invalid when reported. What a list leaves out keeps its
  // value in `otherwise`, the default of the declared type.
  ir::ConstId initial_value(ExprId expr, ir::TypeId type, ir::ConstId otherwise,
                            Known least = Known::kInitially, Bound bound = Bound::kNow);
  // What an initial value says of one element or member; invalid: nothing.
  ir::ConstId listed(ir::ConstId list, uint64_t index) const;
  // The initial value of a variable, or of a part of one, with `known` above kNo.
  std::optional<TypeUse> initial_part(ExprId expr);
  // initial_part.cc
  ir::ConstId member_default(ir::TypeId type, uint32_t member);

 private:
  // Bits for a signed integer, a negative number for a bit string: taken as they are, with a
  // warning, unless the dialect is the standard's own.
  bool has_same_bits(const Constant& value, Wide integer, ir::TypeId target) const;
  std::optional<uint64_t> same_bits(const Constant& value, Wide integer, ir::TypeId target,
                                    base::SourceSpan span);
  std::optional<TypeUse> initial_variable(const Expr& expr, VarId id);
  std::optional<TypeUse> initial_member(const Expr& expr);
  std::optional<TypeUse> initial_element(const Expr& expr);
};

}  // namespace frontend
