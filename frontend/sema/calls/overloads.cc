// Functions that share a name: the one is called whose parameters fit the arguments best.
#include "frontend/parse/declared_twice.h"
#include "frontend/sema/calls/calls.h"
#include "frontend/sema/calls/open_functions.h"
#include "frontend/sema/sema.h"

namespace frontend {
namespace {

// How far an argument is from a parameter: the same type, a literal that takes it, a
// conversion without loss (the narrower the better, and integers stay integers), one
// that can lose.
constexpr uint32_t kLiteral = 1;
constexpr uint32_t kLossless = 4;
constexpr uint32_t kOtherClass = 16;
constexpr uint32_t kNarrowing = 64;

bool literal_fits(const Traits& to, Flex flex) {
  switch (flex) {
    case Flex::kInteger:
      return to.number() || to.bits;
    case Flex::kReal:
      return to.real;
    case Flex::kText:
      return to.character;
    default:
      return to.enumeration;
  }
}

// An integer stays one rather than that it becomes a bit string or a real number.
uint32_t literal_distance(const Traits& to, Flex flex) {
  if (flex != Flex::kInteger) return kLiteral;
  return kLiteral + (to.real ? 2 : to.bits ? 1 : 0);
}

}  // namespace

// nullopt: the function cannot be called like this.
std::optional<uint32_t> OpenFunctions::distance(const Expr& call, uint32_t pou) {
  const PouInfo& info = sema_.declared.pous[pou];
  std::vector<Match> matches = match(call, info);
  if (matches.size() != ask<Calls>().plain_arguments(call, &info).size()) return std::nullopt;
  uint32_t sum = info.open ? kLossless : 0;
  uint32_t inputs = 0;
  uint32_t given = 0;
  for (VarId id : info.variables) {
    VarSection section = sema_.declared.variables[id.index].section;
    if (section == VarSection::kInput || section == VarSection::kInOut) ++inputs;
  }
  for (const Match& match : matches) {
    const Variable& parameter = sema_.declared.variables[match.parameter.index];
    if (!is_parameter(parameter.section)) return std::nullopt;
    if (parameter.section != VarSection::kOutput) ++given;
    if (info.open) continue;
    ir::TypeId wanted = resolve(match.parameter).type;
    const Note& note = infer(match.arg->value);
    if (!wanted.valid() || !note.type.valid() || note.type == wanted) continue;
    if (note.flex != Flex::kNone &&
        literal_fits(traits_of(sema_.program.types, wanted), note.flex)) {
      sum += literal_distance(traits_of(sema_.program.types, wanted), note.flex);
      continue;
    }
    Fit fit = parameter.section == VarSection::kOutput
                  ? implicit_fit(sema_.program.types, wanted, note.type, sema_.options.dialect)
                  : implicit_fit(sema_.program.types, note.type, wanted, sema_.options.dialect);
    if (fit == Fit::kNone) return std::nullopt;
    if (fit == Fit::kNarrowing) sum += kNarrowing;
    if (fit != Fit::kLossless || !sema_.program.types.is_scalar(wanted)) continue;
    bool other = traits_of(sema_.program.types, wanted).real !=
                 traits_of(sema_.program.types, note.type).real;
    uint32_t width = ir::scalar_size(sema_.program.types.scalar(wanted));
    sum += kLossless + width + (other ? kOtherClass : 0);
  }
  return sum + (inputs - given);  // left out inputs count little: the shorter function is meant
}

uint32_t OpenFunctions::select_overload(const Expr& call, uint32_t first) {
  uint32_t best = kNoPou;
  uint32_t best_distance = 0;
  bool ambiguous = false;
  for (uint32_t pou = first; pou != kNoPou; pou = sema_.declared.pous[pou].overload) {
    std::optional<uint32_t> found = distance(call, pou);
    if (!found) continue;
    if (best != kNoPou && *found > best_distance) continue;
    ambiguous = best != kNoPou && *found == best_distance;
    best = pou;
    best_distance = *found;
  }
  std::string name = "`" + std::string(sema_.declared.pous[first].name) + "`";
  if (best == kNoPou) {
    std::string all;
    for (uint32_t pou = first; pou != kNoPou; pou = sema_.declared.pous[pou].overload) {
      all += (all.empty() ? "" : ", ") + signature(sema_.declared.pous[pou]);
    }
    error(DiagnosticCode::kNoOverload, call.span, "no " + name + " takes these arguments",
          "there are " + all);
  } else if (ambiguous) {
    error(DiagnosticCode::kAmbiguousCall, call.span, "several " + name + " fit equally well",
          "convert an argument explicitly");
    return kNoPou;
  }
  return best;
}

// "Area(REAL,REAL)"
std::string OpenFunctions::signature(const PouInfo& pou) {
  std::string text;
  for (VarId id : pou.variables) {
    const Variable& variable = sema_.declared.variables[id.index];
    if (id == pou.result || !is_parameter(variable.section)) continue;
    const Spec& spec = sema_.tree[variable.decl->spec];
    std::string type = pou.open && spec.kind == SpecKind::kNamed ? std::string(spec.name.text)
                       : pou.open                                ? "?"
                                  : sema_.report.type_text(resolve(id).type);
    text += (text.empty() ? "" : ",") + type;
  }
  return std::string(pou.name) + "(" + text + ")";
}

// Names in the program are unique: further functions are called after their parameters.
void OpenFunctions::check_overloads() {
  for (uint32_t first = 0; first < sema_.declared.pous.size(); ++first) {
    if (sema_.declared.pous[first].overload == kNoPou) continue;
    const auto head = sema_.declared.pou_names.find(sema_.declared.pous[first].name);
    if (head != sema_.declared.pou_names.end() && head->second == first) check_overloads_of(first);
  }
}

// What is declared twice is no choice for calls, which would be ambiguous.
void OpenFunctions::check_overloads_of(uint32_t first) {
  NameMap<uint32_t> seen;
  const auto kept = [&](const PouInfo& pou) { return sema_.declared.keep_name(signature(pou)); };
  seen.emplace(kept(sema_.declared.pous[first]), first);
  for (uint32_t* link = &sema_.declared.pous[first].overload; *link != kNoPou;) {
    PouInfo& pou = sema_.declared.pous[*link];
    const std::string_view text = kept(pou);
    const auto [same, is_new] = seen.emplace(text, *link);
    if (is_new) {
      if (!pou.open) sema_.program.pous[pou.id.index].name = text;
      link = &pou.overload;
      continue;
    }
    const base::SourceSpan here = pou.decl->name.span;
    const base::SourceSpan other = sema_.declared.pous[same->second].decl->name.span;
    error(DiagnosticCode::kDuplicateName, here, declared_twice(sema_.sources, text, here, other),
          "functions of one name differ in their parameters");
    *link = pou.overload;
  }
}

}  // namespace frontend
