// Evaluates one expression known to be constant; every failure is reported. Values of
// literals alone stay exact until their context gives them a type.
#pragma once

#include "frontend/sema/phase.h"

namespace frontend {

// Exact integers may grow to this before they are refused: far beyond any type, and
// products of two of them still fit.
inline constexpr Wide kMaxExact = static_cast<Wide>(1) << 62;

class Folder : private Phase {
 public:
  Folder(Sema& sema, const PouScope& scope, ir::TypeId context, Known least)
      : Phase(sema, scope), context_(context), least_(least) {}
  std::optional<Constant> fold(ExprId id);

 private:
  std::optional<Constant> literal(const Expr& expr);
  std::optional<Constant> name(ExprId id, const Expr& expr);
  std::optional<Constant> member(ExprId id, const Expr& expr);
  std::optional<Constant> part(ExprId id);
  std::optional<Constant> bits_of(ExprId id, const Expr& expr);
  std::optional<Constant> call(ExprId id);
  std::optional<Constant> enumerator(ir::TypeId type, const Expr& name);
  std::optional<Constant> unary(ExprId id, const Expr& expr);
  std::optional<Constant> binary(ExprId id, const Expr& expr);
  std::optional<Constant> compare(const Expr& expr, const Constant& a, const Constant& b);
  std::optional<Constant> real_binary(const Expr& expr, double a, double b, Constant result);
  std::optional<Constant> integer_binary(const Expr& expr, Wide a, Wide b, Constant result);
  bool is_whole_quotient(const Expr& expr, const Note& note) const;
  void warn_of_remainder(const Expr& expr, Wide a, Wide b) const;
  std::optional<Constant> exact(Constant result, Wide value, const Expr& expr);
  Constant of_bits(ir::TypeId type, uint64_t bits) const {
    return scalar_constant(sema_.program.types, type, bits);
  }
  double real_of(const Constant& value) const {
    return value.form == Constant::Form::kReal ? value.real : static_cast<double>(value.integer);
  }
  bool context_is_real() const {
    return context_.valid() && traits_of(sema_.program.types, context_).real;
  }

  ir::TypeId context_;
  Known least_;
};

}  // namespace frontend
