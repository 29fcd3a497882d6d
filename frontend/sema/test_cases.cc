// TEST blocks become programs, one each, that share nothing: SETUP and TEARDOWN of the same
// file are part of every one. The project's own configuration gives globals only.
#include <set>

#include "frontend/sema/sema.h"

namespace frontend {
namespace {

constexpr int64_t kTestPeriodNs = 1'000'000'000;
constexpr uint32_t kMessageCapacity = 400;

std::string_view without_quotes(std::string_view text) {
  bool quoted = text.size() >= 2 && text.front() == '\'' && text.back() == '\'';
  return quoted ? text.substr(1, text.size() - 2) : text;
}

// By its name people choose a test, and reports know it again.
void check_test_name(Sema& sema, const PouDecl& test) {
  const base::SourceLocation at = sema.sources.locate(test.span.begin);
  const std::string_view name = without_quotes(test.name.text);
  if (name.empty()) {
    sema.error(DiagnosticCode::kExpectedName, test.name.span, "the test has no name",
               "say what it shows: TEST 'pump starts'");
  }
  for (const TestCase& other : sema.tests.cases) {
    if (other.file != at.file || other.name != name || name.empty()) continue;
    sema.error(DiagnosticCode::kDuplicateName, test.name.span,
               "a second test `" + std::string(name) + "`; the first is in line " +
                   std::to_string(other.line),
               "give it a name of its own: reports and --filter know tests by it");
  }
}

void check_idle(Sema& sema) {
  std::set<uint32_t> files;
  auto file_of = [&](const PouDecl& decl) { return sema.sources.file_of(decl.span.begin); };
  for (const PouDecl& decl : sema.tree.tests) {
    if (decl.kind == PouKind::kTest) files.insert(file_of(decl));
  }
  for (const PouDecl& decl : sema.tree.tests) {
    if (files.contains(file_of(decl))) continue;
    sema.warning(DiagnosticCode::kUnusedVariable, {decl.span.begin, decl.span.begin},
                 "this is never used: the file has no TEST", "put it into the file of its tests");
  }
}

}  // namespace

void Sema::collect_tests() {
  check_idle(*this);
  for (const PouDecl& decl : tree.tests) {
    if (decl.kind == PouKind::kTest) collect_test(decl);
  }
  for (const PouDecl& decl : tree.tests) {
    if (decl.kind == PouKind::kMockFunction) add_mock_body(decl, false);
    for (const PouDecl& member : decl.members) {
      if (member.kind == PouKind::kMockFunction) add_mock_body(member, true);
    }
  }
}

void Sema::collect_test(const PouDecl& test) {
  check_test_name(*this, test);
  const uint32_t file = sources.file_of(test.span.begin);
  const PouDecl* setup = nullptr;
  const PouDecl* teardown = nullptr;
  for (const PouDecl& other : tree.tests) {
    if (sources.file_of(other.span.begin) != file) continue;
    const PouDecl*& slot = other.kind == PouKind::kSetup ? setup : teardown;
    if (other.kind != PouKind::kSetup && other.kind != PouKind::kTeardown) continue;
    if (slot != nullptr && slot != &other && tests.cases.empty()) {
      error(DiagnosticCode::kDuplicateName, other.span, "a second SETUP or TEARDOWN in this file");
    }
    slot = &other;
  }
  const std::string& name =
      declared.made_names.emplace_back("__TEST" + std::to_string(tests.cases.size() + 1));
  PouDecl& made = declared.made_decls.emplace_back(test);
  made.kind = PouKind::kProgram;
  made.name = {name, test.name.span};
  if (setup != nullptr) {
    made.blocks.insert(made.blocks.begin(), setup->blocks.begin(), setup->blocks.end());
  }
  if (teardown != nullptr) {
    made.blocks.insert(made.blocks.end(), teardown->blocks.begin(), teardown->blocks.end());
  }
  const uint32_t number = add_pou(made, false, name);
  declared.pous[number].test = true;
  // Not every test needs all that SETUP makes.
  for (VarId id : declared.pous[number].variables) {
    const uint32_t at = declared.variables[id.index].name.span.begin.offset;
    declared.variables[id.index].used = at < test.span.begin.offset || at >= test.span.end.offset;
  }
  declared.pous[number].setup = setup;
  declared.pous[number].teardown = teardown;
  const base::SourceLocation at = sources.locate(test.span.begin);
  tests.cases.push_back(
      {std::string(without_quotes(test.name.text)), std::string(at.file), at.line, name});
}

void Sema::configure_tests() {
  program.tasks.push_back({"Tests", kTestPeriodNs, 0, 0});
  for (const TestCase& test : tests.cases) {
    const PouInfo& pou = declared.pous[declared.pou_names.find(test.instance)->second];
    program.instances.push_back({test.instance, pou.self, 0, {}});
  }
}

void Sema::add_test_globals() {
  ir::Member message;
  message.name = kTestMessage;
  message.type = program.types.string(kMessageCapacity);
  message.section = ir::Section::kGlobal;
  std::vector<ir::Member>& members = program.types.edit(program.globals).members;
  tests.message = static_cast<uint32_t>(members.size());
  members.push_back(std::move(message));
  for (const Stmt& stmt : tree.stmts) {
    if (stmt.kind != StmtKind::kMockFunction || !stmt.target.valid()) continue;
    const Expr& target = tree[stmt.target];
    const std::string_view name = namespaces.find(NameSort::kDeclaration, target);
    if (!name.empty()) add_function_mock(name, target.span);
  }
  resolve_mock_bodies();
}

}  // namespace frontend
