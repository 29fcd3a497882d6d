// Phase: calls of methods and actions, and properties, by "Objects" in ir/program/ir.h (method.cc).
// It reads declarations, notes callees, and writes the code of receiver and call.
#pragma once

#include <optional>

#include "frontend/lower/body_phase.h"

namespace frontend {

class MethodCode : public BodyPhase {
 public:
  using BodyPhase::BodyPhase;

  Receiver receiver_of(const Expr& head);
  void prepare_receiver(const PouInfo& method, Receiver& receiver);
  void emit_method_call(const PouInfo& method, const Receiver& receiver);
  CallResult result_of(const PouInfo& callee);
  void bare_call(ExprId id);
  const MemberCode& property_code(ExprId id);
  CallResult nothing_read(ir::TypeId type);
  CallResult get_property(uint32_t getter, Receiver receiver);
  CallResult read_property(ExprId id);
  std::optional<Target> property_target(ExprId id);
  void set_property(const Target& target, std::optional<ir::ValueId> value);
  void settle(const Target& target);

 private:
  bool is_virtual(const PouInfo& method, const Receiver& receiver) const;
};

}  // namespace frontend
