// __TRY, and declared recursion: what ends in a defined way although something goes wrong or deep.
#include "tests/differential/builder.h"

namespace differential {
namespace {

constexpr uint32_t kDeclaredDepth = 5;

}  // namespace

// Something that traps when its condition holds.
Stmt Builder::fault() {
  Stmt out;
  out.tail = "END_IF;";
  Clause clause{"IF @0 THEN", {expression(elementary(ir::Kind::kBool), 2)}, {}, false};
  static constexpr const char* kFaults[] = {"spare := 1 / (guard - guard);",
                                            "spare := 7 MOD (guard - guard);",
                                            "spare := LREAL_TO_DINT(DINT_TO_LREAL(guard) + 1E30);",
                                            "spare := BCD_TO_DINT(DWORD#16#F OR DINT_TO_DWORD(guard));"};
  clause.body.push_back(simple(kFaults[below(4)], {}));
  out.clauses.push_back(std::move(clause));
  return out;
}

Stmt Builder::try_statement(int depth) {
  Stmt out;
  out.tail = "__ENDTRY";
  const bool caught = (caught_ == 0 && !risky_) || !one_in(4);
  const bool cleaned = !caught || one_in(3);
  ++caught_;
  Clause clause{"__TRY", {}, statements(1 + below(2), depth - 1), false};
  if (one_in(2)) clause.body.push_back(fault());
  if (in_loop_ && one_in(4)) clause.body.push_back(leave(one_in(2) ? "EXIT" : "CONTINUE"));
  if (one_in(8)) clause.body.push_back(leave("RETURN"));
  if (one_in(2)) clause.body.push_back(statement(depth - 1));
  --caught_;
  out.clauses.push_back(std::move(clause));
  if (caught) {
    Clause handler{"__CATCH", {}, {}, true};
    if (std::optional<Expr> kind = target(elementary(one_in(2) ? ir::Kind::kDint : ir::Kind::kInt));
        kind && one_in(2)) {
      handler.head = "__CATCH(@0)";
      handler.operands.push_back(std::move(*kind));
    }
    handler.body = statements(1, depth - 1);
    out.clauses.push_back(std::move(handler));
  }
  if (cleaned) out.clauses.push_back({"__FINALLY", {}, statements(1, depth - 1), true});
  return out;
}

// The call one level deeper, `depth` times at most; nothing else in the body calls it.
void Builder::descend(Pou& pou, const Interface& face, const std::string& receiver) {
  pou.attribute = "{attribute 'recursion_depth' := '" + std::to_string(kDeclaredDepth) + "'}";
  Stmt bottom;
  bottom.tail = "END_IF;";
  bottom.clauses.push_back({"IF depth <= 0 THEN", {}, {}, false});
  bottom.clauses[0].body.push_back(simple("RETURN;", {}));
  bottom.clauses[0].body.back().pinned = true;
  bottom.pinned = true;
  prologue_.insert(prologue_.begin(), std::move(bottom));
  descending_ = true;
  for (uint32_t n = 1 + below(2); n > 0; --n) {
    std::optional<std::vector<Expr>> args = arguments(face, false, 1);
    if (!args) continue;
    Expr list = node(kNoType, "@*", std::move(*args));
    std::string call = receiver + face.name + "(@0)";
    std::optional<Expr> to;
    if (face.result != kNoType) to = target(face.result);
    prologue_.push_back(to ? simple("@1 := " + call + ";", {std::move(list), std::move(*to)})
                           : simple(call + ";", {std::move(list)}));
  }
}

// One function that calls itself, or two that call each other.
void Builder::recursive_functions() {
  std::vector<Interface> faces;
  for (uint32_t n = 1 + below(2); n > 0; --n) {
    Interface face = method_face("Deep");
    face.recursive = true;
    face.inputs.insert(face.inputs.begin(), {"depth", elementary(ir::Kind::kInt)});
    faces.push_back(std::move(face));
  }
  for (const Interface& face : faces) {
    forget();
    kind_ = PouKind::kFunction;
    rounds_ = kMaxRounds;
    Pou pou = head_of(face);
    pou.kind = kind_;
    for (const Variable& one : face.inputs) see(one, false);
    for (const Variable& one : face.outputs) see(one, true);
    for (const Variable& one : face.in_outs) see(one, true);
    locals(pou, 2);
    descend(pou, &face == &faces[0] ? faces.back() : faces[0], "");
    body(pou, 1 + below(3), 1);
    if (pou.result != kNoType && possible(pou.result)) {
      pou.body.push_back(simple(pou.name + " := @0;", {expression(pou.result, 2)}));
    }
    program_.pous.push_back(std::move(pou));
  }
  functions_.insert(functions_.end(), faces.begin(), faces.end());
  descending_ = false;
}

// What counts down: one less from inside, little from outside; now and then too much.
Expr Builder::descent() {
  TypeRef type = elementary(ir::Kind::kInt);
  Expr out = constant_text(type, descending_ ? "depth - 1" : std::to_string(below(4)));
  if (!descending_ && trap_in(10)) out.pattern = "INT#" + std::to_string(kDeclaredDepth + 2);
  out.fixed = true;
  return out;
}

}  // namespace differential
