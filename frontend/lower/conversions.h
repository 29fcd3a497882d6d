// Phase: conversions that a context asks for, which are lossless or reported, and those that the
// source writes (convert.cc, string_convert.cc). It reads types and writes code.
#pragma once

#include "frontend/lower/body_phase.h"

namespace frontend {

class Conversions : public BodyPhase {
 public:
  using BodyPhase::BodyPhase;

  ir::ValueId convert(Typed from, ir::TypeId to, base::SourceSpan span);
  bool fits(ir::TypeId from, ir::TypeId to, base::SourceSpan span);  // or says why not
  ir::ValueId emit_conversion(const Expr& expr, const Conversion& conversion);
  ir::Place to_string(const Expr& call, const Conversion& conversion, ir::TypeId type);
  void write_text(const ir::Place& text, Typed source);
  ir::Place narrow_string(ir::Place source, bool wide);

  // The number where no literal has it.
  void write_enumerator_name(const ir::Place& text, Typed source);

 private:
  ir::Place string_to_string(ExprId source, ir::TypeId type);
  ir::ValueId from_string(ExprId source, ir::TypeId to);
  ir::ValueId character_of(const ir::Place& text, ir::TypeId to);
};

}  // namespace frontend
