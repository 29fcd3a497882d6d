// Mocks: what tests put in the place of functions and of function block bodies.
#include "frontend/lower/arguments.h"
#include "frontend/lower/assignments.h"
#include "frontend/lower/mock_code.h"
#include "frontend/sema/declarations/variables.h"
#include "frontend/sema/tests/test_build.h"

namespace frontend {
namespace {

constexpr uint64_t kMockedByValue = 1;

ir::Step member(uint32_t index) {
  ir::Step step;
  step.kind = ir::StepKind::kMember;
  step.index = index;
  return step;
}

}  // namespace

// The counter or switch of what a test names: an instance, or a function.
std::optional<ir::Place> MockCode::mock_slot(ExprId target, uint32_t MockSlots::*slot) {
  const Expr& expr = tree_[target];
  const bool plain = expr.kind == ExprKind::kName;
  if (!plain || !ask<Variables>().find_variable(expr.name).valid()) {
    const PouInfo* function =
        sema_.declared.find_pou(sema_.namespaces.find(NameSort::kDeclaration, scope_, expr));
    if (function != nullptr && function->decl->kind == PouKind::kFunction) {
      if (function->mock.present) return global_place(function->mock.*slot);
      const std::string name(expr.name.text);
      const bool mocks = slot == &MockSlots::active;
      error(DiagnosticCode::kBadMock, expr.span,
            mocks ? "`" + name + "` is a function" : "no test mocks the function `" + name + "`",
            mocks ? "write MOCK_FUNCTION " + name + " RETURNS value;"
                  : "calls are counted where MOCK_FUNCTION names the function");
      return std::nullopt;
    }
    if (function != nullptr) {
      error(DiagnosticCode::kBadMock, expr.span,
            "`" + std::string(expr.name.text) + "` is a type, not an instance",
            "declare an instance in VAR and name that, or name the one inside of another: "
            "MOCK uut.sensor;");
      return std::nullopt;
    }
  }
  const ir::TypeId type = infer(target).type;
  const PouInfo* block = sema_.declared.pou_of(type);
  if (block == nullptr || !block->mock.present) {
    if (type.valid()) {
      error(DiagnosticCode::kBadMock, expr.span,
            "`" + sema_.report.type_text(type) + "` is no function block",
            "MOCK takes an instance, MOCK_FUNCTION a function; a variable is just set");
    }
    return std::nullopt;
  }
  ir::Place out = place(target);
  out.steps.push_back({});
  out.steps.back().kind = ir::StepKind::kEnter;
  out.steps.push_back(member(block->mock.*slot));
  out.type = types()[block->self].members[block->mock.*slot].type;
  return out;
}

void MockCode::mock_statement(const Stmt& stmt) {
  if (!sema_.for_tests()) {
    error(DiagnosticCode::kTestOnly, stmt.span, "mocks are for tests only",
          "put it into a TEST block and run that with stc test");
    return;
  }
  const auto active = mock_slot(stmt.target, &MockSlots::active);
  if (!active) return;
  if (stmt.kind == StmtKind::kMockFunction) {
    const PouInfo* function = sema_.declared.find_pou(
        sema_.namespaces.find(NameSort::kDeclaration, scope_, tree_[stmt.target]));
    if (function == nullptr) return;
    if (stmt.value.valid() && !function->result.valid()) {
      error(DiagnosticCode::kBadMock, tree_[stmt.value].span,
            "`" + std::string(function->decl->name.text) + "` has no result", "leave RETURNS out");
      return;
    }
    if (stmt.value.valid()) {
      Target target;
      target.place = global_place(function->mock.value);
      target.type = target.place.type;
      if (types().is_scalar(target.type)) {
        store(target, value(stmt.value, target.type));
      } else {
        ask<Assignments>().assign_aggregate(target, stmt.value);
      }
    }
  }
  build_.store(*active, ir::Scalar::kI32, build_.constant(ir::Scalar::kI32, kMockedByValue));
}

// MOCK_FUNCTION declarations of a test's file and of the test itself are active from its start.
void MockCode::activate_mock_bodies() {
  for (const PouInfo* function : ask<TestBuild>().mocked_functions()) {
    for (size_t i = 0; i < function->mock.bodies.size(); ++i) {
      if (!ask<TestBuild>().mock_applies(function->mock.bodies[i], *info_.decl)) continue;
      build_.store(global_place(function->mock.active), ir::Scalar::kI32,
                   build_.constant(ir::Scalar::kI32, kMockedByValue + 1 + i));
    }
  }
}

// In front of the body of everything that a test may replace.
void MockCode::mock_prologue() {
  if (!info_.mock.present) return;
  const bool function = info_.decl->kind == PouKind::kFunction;
  auto slot = [&](uint32_t index) {
    if (function) return global_place(index);
    ir::Place place;
    place.base = ir::PlaceBase::kSelf;
    place.base_type = info_.self;
    place.steps.push_back(member(index));
    place.type = types()[info_.self].members[index].type;
    return place;
  };
  const ir::Place calls = slot(info_.mock.calls);
  build_.store(calls, ir::Scalar::kU32,
               build_.binary(ir::Op::kAdd, ir::Scalar::kU32, build_.load(calls, ir::Scalar::kU32),
                             build_.constant(ir::Scalar::kU32, 1)));
  const ir::BlockId real = build_.new_block();
  const ir::Place active = slot(info_.mock.active);
  auto when = [&](uint64_t number, ir::BlockId otherwise) {
    const ir::BlockId mocked = build_.new_block();
    const ir::ValueId is = build_.load(active, ir::Scalar::kI32);
    build_.branch(build_.compare(ir::Op::kEq, ir::Scalar::kI32, is,
                                 build_.constant(ir::Scalar::kI32, number)),
                  mocked, otherwise);
    build_.start(mocked);
  };
  for (size_t i = 0; i < info_.mock.bodies.size(); ++i) {
    const ir::BlockId next = build_.new_block();
    when(kMockedByValue + 1 + i, next);
    forward_to_mock(sema_.declared.pous[info_.mock.bodies[i]]);
    build_.ret();
    build_.start(next);
  }
  when(kMockedByValue, real);
  if (function && info_.result.valid()) {
    const ir::Place result = variable_place(info_.result);
    const ir::Place given = global_place(info_.mock.value);
    if (types().is_scalar(result.type)) {
      build_.store(result, scalar(result.type), build_.load(given, scalar(given.type)));
    } else {
      build_.copy(result, given);
    }
  }
  build_.ret();
  build_.start(real);
}

// Calls the body of a MOCK_FUNCTION with the parameters of this function; same local numbers.
void MockCode::forward_to_mock(const PouInfo& mock) {
  info_.callees.push_back(mock.number);
  std::vector<VarId> results;
  for (uint32_t i = 0; i < info_.locals.size(); ++i) {
    const Variable& own = resolve(info_.locals[i]);
    const bool given = own.section == VarSection::kInput || own.section == VarSection::kInOut;
    if (info_.locals[i] == info_.result || own.section == VarSection::kOutput) {
      results.push_back(info_.locals[i]);
    }
    if (!given || i >= mock.locals.size()) continue;
    const ir::Place to = ask<Arguments>().argument_place(mock, resolve(mock.locals[i]));
    const ir::Place from = variable_place(info_.locals[i]);
    if (own.section == VarSection::kInOut && !own.by_reference) {
      build_.store(to, ir::Scalar::kAddr, build_.address(from));
    } else if (types().is_scalar(own.type)) {
      build_.store(to, scalar(own.type), build_.load(from, scalar(own.type)));
    } else {
      build_.copy(to, from);
    }
  }
  build_.call_function(mock.id);
  for (VarId id : results) {
    const Variable& own = resolve(id);
    if (own.index >= mock.locals.size()) continue;
    const ir::Place from = ask<Arguments>().argument_place(mock, resolve(mock.locals[own.index]));
    if (types().is_scalar(own.type)) {
      build_.store(variable_place(id), scalar(own.type), build_.load(from, scalar(own.type)));
    } else {
      build_.copy(variable_place(id), from);
    }
  }
}

}  // namespace frontend
