// What a build for tests adds to POUs that tests replace: whether a mock is active, how often
// the POU was called, and for functions the value to return.
#include "frontend/sema/declarations/collection.h"
#include "frontend/sema/quoted.h"
#include "frontend/sema/sema.h"
#include "frontend/sema/tests/test_build.h"

namespace frontend {
namespace {

uint32_t add_mock_global(ir::Type& globals, const std::string& name, ir::TypeId type) {
  ir::Member member;
  member.name = name;
  member.type = type;
  member.section = ir::Section::kGlobal;
  globals.members.push_back(std::move(member));
  return static_cast<uint32_t>(globals.members.size() - 1);
}

}  // namespace

void TestBuild::add_function_mock(std::string_view name, base::SourceSpan span) {
  auto found = sema_.declared.pou_names.find(name);
  if (found == sema_.declared.pou_names.end() ||
      sema_.declared.pous[found->second].decl->kind != PouKind::kFunction) {
    error(DiagnosticCode::kBadMock, span,
          "`" + std::string(name) + "` is not a function of the project",
          "MOCK_FUNCTION replaces functions; MOCK replaces an instance of a function block");
    return;
  }
  PouInfo& info = sema_.declared.pous[found->second];
  if (info.mock.present) return;
  const std::string prefix = "__MOCK_" + std::string(info.name);
  const ir::TypeId result = info.result.valid() ? resolve(info.result).type : ir::TypeId();
  const ir::TypeId dint = sema_.program.types.elementary(ir::Kind::kDint);
  const ir::TypeId udint = sema_.program.types.elementary(ir::Kind::kUdint);
  ir::Type& globals = sema_.program.types.edit(sema_.program.globals);
  info.mock.active = add_mock_global(globals, prefix + "_ACTIVE", dint);
  info.mock.calls = add_mock_global(globals, prefix + "_CALLS", udint);
  if (result.valid()) info.mock.value = add_mock_global(globals, prefix + "_VALUE", result);
  info.mock.present = true;
}

// A MOCK_FUNCTION with a body is a function of its own, under a name that no source can use.
void TestBuild::add_mock_body(const PouDecl& decl, bool inside_test) {
  if (decl.name.empty()) return;
  const std::string& name = sema_.declared.made_names.emplace_back(
      std::string(decl.name.text) + "#" + std::to_string(sema_.declared.made_names.size()));
  PouDecl& made = sema_.declared.made_decls.emplace_back(decl);
  made.kind = PouKind::kFunction;
  sema_.tests.mock_bodies.push_back(
      {&decl, inside_test, ask<Collection>().add_pou(made, false, name)});
  sema_.declared.pous[sema_.tests.mock_bodies.back().pou].test = true;
}

void TestBuild::resolve_mock_bodies() {
  for (const MockBody& body : sema_.tests.mock_bodies) {
    const PouDecl& decl = *body.decl;
    const std::string_view name =
        sema_.namespaces.find(NameSort::kDeclaration, decl.qualifiers, decl.name);
    auto found = sema_.declared.pou_names.find(name);
    add_function_mock(name, decl.name.span);
    if (found == sema_.declared.pou_names.end() || !sema_.declared.pous[found->second].mock.present)
      continue;
    PouInfo& function = sema_.declared.pous[found->second];
    check_mock_body(decl, sema_.declared.pous[body.pou], function);
    function.mock.bodies.push_back(body.pou);
  }
}

bool TestBuild::mock_applies(uint32_t pou, const PouDecl& test) const {
  for (const MockBody& body : sema_.tests.mock_bodies) {
    if (body.pou != pou) continue;
    const base::SourcePos at = body.decl->span.begin;
    if (!body.inside_test)
      return sema_.sources.file_of(at) == sema_.sources.file_of(test.span.begin);
    return at.offset >= test.span.begin.offset && at.offset < test.span.end.offset;
  }
  return false;
}

std::vector<const PouInfo*> TestBuild::mocked_functions() const {
  std::vector<const PouInfo*> out;
  for (const PouInfo& pou : sema_.declared.pous) {
    if (pou.mock.present && !pou.mock.bodies.empty()) out.push_back(&pou);
  }
  return out;
}

void TestBuild::check_mock_body(const PouDecl& decl, const PouInfo& mock, const PouInfo& function) {
  auto parameters = [this](const PouInfo& info) {
    std::vector<std::pair<ir::TypeId, VarSection>> out;
    for (VarId id : info.locals) {
      const Variable& variable = resolve(id);
      bool parameter = id == info.result || variable.section == VarSection::kInput ||
                       variable.section == VarSection::kOutput ||
                       variable.section == VarSection::kInOut;
      if (parameter) out.push_back({variable.type, variable.section});
    }
    return out;
  };
  if (parameters(mock) == parameters(function)) return;
  error(DiagnosticCode::kBadMock, decl.name.span,
        "the parameters or the result differ from those of the function " + quoted(decl.name),
        "declare the same VAR_INPUT, VAR_OUTPUT, VAR_IN_OUT and result as the function");
}

void TestBuild::add_mock_members(PouInfo& info, std::vector<ir::Member>& members) {
  ir::Member active;
  // A base has its own.
  const std::string suffix = info.base == kNoPou ? "" : "_" + sema_.program.types[info.self].name;
  active.name = "__MOCK_ACTIVE" + suffix;
  active.type = sema_.program.types.elementary(ir::Kind::kDint);
  info.mock.active = static_cast<uint32_t>(members.size());
  members.push_back(std::move(active));
  ir::Member calls;
  calls.name = "__MOCK_CALLS" + suffix;
  calls.type = sema_.program.types.elementary(ir::Kind::kUdint);
  info.mock.calls = static_cast<uint32_t>(members.size());
  members.push_back(std::move(calls));
  info.mock.present = true;
}

}  // namespace frontend
