// Loops. All of them end soon: the product of the rounds of nested loops is bounded.
#include <algorithm>

#include "tests/differential/builder.h"

namespace differential {

// EXIT, CONTINUE or RETURN under a condition.
Stmt Builder::leave(const char* word) {
  Stmt out;
  out.tail = "END_IF;";
  Clause clause{"IF @0 THEN", {expression(elementary(ir::Kind::kBool), 2)}, {}, false};
  clause.body.push_back(simple(std::string(word) + ";", {}));
  out.clauses.push_back(std::move(clause));
  return out;
}

// From a start that is a constant, an edge of the type or computed, up or down.
Stmt Builder::for_statement(int depth) {
  if (loop_level_ >= loops_.size()) return assignment();
  auto [name, type] = loops_[loop_level_];
  Bounds all = range(type);
  uint32_t count = 1 + below(8);
  if (rounds_ * count > kMaxRounds) return assignment();
  int64_t step = one_in(2) ? 1 : 1 + below(3);
  bool down = group(type) == ir::Group::kSigned && one_in(3);
  int64_t span = step * (count - 1) + below(2);
  int64_t start = one_in(4) ? (down ? all.low + span : all.high - span)  // ends at the edge
                            : std::max<int64_t>(all.low, -3 + static_cast<int>(below(8)));
  int64_t low = start;
  int64_t high = std::min(all.high, start + span);
  // No round at all, if the type has such a value.
  if (one_in(10) && start > INT64_MIN) high = start - 1;
  if (high < all.low || low > all.high || low == INT64_MIN) return assignment();
  int64_t from = down ? high : low;
  int64_t to = down ? low : high;
  std::string step_text = down ? "-" + std::to_string(step) : std::to_string(step);
  std::string head = name + " := " + std::to_string(from) + " TO @0";
  std::vector<Expr> operands;
  operands.push_back(constant_text(type, std::to_string(to)));
  if (!down && from < 100 && to < 100 && one_in(4)) {
    operands[0] = small_integer(type, from, to, 1);
  }
  bool by = step != 1 || down || one_in(4);
  const bool any_step = !iec_ || group(type) == ir::Group::kSigned;  // a step can be negative
  if (by && !down && one_in(6) && any_step) {
    operands.push_back(small_integer(type, trap_in(10) ? 0 : step, step + 2, 1));
  } else if (by) {
    operands.push_back(constant_text(type, step_text));
  }
  Stmt out;
  out.tail = "END_FOR;";
  Clause clause{"FOR " + head + (by ? " BY @1 DO" : " DO"), std::move(operands), {}, false};
  ++loop_level_;
  ++in_loop_;
  rounds_ *= count;
  Variable counter{name, type, std::nullopt, {}, {}};
  places_[type].push_back({name, {}, type, false, false});
  if (one_in(4)) clause.body.push_back(leave("CONTINUE"));
  for (Stmt& inner : statements(1 + below(2), depth - 1)) clause.body.push_back(std::move(inner));
  if (one_in(4)) clause.body.push_back(leave(one_in(4) ? "RETURN" : "EXIT"));
  places_[type].pop_back();
  rounds_ /= count;
  --in_loop_;
  --loop_level_;
  out.clauses.push_back(std::move(clause));
  return out;
}

Stmt Builder::while_statement(int depth) {
  uint32_t count = 1 + below(6);
  if (guarded_ || rounds_ * count > kMaxRounds) return assignment();
  TypeRef boolean = elementary(ir::Kind::kBool);
  guarded_ = true;
  ++in_loop_;
  rounds_ *= count;
  bool repeat = one_in(2);
  Stmt loop;
  Clause clause{repeat ? "REPEAT" : "WHILE guard > 0 AND @0 DO", {}, {}, false};
  if (!repeat) clause.operands.push_back(expression(boolean, 1));
  Stmt down = simple("guard := guard - 1;", {});
  down.pinned = true;
  clause.body.push_back(std::move(down));
  if (one_in(4)) clause.body.push_back(leave("CONTINUE"));
  for (Stmt& inner : statements(1 + below(2), depth - 1)) clause.body.push_back(std::move(inner));
  if (one_in(4)) clause.body.push_back(leave("EXIT"));
  loop.clauses.push_back(std::move(clause));
  if (repeat) {
    loop.clauses.push_back(
        {"UNTIL guard <= 0 OR @0 END_REPEAT;", {expression(boolean, 1)}, {}, false});
  } else {
    loop.tail = "END_WHILE;";
  }
  rounds_ /= count;
  --in_loop_;
  guarded_ = false;
  // The guard is set in front of the loop, both under one roof so that nothing comes between.
  Stmt out;
  out.tail = "END_IF;";
  Clause roof{"IF TRUE THEN", {}, {}, false};
  Stmt set = simple("guard := " + std::to_string(count) + ";", {});
  set.pinned = true;
  roof.body.push_back(std::move(set));
  roof.body.push_back(std::move(loop));
  out.clauses.push_back(std::move(roof));
  return out;
}

}  // namespace differential
