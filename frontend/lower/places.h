// Phase: where variables, members, elements and constants are (place.cc, character.cc). It reads
// declarations and facts, writes the code that computes indices, and notes which outputs and common
// globals the POU uses (PouInfo).
#pragma once

#include "frontend/lower/body_phase.h"

namespace frontend {

class Places : public BodyPhase {
 public:
  using BodyPhase::BodyPhase;

  ir::Place place(ExprId expr);
  ir::Place raw_place(ExprId expr);
  ir::Place variable_place(VarId id);
  ir::Place bit_word_place(ExprId structure, const Note& part);
  ir::Place view_place(const AddressView& view);
  ir::Place view_place(ExprId id);
  void note_output(const ir::DirectAddress& address, ir::TypeId type, base::SourceSpan span);
  void note_outer_use(VarId global, bool written, base::SourceSpan span);
  bool is_character(ExprId expr);
  ir::ValueId character_position(const Expr& expr);
  ir::ValueId open_bound(ExprId array, uint32_t dimension, bool upper);  // open_array.cc

 private:
  ir::Place member_place(const Expr& expr);
  ir::Place property_place(ExprId id);
  ir::Place index_place(const Expr& expr);
  ir::Place open_element(const Expr& expr, const OpenArray& open);
  ir::Place constant_place(ExprId expr);
};

}  // namespace frontend
