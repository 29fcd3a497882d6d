// TEST blocks become programs, one each, that share nothing: SETUP and TEARDOWN of the same
// file are part of every one. The project's own configuration gives globals only.
#include <set>

#include "frontend/sema/declarations/collection.h"
#include "frontend/sema/phase.h"
#include "frontend/sema/tests/test_build.h"

namespace frontend {
namespace {

constexpr int64_t kTestPeriodNs = 1'000'000'000;
constexpr uint32_t kMessageCapacity = 400;

std::string_view without_quotes(std::string_view text) {
  bool quoted = text.size() >= 2 && text.front() == '\'' && text.back() == '\'';
  return quoted ? text.substr(1, text.size() - 2) : text;
}

// By its name people choose a test, and reports know it again.
void check_test_name(const Phase& phase, const PouDecl& test) {
  const base::SourceLocation at = phase.sema().sources.locate(test.span.begin);
  const std::string_view name = without_quotes(test.name.text);
  if (name.empty()) {
    phase.error(DiagnosticCode::kExpectedName, test.name.span, "the test has no name",
                "say what it shows: TEST 'pump starts'");
  }
  for (const TestCase& other : phase.sema().tests.cases) {
    if (other.file != at.file || other.name != name || name.empty()) continue;
    phase.error(DiagnosticCode::kDuplicateName, test.name.span,
                "a second test `" + std::string(name) + "`; the first is in line " +
                    std::to_string(other.line),
                "give it a name of its own: reports and --filter know tests by it");
  }
}

void check_idle(const Phase& phase) {
  std::set<uint32_t> files;
  auto file_of = [&](const PouDecl& decl) { return phase.sema().sources.file_of(decl.span.begin); };
  for (const PouDecl& decl : phase.sema().tree.tests) {
    if (decl.kind == PouKind::kTest) files.insert(file_of(decl));
  }
  for (const PouDecl& decl : phase.sema().tree.tests) {
    if (files.contains(file_of(decl))) continue;
    phase.warning(DiagnosticCode::kUnusedVariable, {decl.span.begin, decl.span.begin},
                  "this is never used: the file has no TEST", "put it into the file of its tests");
  }
}

}  // namespace

void TestBuild::collect_tests() {
  check_idle(*this);
  for (const PouDecl& decl : sema_.tree.tests) {
    if (decl.kind == PouKind::kTest) collect_test(decl);
  }
  for (const PouDecl& decl : sema_.tree.tests) {
    if (decl.kind == PouKind::kMockFunction) add_mock_body(decl, false);
    for (const PouDecl& member : decl.members) {
      if (member.kind == PouKind::kMockFunction) add_mock_body(member, true);
    }
  }
}

void TestBuild::collect_test(const PouDecl& test) {
  check_test_name(*this, test);
  const uint32_t file = sema_.sources.file_of(test.span.begin);
  const PouDecl* setup = nullptr;
  const PouDecl* teardown = nullptr;
  for (const PouDecl& other : sema_.tree.tests) {
    if (sema_.sources.file_of(other.span.begin) != file) continue;
    const PouDecl*& slot = other.kind == PouKind::kSetup ? setup : teardown;
    if (other.kind != PouKind::kSetup && other.kind != PouKind::kTeardown) continue;
    if (slot != nullptr && slot != &other && sema_.tests.cases.empty()) {
      error(DiagnosticCode::kDuplicateName, other.span, "a second SETUP or TEARDOWN in this file");
    }
    slot = &other;
  }
  const std::string& name = sema_.declared.made_names.emplace_back(
      "__TEST" + std::to_string(sema_.tests.cases.size() + 1));
  PouDecl& made = sema_.declared.made_decls.emplace_back(test);
  made.kind = PouKind::kProgram;
  made.name = {name, test.name.span};
  if (setup != nullptr) {
    made.blocks.insert(made.blocks.begin(), setup->blocks.begin(), setup->blocks.end());
  }
  if (teardown != nullptr) {
    made.blocks.insert(made.blocks.end(), teardown->blocks.begin(), teardown->blocks.end());
  }
  const uint32_t number = ask<Collection>().add_pou(made, false, name);
  sema_.declared.pous[number].test = true;
  // Not every test needs all that SETUP makes.
  for (VarId id : sema_.declared.pous[number].variables) {
    const uint32_t at = sema_.declared.variables[id.index].name.span.begin.offset;
    sema_.declared.variables[id.index].used =
        at < test.span.begin.offset || at >= test.span.end.offset;
  }
  sema_.declared.pous[number].setup = setup;
  sema_.declared.pous[number].teardown = teardown;
  const base::SourceLocation at = sema_.sources.locate(test.span.begin);
  sema_.tests.cases.push_back(
      {std::string(without_quotes(test.name.text)), std::string(at.file), at.line, name});
}

void TestBuild::configure_tests() {
  sema_.program.tasks.push_back({"Tests", kTestPeriodNs, 0, 0});
  for (const TestCase& test : sema_.tests.cases) {
    const PouInfo& pou = sema_.declared.pous[sema_.declared.pou_names.find(test.instance)->second];
    sema_.program.instances.push_back({test.instance, pou.self, 0, {}});
  }
}

void TestBuild::add_test_globals() {
  ir::Member message;
  message.name = kTestMessage;
  message.type = sema_.program.types.string(kMessageCapacity);
  message.section = ir::Section::kGlobal;
  std::vector<ir::Member>& members = sema_.program.types.edit(sema_.program.globals).members;
  sema_.tests.message = static_cast<uint32_t>(members.size());
  members.push_back(std::move(message));
  ir::Member teardown;
  teardown.name = kTestTeardown;
  teardown.type = sema_.program.types.elementary(ir::Kind::kBool);
  teardown.section = ir::Section::kGlobal;
  sema_.tests.teardown = static_cast<uint32_t>(members.size());
  members.push_back(std::move(teardown));
  for (const Stmt& stmt : sema_.tree.stmts) {
    if (stmt.kind != StmtKind::kMockFunction || !stmt.target.valid()) continue;
    const Expr& target = sema_.tree[stmt.target];
    const std::string_view name = sema_.namespaces.find(NameSort::kDeclaration, scope_, target);
    if (!name.empty()) add_function_mock(name, target.span);
  }
  resolve_mock_bodies();
}

}  // namespace frontend
