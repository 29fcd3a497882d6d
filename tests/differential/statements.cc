// Statements other than loops.
#include <algorithm>

#include "tests/differential/builder.h"

namespace differential {

Stmt Builder::simple(std::string head, std::vector<Expr> operands) {
  Stmt out;
  out.clauses.push_back({std::move(head), std::move(operands), {}, false});
  return out;
}

std::vector<Stmt> Builder::statements(uint32_t count, int depth) {
  std::vector<Stmt> out;
  for (uint32_t i = 0; i < count; ++i) out.push_back(statement(depth));
  return out;
}

Stmt Builder::statement(int depth) {
  std::optional<Stmt> found;
  switch (below(depth <= 0 ? 8 : 17)) {
    case 0:
      found = aggregate_assignment();
      break;
    case 1:
      found = one_in(3) ? character_assignment() : bit_assignment();
      break;
    case 2:
      found = one_in(6) ? split_call(2) : one_in(6) ? swap_call() : call_statement(2);
      break;
    case 3:
      found = one_in(2) ? method_statement(2) : block_call(2);
      break;
    case 4:
      if (iec_) break;
      found = one_in(2) ? chain() : set_or_reset();
      break;
    case 5:
      found = one_in(4) ? step() : one_in(4) ? retarget() : one_in(2) ? rebind() : std::nullopt;
      break;
    case 14:
      if (iec_) break;
      if (one_in(3)) return jump_over(depth);
      if (one_in(2)) found = jump_back(depth);
      break;
    case 8:
    case 9:
      return if_statement(depth);
    case 10:
    case 11:
      return case_statement(depth);
    case 12:
    case 13:
      return for_statement(depth);
    case 15:
      return while_statement(depth);
    case 16:
      return try_statement(depth);
    default:
      break;
  }
  return found ? std::move(*found) : assignment();
}

Stmt Builder::assignment() {
  for (int tries = 0; tries < 10; ++tries) {
    TypeRef type = any_scalar();
    std::optional<Expr> to = target(type);
    if (!to) continue;
    std::optional<TypeRef> source = one_in(5) ? narrower(type) : std::nullopt;
    bool bare = !source && one_in(8);
    Expr value = bare ? literal(type, true) : expression(source.value_or(type), 3);
    return simple("@0 := @1;", {std::move(*to), std::move(value)});
  }
  return simple("spare := @0;", {expression(elementary(ir::Kind::kDint), 3)});
}

std::optional<Stmt> Builder::aggregate_assignment() {
  TypeRef type = one_in(2) ? any_of(structs_) : one_in(3) ? any_of(unions_) : any_of(arrays_);
  if (!nodes_.empty() && one_in(6)) type = any_of(nodes_);
  std::optional<Expr> to = target(type);
  if (!to) return std::nullopt;
  std::optional<Expr> call = one_in(3) ? function_call(type, 2) : std::nullopt;
  std::optional<Expr> from = call ? std::move(call) : variable(type);
  if (!from) return std::nullopt;
  return simple("@0 := @1;", {std::move(*to), std::move(*from)});
}

std::optional<Stmt> Builder::bit_assignment() {
  if (!bits_.empty() && one_in(3)) {
    const Place& place = bits_[below(count(bits_))];
    if (!place.writable) return std::nullopt;
    Expr bit = use(place, 1);
    bit.fixed = true;
    const char* word = one_in(4) && !iec_ ? "@0 S= @1;" : "@0 := @1;";
    return simple(word, {std::move(bit), expression(elementary(ir::Kind::kBool), 2)});
  }
  static constexpr ir::Kind kWords[] = {ir::Kind::kByte, ir::Kind::kWord, ir::Kind::kDword,
                                        ir::Kind::kLword};
  uint32_t size = below(4);
  std::optional<Expr> to = target(elementary(kWords[size]));
  if (!to) return std::nullopt;
  if (size > 1 && one_in(4)) {
    return simple("@0.%W" + std::to_string(below(1u << (size - 1))) + " := @1;",
                  {std::move(*to), expression(elementary(ir::Kind::kWord), 2)});
  }
  if (size > 2 && one_in(4)) {
    return simple("@0.%D" + std::to_string(below(2)) + " := @1;",
                  {std::move(*to), expression(elementary(ir::Kind::kDword), 2)});
  }
  if (size > 0 && one_in(3)) {
    return simple("@0.%B" + std::to_string(below(1u << size)) + " := @1;",
                  {std::move(*to), expression(elementary(ir::Kind::kByte), 2)});
  }
  return simple((one_in(3) ? "@0.%X" : "@0.") + std::to_string(below(8u << size)) + " := @1;",
                {std::move(*to), expression(elementary(ir::Kind::kBool), 2)});
}

std::optional<Stmt> Builder::character_assignment() {
  const bool wide = one_in(3);
  TypeRef type = iec_ ? elementary(wide ? ir::Kind::kWchar : ir::Kind::kChar)
                      : elementary(wide ? ir::Kind::kWord : ir::Kind::kByte);
  std::optional<Expr> to = character(type, true, 1);
  if (!to) return std::nullopt;
  return simple("@0 := @1;", {std::move(*to), expression(type, 2)});
}

// a := b := value;
std::optional<Stmt> Builder::chain() {
  TypeRef type = any_scalar();
  std::optional<Expr> first = target(type);
  std::optional<Expr> second = target(type);
  if (!first || !second) return std::nullopt;
  return simple("@0 := @1 := @2;", {std::move(*first), std::move(*second), expression(type, 2)});
}

std::optional<Stmt> Builder::set_or_reset() {
  TypeRef boolean = elementary(ir::Kind::kBool);
  std::optional<Expr> to = target(boolean);
  if (!to) return std::nullopt;
  return simple(one_in(2) ? "@0 S= @1;" : "@0 R= @1;", {std::move(*to), expression(boolean, 2)});
}

// Forwards only, so that it ends. The roof makes it one statement.
Stmt Builder::jump_over(int depth) {
  std::string label = fresh("label");
  Clause roof{"IF TRUE THEN", {}, {}, false};
  roof.body.push_back(leave(("JMP " + label).c_str()));
  for (Stmt& one : statements(1 + below(2), depth - 1)) roof.body.push_back(std::move(one));
  roof.body.push_back(simple(label + ":", {}));
  roof.body.push_back(assignment());
  Stmt out;
  out.tail = "END_IF;";
  out.clauses.push_back(std::move(roof));
  return out;
}

// Backwards while the guard lasts.
std::optional<Stmt> Builder::jump_back(int depth) {
  uint32_t rounds = 1 + below(4);
  if (guarded_ || rounds_ * rounds > kMaxRounds) return std::nullopt;
  guarded_ = true;
  rounds_ *= rounds;
  std::string label = fresh("label");
  Clause roof{"IF TRUE THEN", {}, {}, false};
  auto pinned = [&](std::string text) {
    Stmt one = simple(std::move(text), {});
    one.pinned = true;
    roof.body.push_back(std::move(one));
  };
  pinned("guard := " + std::to_string(rounds) + ";");
  pinned(label + ":");
  pinned("guard := guard - 1;");
  for (Stmt& one : statements(1 + below(2), depth - 1)) roof.body.push_back(std::move(one));
  Stmt again;
  again.tail = "END_IF;";
  Expr condition = expression(elementary(ir::Kind::kBool), 2);
  again.clauses.push_back({"IF guard > 0 AND @0 THEN", {std::move(condition)}, {}, false});
  again.clauses[0].body.push_back(simple("JMP " + label + ";", {}));
  roof.body.push_back(std::move(again));
  rounds_ /= rounds;
  guarded_ = false;
  Stmt out;
  out.tail = "END_IF;";
  out.clauses.push_back(std::move(roof));
  return out;
}

Stmt Builder::if_statement(int depth) {
  TypeRef boolean = elementary(ir::Kind::kBool);
  Stmt out;
  out.tail = "END_IF;";
  out.clauses.push_back(
      {"IF @0 THEN", {expression(boolean, 3)}, statements(1 + below(2), depth - 1), false});
  while (one_in(3)) {
    out.clauses.push_back(
        {"ELSIF @0 THEN", {expression(boolean, 2)}, statements(1, depth - 1), true});
  }
  if (one_in(2)) out.clauses.push_back({"ELSE", {}, statements(below(3), depth - 1), true});
  return out;
}

Stmt Builder::case_statement(int depth) {
  if (one_in(3)) {
    return case_enum(enums_[below(static_cast<uint32_t>(enums_.size()))], depth);
  }
  return case_integer(depth);
}

// Labels ascend, so that they never overlap.
Stmt Builder::case_integer(int depth) {
  TypeRef type = elementary(static_cast<ir::Kind>(1 + below(8)));
  Bounds all = range(type);
  Stmt out;
  out.tail = "END_CASE;";
  Expr selector =
      one_in(2) ? read(type) : small_integer(type, std::max<int64_t>(all.low, -5), 20, 2);
  out.clauses.push_back({"CASE @0 OF", {std::move(selector)}, {}, false});
  int64_t next = one_in(6) && all.low > INT64_MIN ? all.low : std::max<int64_t>(all.low, -6);
  for (uint32_t arms = 1 + below(5); arms > 0; --arms) {
    std::string labels;
    for (uint32_t n = one_in(2) ? 1 : 1 + below(3); n > 0 && next <= all.high - 20; --n) {
      if (!labels.empty()) labels += ", ";
      labels += std::to_string(next);
      if (one_in(3)) labels += ".." + std::to_string(next += 1 + below(4));
      next += 1 + below(3);
    }
    if (labels.empty()) break;
    out.clauses.push_back({labels + ":", {}, statements(1, depth - 1), true});
  }
  if (one_in(6) && all.high > next) {
    out.clauses.push_back({std::to_string(all.high) + ":", {}, statements(1, depth - 1), true});
  }
  if (one_in(2)) out.clauses.push_back({"ELSE", {}, statements(1, depth - 1), true});
  return out;
}

Stmt Builder::case_enum(TypeRef type, int depth) {
  std::vector<std::string> literals = program_[type].literals;
  std::string prefix = one_in(2) ? program_[type].name + "#" : "";
  Stmt out;
  out.tail = "END_CASE;";
  out.clauses.push_back({"CASE @0 OF", {read(type)}, {}, false});
  for (size_t i = 0; i < literals.size(); ++i) {
    if (one_in(4)) continue;
    std::string labels = prefix + literals[i];
    if (one_in(3) && i + 1 < literals.size()) labels += ", " + prefix + literals[++i];
    out.clauses.push_back({labels + ":", {}, statements(1, depth - 1), true});
  }
  if (out.clauses.size() == 1 || one_in(2)) {
    if (out.clauses.size() == 1) {
      out.clauses.push_back({prefix + literals[0] + ":", {}, statements(1, depth - 1), false});
    }
    out.clauses.push_back({"ELSE", {}, statements(1, depth - 1), true});
  }
  return out;
}

}  // namespace differential
