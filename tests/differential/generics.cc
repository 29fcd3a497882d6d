// Functions of many types, the same in all programs that have them: ANY_* parameters, open
// arrays and overloads.
#include <iterator>

#include "tests/differential/builder.h"

namespace differential {
namespace {

struct Row {
  const char* name;
  const char* result;
  std::initializer_list<std::pair<Section, const char*>> variables;  // "a : ANY"
  std::initializer_list<const char*> body;
};

const Row kRows[] = {
    {"Pick",
     "ANY",
     {{Section::kInput, "first : BOOL"},
      {Section::kInput, "a : ANY"},
      {Section::kInput, "b : ANY"}},
     {"Pick := a;", "IF first THEN RETURN; END_IF", "Pick := b;"}},
    {"Blend",
     "ANY_NUM",
     {{Section::kInput, "a : ANY_NUM"},
      {Section::kInput, "b : ANY_NUM"},
      {Section::kLocal, "c : ANY_NUM"}},
     {"c := a - b;", "IF c > b THEN c := c + a; END_IF", "Blend := c * a;"}},
    {"Mask",
     "ANY_BIT",
     {{Section::kInput, "a : ANY_BIT"}, {Section::kInput, "b : ANY_BIT"}},
     {"Mask := (a XOR b) AND NOT (a AND b);"}},
    {"Swap",
     "BOOL",
     {{Section::kInOut, "a : ANY"}, {Section::kInOut, "b : ANY"}, {Section::kLocal, "c : ANY"}},
     {"c := a;", "a := b;", "b := c;", "Swap := TRUE;"}},
    {"Last",
     "ANY_ELEMENTARY",
     {{Section::kInput, "a : ARRAY[*] OF ANY_ELEMENTARY"}},
     {"Last := a[UPPER_BOUND(a, 1)];"}},
    {"Over", "DINT", {{Section::kInput, "a : DINT"}}, {"Over := a + 1;"}},
    {"Over", "DINT", {{Section::kInput, "a : LREAL"}}, {"IF a > 1.0 THEN Over := 2; END_IF"}},
    {"Over", "DINT", {{Section::kInput, "a : STRING[80]"}}, {"Over := LEN(a);"}},
    {"Over",
     "DINT",
     {{Section::kInput, "a : TIME"}, {Section::kInput, "b : TIME"}},
     {"IF a < b THEN Over := 4; END_IF"}},
};

}  // namespace

void Builder::declare_generics() {
  for (const Row& row : kRows) {
    Pou pou;
    pou.name = row.name;
    pou.result = named(Form::kGeneric, row.result, kNoType);
    for (const auto& [kind, text] : row.variables) {
      std::string all = text;
      size_t colon = all.find(" : ");
      TypeRef type = named(Form::kGeneric, all.substr(colon + 3), kNoType);
      section(pou, kind).variables.push_back({all.substr(0, colon), type, std::nullopt, {}, {}});
    }
    for (const char* line : row.body) pou.body.push_back(simple(line, {}));
    program_.pous.push_back(std::move(pou));
  }
  generics_ = true;
}

std::optional<Expr> Builder::generic_call(TypeRef type, int depth) {
  if (!generics_) return std::nullopt;
  auto two = [&] { return std::vector<Expr>{read(type), read(type)}; };
  switch (below(4)) {
    case 0: {
      if (is(type, Form::kSubrange)) return std::nullopt;
      std::vector<Expr> args = two();
      args.insert(args.begin(), expression(elementary(ir::Kind::kBool), depth - 1));
      return node(type, "Pick(@*)", std::move(args));
    }
    case 1:
      if (is_number(type)) return node(type, "Blend(@*)", two());
      if (group(type) == ir::Group::kBit) return node(type, "Mask(@*)", two());
      return std::nullopt;
    case 2: {
      TypeRef open = open_array(type, 1);
      if (!is_elementary(type) || !possible(open)) return std::nullopt;
      return node(type, "Last(@0)", {expression(open, depth)});
    }
    default: {
      if (type != elementary(ir::Kind::kDint)) return std::nullopt;
      static constexpr ir::Kind kKinds[] = {ir::Kind::kDint, ir::Kind::kLreal, ir::Kind::kTime};
      TypeRef chosen = one_in(4) ? string_type(false, 80) : elementary(kKinds[below(3)]);
      std::vector<Expr> args = {read(chosen)};
      if (chosen == elementary(ir::Kind::kTime)) args.push_back(read(chosen));
      return node(type, "Over(@*)", std::move(args));
    }
  }
}

std::optional<Stmt> Builder::swap_call() {
  const Place* found = generics_ ? find_any() : nullptr;
  if (found == nullptr || holds_block(found->type) || is(found->type, Form::kSubrange))
    return std::nullopt;
  std::optional<Expr> a = target(found->type);
  std::optional<Expr> b = a ? target(a->type) : std::nullopt;
  if (!b) return std::nullopt;
  return simple("Swap(@0, @1);", {std::move(*a), std::move(*b)});
}

}  // namespace differential
