// What names mean: the one place that knows the rules of namespaces.
#include "frontend/sema/declarations/namespaces.h"
#include "frontend/sema/declarations/variables.h"

#include <algorithm>

#include "base/limits.h"
#include "frontend/sema/quoted.h"
#include "frontend/sema/sema.h"
#include "stdlib/registry.h"

namespace frontend {
namespace {

std::string joined(std::string_view path, std::string_view name) {
  std::string text(path);
  if (!text.empty()) text += '.';
  return text += name;
}

// Is the name of the namespace with those around it not too long?
bool fits(std::string_view around, std::string_view name) {
  return around.empty() || around.size() + name.size() < base::kMaxIdentifier;
}

// "A" of "A.B"; "" of "A".
std::string_view outer_path(std::string_view path) {
  const size_t dot = path.rfind('.');
  return dot == std::string_view::npos ? std::string_view() : path.substr(0, dot);
}

bool is_inside(std::string_view path, std::string_view of) {
  if (of.empty()) return true;
  if (path.size() > of.size() && path[of.size()] == '.') path = path.substr(0, of.size());
  return ir::same_name(path, of);
}

}  // namespace

Namespaces::Namespaces(Sema& sema) : sema_(sema) {
  add_scopes();
  add_pous(sema_.tree.pous);
  add_pous(sema_.tree.tests);
  nest_regions();
}

void Namespaces::add_scopes() {
  const Tree& tree = sema_.tree;
  paths_.resize(tree.scopes.size());
  for (size_t i = 0; i < tree.scopes.size(); ++i) {
    const Scope& scope = tree.scopes[i];
    if (!scope.name.empty()) {
      const std::string_view around = paths_[scope.parent.index];
      const bool shorter = fits(around, scope.name.text);
      paths_[i] = shorter ? keep(joined(around, scope.name.text)) : around;
      known_.emplace(paths_[i], true);
      words_.emplace(scope.name.text, true);
    }
    if (scope.name.empty() && scope.usings.empty()) continue;
    regions_.push_back({scope.span, kNoRegion, paths_[i], scope.usings, {}});
  }
}

void Namespaces::add_pous(const std::vector<PouDecl>& pous) {
  for (const PouDecl& pou : pous) {
    if (!pou.usings.empty()) {
      const std::string_view path = pou.scope.valid() ? paths_[pou.scope.index] : "";
      regions_.push_back({pou.span, kNoRegion, path, pou.usings, {}});
    }
    add_pous(pou.members);
  }
}

void Namespaces::nest_regions() {
  std::stable_sort(regions_.begin(), regions_.end(), [](const Region& a, const Region& b) {
    if (a.span.begin != b.span.begin) return a.span.begin < b.span.begin;
    return b.span.end < a.span.end;
  });
  for (uint32_t i = 1; i < regions_.size(); ++i) {
    uint32_t outer = i - 1;
    while (outer != kNoRegion && !(regions_[i].span.begin < regions_[outer].span.end)) {
      outer = regions_[outer].outer;
    }
    regions_[i].outer = outer;
  }
}

uint32_t Namespaces::region_at(base::SourcePos at) const {
  if (regions_.empty() || !at.valid()) return kNoRegion;
  const auto behind = std::upper_bound(
      regions_.begin(), regions_.end(), at,
      [](base::SourcePos pos, const Region& region) { return pos < region.span.begin; });
  uint32_t found = static_cast<uint32_t>(behind - regions_.begin()) - 1;  // none: kNoRegion
  while (found != kNoRegion && !(at < regions_[found].span.end)) found = regions_[found].outer;
  return found;
}

std::string_view Namespaces::path_at(base::SourcePos at) const {
  const uint32_t region = region_at(at);
  return region == kNoRegion ? std::string_view() : regions_[region].path;
}

std::string_view Namespaces::keep(std::string text) {
  return *texts_.insert(std::move(text)).first;
}

std::string_view Namespaces::qualified(ScopeId scope, std::string_view name) {
  if (!sema_.tree.in_namespace(scope)) return name;
  return keep(joined(paths_[scope.index], name));
}

std::string_view Namespaces::declare(NameSort sort, ScopeId scope, const Name& name,
                                     Access access) {
  const std::string_view whole = qualified(scope, name.text);
  declared_[static_cast<size_t>(sort)].emplace(whole, Declared{scope, access});
  const bool clashes = sort == NameSort::kDeclaration || sort == NameSort::kVariable;
  if (clashes && known_.contains(whole)) {
    sema_.report.error({}, DiagnosticCode::kDuplicateName, name.span,
                       quoted(whole) + " is a namespace", "give one of them another name");
  }
  return whole;
}

void Namespaces::check() {
  for (const Scope& scope : sema_.tree.scopes) {
    if (scope.name.empty()) continue;
    if (fits(paths_[scope.parent.index], scope.name.text)) continue;
    sema_.report.error({}, DiagnosticCode::kTooComplex, scope.name.span,
                       "the name of this namespace, with those around it, has more than " +
                           std::to_string(base::kMaxIdentifier) + " characters");
    return;
  }
  for (Region& region : regions_) {
    const size_t around = region.outer == kNoRegion ? 0 : regions_[region.outer].used;
    region.used = around + region.written.size();
    if (region.used <= base::kMaxUsings) {
      for (Range32 written : region.written) resolve_using(region, written);
    } else if (around <= base::kMaxUsings) {
      sema_.report.error({}, DiagnosticCode::kTooComplex,
                         sema_.tree.names[region.written[0].first].span,
                         std::to_string(region.used) + " namespaces by USING",
                         "use at most " + std::to_string(base::kMaxUsings));
    }
  }
}

void Namespaces::resolve_using(Region& region, Range32 written) {
  const std::string path = path_of(written);
  for (std::string_view around = region.path;; around = outer_path(around)) {
    if (auto found = known_.find(joined(around, path)); found != known_.end()) {
      region.usings.push_back(found->first);
      return;
    }
    if (around.empty()) break;
  }
  if (stdlib::is_vendor_library(path)) return;
  NearestName nearest(path);
  nearest.offer_all(known_);
  sema_.report.error({}, DiagnosticCode::kUnknownName, sema_.tree.names[written.first].span,
                     quoted(path) + " is not a namespace", nearest.fix());
}

bool Namespaces::inside(base::SourcePos at, ScopeId scope) const {
  return !sema_.tree.in_namespace(scope) || is_inside(path_at(at), paths_[scope.index]);
}

std::string_view Namespaces::find(NameSort sort, const Name& name) {
  return find(sort, name.text, name.span);
}

std::string_view Namespaces::find(NameSort sort, Range32 qualifiers, const Name& name) {
  if (qualifiers.count == 0) return find(sort, name);
  const base::SourcePos begin = sema_.tree.names[qualifiers.first].span.begin;
  return find(sort, keep(joined(path_of(qualifiers), name.text)), {begin, name.span.end});
}

std::string_view Namespaces::find(NameSort sort, std::string_view written, base::SourceSpan span) {
  const Table& table = declared_[static_cast<size_t>(sort)];
  const bool plain = written.find('.') == std::string_view::npos;
  if (plain && regions_.empty()) return written;
  const std::string_view from = path_at(span.begin);
  Table::const_iterator found = find_around(table, written, from);
  if (found == table.end() && plain) found = find_used(sort, {written, span});
  if (found == table.end()) return plain ? written : find_in_library(sort, written);
  if (auto path = closed_to(found->second, from)) report_internal(found->first, *path, span);
  return found->first;
}

// From the inside out.
Namespaces::Table::const_iterator Namespaces::find_around(const Table& table,
                                                          std::string_view written,
                                                          std::string_view path) const {
  for (; !path.empty(); path = outer_path(path)) {
    if (auto found = table.find(joined(path, written)); found != table.end()) return found;
  }
  return table.find(written);
}

// What all USINGs around the place make visible; INTERNAL names of others are none of it.
Namespaces::Table::const_iterator Namespaces::find_used(NameSort sort, const Name& name) {
  const Table& table = declared_[static_cast<size_t>(sort)];
  const std::string_view from = path_at(name.span.begin);
  Table::const_iterator first = table.end();
  for (uint32_t at = region_at(name.span.begin); at != kNoRegion; at = regions_[at].outer) {
    for (std::string_view used : regions_[at].usings) {
      const auto found = table.find(joined(used, name.text));
      if (found == table.end() || found == first || closed_to(found->second, from)) continue;
      if (first == table.end()) {
        first = found;
      } else if (sort == NameSort::kLiteral) {
        several_.insert(name.span.begin.offset);
      } else if (first_report(name.span)) {
        sema_.report.error({}, DiagnosticCode::kAmbiguousName, name.span,
                           quoted(name.text) + " may be " + quoted(first->first) + " or " +
                               quoted(found->first) + ", by USING",
                           "write the whole name");
      }
    }
  }
  return first;
}

// Standard.TON
std::string_view Namespaces::find_in_library(NameSort sort, std::string_view written) {
  const size_t dot = written.rfind('.');
  if (sort != NameSort::kDeclaration || !stdlib::is_vendor_library(written.substr(0, dot))) {
    return written;
  }
  const std::string_view name = written.substr(dot + 1);
  const Table& table = declared_[static_cast<size_t>(NameSort::kDeclaration)];
  return table.contains(name) ? library_alias(name) : name;
}

// Where the project has its own, the library's is `Standard.name`.
std::string_view Namespaces::library_alias(std::string_view name) {
  const std::string_view alias = keep("Standard." + std::string(name));
  auto& blocks = sema_.library.pous;
  if (auto pou = blocks.find(name); pou != blocks.end()) blocks.emplace(alias, pou->second);
  auto& functions = sema_.library.functions;
  if (auto row = functions.find(name); row != functions.end()) {
    functions.emplace(alias, row->second);
  }
  return alias;
}

std::optional<std::string_view> Namespaces::closed_to(const Declared& declared,
                                                      std::string_view from) const {
  const Tree& tree = sema_.tree;
  if (!tree.in_namespace(declared.scope)) return std::nullopt;
  const std::string_view own = paths_[declared.scope.index];
  if (declared.access == Access::kInternal && !is_inside(from, own)) return own;
  for (ScopeId at = declared.scope; tree.in_namespace(at); at = tree[at].parent) {
    const std::string_view around = paths_[tree[at].parent.index];
    if (tree[at].internal && !is_inside(from, around)) return around;
  }
  return std::nullopt;
}

void Namespaces::report_internal(std::string_view name, std::string_view path,
                                 base::SourceSpan span) {
  if (!first_report(span)) return;
  sema_.report.error({}, DiagnosticCode::kNotAccessible, span,
                     quoted(name) + " is INTERNAL in the namespace " + quoted(path),
                     "only code of that namespace uses it");
}

bool Namespaces::first_report(base::SourceSpan span) {
  return reported_.insert(span.begin.offset).second;
}

// A of A.B.x; null where code is more than names with dots.
const Expr* Namespaces::head_of(const Expr& expr) const {
  const Expr* head = &expr;
  while (head->kind == ExprKind::kMember) head = &sema_.tree[head->operand];
  return head->kind == ExprKind::kName && !head->global ? head : nullptr;
}

std::string Namespaces::path_of(Range32 names) const {
  std::string path(sema_.tree.names[names.first].text);
  for (uint32_t i = 1; i < names.count; ++i) {
    path += '.';
    path += sema_.tree.names[names.first + i].text;
  }
  return path;
}

std::string Namespaces::path_of(const Expr& expr) const {
  std::string path(expr.name.text);
  for (const Expr* at = &expr; at->kind == ExprKind::kMember;) {
    at = &sema_.tree[at->operand];
    path = joined(at->name.text, path);
  }
  return path;
}

bool Namespaces::is_namespace(const PouScope& scope, const Expr& expr) {
  return is_path(expr) && !Variables(sema_, scope).find_variable(*head_of(expr)).valid();
}

bool Namespaces::is_path(const Expr& expr) const {
  const Expr* head = head_of(expr);
  if (head == nullptr) return false;
  const bool vendor = head == &expr && stdlib::is_vendor_library(head->name.text);
  if (!vendor && !words_.contains(head->name.text)) return false;
  const std::string path = path_of(expr);
  bool known = vendor || known_.contains(path);
  std::string_view around = path_at(head->span.begin);
  for (; !known && !around.empty(); around = outer_path(around)) {
    known = known_.contains(joined(around, path));
  }
  return known;
}

VarId Namespaces::find_global(const Name& name) {
  auto found = sema_.declared.globals.find(find(NameSort::kVariable, name));
  return found == sema_.declared.globals.end() ? VarId() : found->second;
}

VarId Namespaces::find_global(const PouScope& scope, const Expr& member) {
  const Expr& operand = sema_.tree[member.operand];
  if (const GlobalList* variables = list(scope, operand)) {
    auto found = variables->names.find(member.name.text);
    if (found != variables->names.end()) return found->second;
  }
  if (!is_namespace(scope, operand)) return {};
  auto found = sema_.declared.globals.find(find(NameSort::kVariable, scope, member));
  return found == sema_.declared.globals.end() ? VarId() : found->second;
}

const GlobalList* Namespaces::list(const PouScope& scope, const Expr& head) {
  const bool plain = head.kind == ExprKind::kName;
  if (plain && (head.global || Variables(sema_, scope).find_variable(head.name).valid()))
    return nullptr;
  auto found = sema_.declared.lists.find(find(NameSort::kList, scope, head));
  return found == sema_.declared.lists.end() ? nullptr : &found->second;
}

bool Namespaces::declares(const PouScope& scope, const Expr& expr) {
  return expr.kind == ExprKind::kMember && is_namespace(scope, sema_.tree[expr.operand]) &&
         !find_global(scope, expr).valid();
}

std::string_view Namespaces::find(NameSort sort, const PouScope& scope, const Expr& expr) {
  if (expr.kind == ExprKind::kName) return find(sort, expr.name);
  if (expr.kind != ExprKind::kMember || !is_namespace(scope, sema_.tree[expr.operand])) return {};
  return find(sort, keep(path_of(expr)), {head_of(expr)->span.begin, expr.name.span.end});
}

}  // namespace frontend
