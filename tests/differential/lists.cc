// Instruction lists: short groups of rows, each of which begins with LD, joined by jumps.
#include "tests/differential/builder.h"

namespace differential {

void Builder::row(std::vector<Stmt>& out, std::string text, std::vector<Expr> operands,
                  bool pinned) {
  out.push_back(simple(std::move(text), std::move(operands)));
  out.back().pinned = pinned;
}

// A variable or a literal.
Expr Builder::operand(TypeRef type) {
  std::optional<Expr> found = one_in(4) ? std::nullopt : variable(type);
  return found ? std::move(*found) : literal(type);
}

void Builder::instruction_list(Pou& pou, uint32_t groups) {
  std::vector<Stmt>& out = pou.body;
  rows_of_values(out);
  for (uint32_t n = groups; n > 0; --n) rows(out);
  if (pou.result == kNoType) return;
  std::optional<Expr> result = variable(pou.result);
  if (!result && !is_aggregate(pou.result)) result = literal(pou.result);
  if (!result) return;
  row(out, "LD @0", {std::move(*result)});
  row(out, "ST " + pou.name, {});
}

void Builder::rows(std::vector<Stmt>& out) {
  switch (below(7)) {
    case 0:
      return rows_of_bools(out);
    case 1:
      return rows_of_call(out);
    case 2:
      return rows_over(out);
    case 3:
      return rows_again(out);
    case 4:
      return rows_of_function(out);
    default:
      return rows_of_values(out);
  }
}

void Builder::rows_of_values(std::vector<Stmt>& out) {
  TypeRef type = elementary(static_cast<ir::Kind>(1 + below(10)));
  if (iec_ && is_bits(type)) type = elementary(ir::Kind::kDint);
  row(out, "LD @0", {operand(type)});
  static constexpr const char* kSums[] = {"ADD", "SUB", "MUL"};
  for (uint32_t n = below(3); n > 0; --n) {
    std::string word = kSums[below(3)];
    if (one_in(4)) {
      row(out, word + "( @0", {operand(type)});
      row(out, std::string(kSums[below(3)]) + " @0", {operand(type)});
      row(out, ")", {});
    } else if (is_integer(type) && one_in(4)) {
      row(out, one_in(2) ? "DIV @0" : "MOD @0", {small_integer(type, 1, 5, 0)});
    } else {
      row(out, word + " @0", {operand(type)});
    }
  }
  if (std::optional<Expr> to = target(type)) row(out, "ST @0", {std::move(*to)});
  if (!one_in(3)) return;
  static constexpr const char* kTests[] = {"GT", "GE", "EQ", "NE", "LE", "LT"};
  row(out, std::string(kTests[below(6)]) + " @0", {operand(type)});
  store_bool(out);
}

void Builder::store_bool(std::vector<Stmt>& out) {
  std::optional<Expr> to = target(elementary(ir::Kind::kBool));
  static constexpr const char* kStores[] = {"ST @0", "STN @0", "S @0", "R @0"};
  if (to) row(out, kStores[below(4)], {std::move(*to)});
}

void Builder::rows_of_bools(std::vector<Stmt>& out) {
  TypeRef type = elementary(one_in(3) ? ir::Kind::kWord : ir::Kind::kBool);
  row(out, one_in(4) ? "LDN @0" : "LD @0", {operand(type)});
  static constexpr const char* kWords[] = {"AND", "ANDN", "OR", "ORN", "XOR", "XORN", "&"};
  for (uint32_t n = 1 + below(3); n > 0; --n) {
    if (one_in(6)) {
      row(out, "NOT", {});
    } else if (one_in(4)) {
      row(out, std::string(kWords[below(6)]) + "( @0", {operand(type)});
      row(out, std::string(kWords[below(6)]) + " @0", {operand(type)});
      row(out, ")", {});
    } else {
      row(out, std::string(kWords[below(7)]) + " @0", {operand(type)});
    }
  }
  if (type == elementary(ir::Kind::kBool)) return store_bool(out);
  if (std::optional<Expr> to = target(type)) row(out, "ST @0", {std::move(*to)});
}

// Of a function block, with and without a condition.
void Builder::rows_of_call(std::vector<Stmt>& out) {
  std::optional<Stmt> call = block_call(1);
  if (!call) return;
  Clause& clause = call->clauses[0];
  static constexpr const char* kWords[] = {"CAL ", "CALC ", "CALCN "};
  uint32_t which = below(3);
  if (which > 0) row(out, "LD @0", {operand(elementary(ir::Kind::kBool))});
  row(out, kWords[which] + std::string("@0(@1)"), std::move(clause.operands));
}

// The current result is the first argument, or all of them stand in parentheses.
void Builder::rows_of_function(std::vector<Stmt>& out) {
  if (one_in(2)) {
    TypeRef type = elementary(ir::Kind::kDint);
    row(out, "LD @0", {operand(type)});
    row(out, one_in(2) ? "LIMIT @0, @1" : "MAX @0, @1", {operand(type), operand(type)});
    if (std::optional<Expr> to = target(type)) row(out, "ST @0", {std::move(*to)});
    return;
  }
  TypeRef type = any_elementary();
  std::optional<Expr> call = function_call(type, 1);
  std::optional<Expr> to = target(type);
  if (!call || !to) return;
  row(out, "@0", {std::move(*call)});
  row(out, "ST @0", {std::move(*to)});
}

void Builder::rows_over(std::vector<Stmt>& out) {
  std::string label = fresh("label");
  row(out, "LD @0", {operand(elementary(ir::Kind::kBool))});
  row(out, (one_in(2) ? "JMPC " : "JMPCN ") + label, {});
  rows_of_values(out);
  if (one_in(3)) {
    row(out, "LD @0", {operand(elementary(ir::Kind::kBool))});
    row(out, one_in(2) ? "RETC" : "RETCN", {});
  }
  row(out, label + ":", {});
  rows_of_values(out);
}

// Backwards while the guard lasts.
void Builder::rows_again(std::vector<Stmt>& out) {
  uint32_t rounds = 1 + below(3);
  if (guarded_ || rounds_ * rounds > kMaxRounds) return rows_of_values(out);
  guarded_ = true;
  rounds_ *= rounds;
  std::string label = fresh("label");
  row(out, "LD " + std::to_string(rounds), {}, true);
  row(out, "ST guard", {}, true);
  row(out, label + ":", {}, true);
  row(out, "LD guard", {}, true);
  row(out, "SUB 1", {}, true);
  row(out, "ST guard", {}, true);
  rows_of_values(out);
  rows_of_bools(out);
  row(out, "LD guard", {}, true);
  row(out, "GT 0", {}, true);
  row(out, "JMPC " + label, {}, true);
  rounds_ /= rounds;
  guarded_ = false;
}

}  // namespace differential
