// Calls of functions and function blocks: named, positional and mixed arguments, omitted
// inputs, outputs and in-outs.
#include "base/diagnostics.h"
#include "base/source.h"
#include "frontend/parse/parse.h"
#include "stdlib/sources.h"
#include "tests/differential/builder.h"

namespace differential {
namespace {

// `pattern` has one hole.
Expr argument(std::string pattern, Expr value) {
  Expr expr;
  expr.pattern = std::move(pattern);
  expr.operands.push_back(std::move(value));
  return expr;
}

}  // namespace

bool Builder::callable(const Interface& callee) {
  for (const Variable& in_out : callee.in_outs) {
    if (find(in_out.type, true) == nullptr) return false;
  }
  for (const Variable& input : callee.inputs) {
    if (!possible(input.type)) return false;
  }
  return true;
}

// nullopt when an in-out has nothing to be bound to.
std::optional<std::vector<Expr>> Builder::arguments(const Interface& callee, bool block,
                                                    int depth) {
  if (!callable(callee)) return std::nullopt;
  std::vector<Expr> out;
  bool positional = one_in(3);
  const bool all_named = !positional;
  for (const Variable& input : callee.inputs) {
    const bool counted = callee.recursive && &input == callee.inputs.data();
    bool given = positional || counted || is(input.type, Form::kOpenArray);
    if (!given && one_in(5)) continue;
    Expr value = counted ? descent() : expression(input.type, depth);
    bool named = !positional;
    out.push_back(named ? argument(input.name + " := @0", std::move(value))
                        : argument("@0", std::move(value)));
    if (block && one_in(4)) positional = false;
  }
  if (all_named && one_in(10)) {
    TypeRef boolean = elementary(ir::Kind::kBool);
    out.insert(out.begin(), argument("EN := @0", expression(boolean, depth)));
    std::optional<Expr> place = one_in(2) ? target(boolean) : std::nullopt;
    if (place) out.push_back(argument("ENO => @0", std::move(*place)));
  }
  for (const Variable& in_out : callee.in_outs) {
    auto extended = derived_.find(in_out.type);
    std::optional<Expr> place;
    if (extended != derived_.end() && one_in(2)) place = target(any_of(extended->second));
    if (!place) place = target(in_out.type);
    if (!place) return std::nullopt;
    out.push_back(argument(in_out.name + " := @0", std::move(*place)));
  }
  for (const Variable& output : callee.outputs) {
    if (!one_in(2)) continue;
    std::optional<Expr> place = target(output.type);
    bool inverted = output.type == elementary(ir::Kind::kBool) && one_in(4);
    std::string name = (inverted ? "NOT " : "") + output.name;
    if (place) out.push_back(argument(name + " => @0", std::move(*place)));
  }
  return out;
}

std::optional<Stmt> Builder::block_call(int depth) {
  std::vector<std::pair<TypeRef, const Interface*>> seen;
  for (const auto& [type, face] : faces_) {
    if (face.callable && places_.contains(type)) seen.emplace_back(type, &face);
  }
  if (seen.empty()) return std::nullopt;
  auto [type, face] = seen[below(static_cast<uint32_t>(seen.size()))];
  const Place* place = find(type, true);
  if (place == nullptr) return std::nullopt;
  std::optional<std::vector<Expr>> args = arguments(*face, true, depth);
  if (!args) return std::nullopt;
  Expr instance = use(*place, 1);
  instance.fixed = true;
  Expr list = node(kNoType, "@*", std::move(*args));
  return simple("@0(@1);", {std::move(instance), std::move(list)});
}

std::optional<Stmt> Builder::call_statement(int depth) {
  if (functions_.empty()) return std::nullopt;
  const Interface& callee = functions_[below(static_cast<uint32_t>(functions_.size()))];
  if (callee.recursive && descending_) return std::nullopt;
  std::optional<std::vector<Expr>> args = arguments(callee, false, depth);
  if (!args) return std::nullopt;
  return simple(callee.name + "(@0);", {node(kNoType, "@*", std::move(*args))});
}

// The standard function blocks, with the interfaces that their sources declare.
void Builder::read_library() {
  base::SourceMap sources;
  base::Diagnostics diagnostics;
  frontend::Tree tree;
  uint32_t file = 0;
  for (const stdlib::LibrarySource& source : stdlib::library_sources()) {
    if (!stdlib::is_of_dialect(source, iec_)) continue;
    sources.add(std::string(source.name), std::string(source.text));
    frontend::parse(sources, file++, tree, diagnostics);
  }
  for (const frontend::PouDecl& pou : tree.pous) {
    if (pou.kind == frontend::PouKind::kFunctionBlock) library_block(tree, pou);
  }
}

// Skips a block with a parameter of a type that is not elementary.
void Builder::library_block(const frontend::Tree& tree, const frontend::PouDecl& pou) {
  Interface face;
  face.name = std::string(pou.name.text);
  for (const frontend::VarBlock& block : pou.blocks) {
    std::vector<Variable>* list = block.section == frontend::VarSection::kInput    ? &face.inputs
                                  : block.section == frontend::VarSection::kOutput ? &face.outputs
                                  : block.section == frontend::VarSection::kInOut  ? &face.in_outs
                                                                                   : nullptr;
    if (list == nullptr) continue;
    for (const frontend::VarDecl& decl : block.vars) {
      TypeRef type = library_type(tree[decl.spec]);
      if (type == kNoType) return;
      for (const frontend::Name& name : decl.names) {
        list->push_back({std::string(name.text), type, std::nullopt, {}, {}});
      }
    }
  }
  Type type;
  type.form = Form::kBlock;
  type.name = face.name;
  face.block = add_type(std::move(type));
  faces_[face.block] = face;
  library_.push_back(std::move(face));
}

TypeRef Builder::library_type(const frontend::Spec& spec) {
  if (spec.kind != frontend::SpecKind::kNamed) return kNoType;
  for (uint32_t i = 0; i < ir::kElementaryCount; ++i) {
    if (ir::same_name(ir::elementary_name(static_cast<ir::Kind>(i)), spec.name.text)) return i;
  }
  return kNoType;
}

}  // namespace differential
