#include "frontend/lower/arguments.h"
#include "frontend/lower/pool_code.h"
#include "frontend/lower/start_code.h"
#include "frontend/sema/constants/constants.h"
#include "frontend/sema/objects/objects.h"
#include "ir/types/stamps.h"

namespace frontend {
namespace {

constexpr std::string_view kImplicit[] = {"bInitRetains", "bInCopyCode"};

bool is_implicit(const Name& name) {
  return ir::same_name(name.text, kImplicit[0]) || ir::same_name(name.text, kImplicit[1]);
}

// Element number `flat` of the array `at`.
ir::Place element(const ir::Place& at, const std::vector<ir::Dimension>& dims, ir::TypeId type,
                  uint64_t flat) {
  ir::Place one = at;
  for (size_t d = dims.size(); d-- > 0; flat /= dims[d].count()) {
    ir::Step index = step_to(ir::StepKind::kIndex);
    index.constant_index = dims[d].low + static_cast<int64_t>(flat % dims[d].count());
    one.steps.insert(one.steps.begin() + static_cast<ptrdiff_t>(at.steps.size()), index);
  }
  one.type = type;
  return one;
}

}  // namespace

void StartCode::run() {
  if (info_.owner == kNoPou) {
    references(sema_.started.globals);
    for (VarId id : sema_.started.globals) variable(id);
    ask<PoolCode>().visit_all();
    const ir::Place flag = variable_place(sema_.started.change_flag);
    return build_.store(flag, ir::Scalar::kU32, number(0));
  }
  const PouInfo& block = sema_.declared.pous[info_.owner];
  const uint32_t base = block.base == kNoPou ? kNoPou : sema_.declared.pous[block.base].start;
  if (base != kNoPou) {
    info_.callees.push_back(base);
    build_.call_method(sema_.declared.pous[base].id);
  }
  references(block.members);
  for (VarId id : block.members) variable(id);
}

void StartCode::references(const std::vector<VarId>& variables) {
  for (VarId id : variables) {
    const Variable& variable = resolve(id);
    if (variable.section == VarSection::kInOut || !variable.type.valid()) continue;
    if (variable.each_call) continue;
    if (!sema_.start_values.inside(variable.type, variable.init)) continue;
    span_ = variable.name.span;
    bind_references(variable_place(id), variable.type, variable.init);
  }
}

void StartCode::bind_references(const ir::Place& at, ir::TypeId id, ir::ConstId init) {
  if (!sema_.start_values.inside(id, init)) return;
  const ir::Type type = types()[id];
  if (!init.valid()) init = type.init;
  if (types().is_reference(id)) return bind_reference(at, sema_.program.constants[init].bits);
  if (type.kind == ir::Kind::kArray) {
    return each_element(at, id, init, [&](const ir::Place& one, ir::ConstId given) {
      bind_references(one, type.base, given);
    });
  }
  for (uint32_t i = 0; i < type.members.size(); ++i) {
    const ir::ConstId given = ask<Constants>().listed(init, i);
    if (!ir::is_structure(type.kind) && !given.valid()) continue;  // a matter of the block
    ir::Place member = at;
    if (!ir::is_structure(type.kind)) member.steps.push_back(step_to(ir::StepKind::kEnter));
    member.steps.push_back(step_to(ir::StepKind::kMember, i));
    member.type = type.members[i].type;
    bind_references(member, member.type, given.valid() ? given : type.members[i].init);
  }
}

// One by one, unless all are alike.
void StartCode::each_element(const ir::Place& at, ir::TypeId id, ir::ConstId init,
                             const PerValue& each) {
  const ir::Type type = types()[id];
  uint64_t total = 1;
  for (const ir::Dimension& dim : type.dims) total *= dim.count();
  std::vector<ir::ConstElement> given;
  if (init.valid()) given = sema_.program.constants[init].elements;
  const bool alike = given.empty() || (given.size() == 1 && given[0].count == total);
  if (alike) {
    const ir::ConstId value = given.empty() ? ir::ConstId() : given[0].value;
    return loop(at, type.dims, 0, type.base, [&](const ir::Place& one) { each(one, value); });
  }
  for (uint64_t i = 0; i < total; ++i) {
    each(element(at, type.dims, type.base, i), ask<Constants>().listed(init, i));
  }
}

void StartCode::bind_reference(const ir::Place& at, uint64_t unbound) {
  constexpr ir::Scalar kU64 = ir::Scalar::kU64;
  const ExprId expr = sema_.start_values.find(unbound);
  const ir::ValueId now = build_.load(at, kU64);
  when(build_.compare(ir::Op::kEq, kU64, now, build_.constant(kU64, unbound)), [&] {
    set_line(sema_.tree[expr].span);
    build_.store(at, kU64, value(expr, at.type));
  });
}

void StartCode::begin(VarId id) {
  const Variable& variable = resolve(id);
  bind_references(variable_place(id), variable.type, variable.init);
  visit(id);
}

void StartCode::variable(VarId id) {
  if (!resolve(id).each_call) visit(id);
}

void StartCode::visit(VarId id) {
  const Variable& variable = resolve(id);
  if (variable.section == VarSection::kInOut || !ask<Objects>().constructs(variable.type)) return;
  const Spec* spec =
      variable.decl == nullptr ? nullptr : ask<Objects>().construction(variable.decl->spec);
  set_line(variable.name.span);
  span_ = variable.name.span;
  content(variable_place(id), variable.type, spec);
}

void StartCode::content(const ir::Place& at, ir::TypeId type, const Spec* spec) {
  if (!ask<Objects>().constructs(type)) return;
  const ir::Kind kind = types()[type].kind;
  if (kind == ir::Kind::kArray) return elements(at, type, spec);
  if (!ir::is_structure(kind)) {
    return instance(at, type, spec == nullptr ? Range32() : spec->args);
  }
  for (uint32_t i = 0; i < types()[type].members.size(); ++i) {
    ir::Place member = at;
    member.steps.push_back(step_to(ir::StepKind::kMember, i));
    member.type = types()[type].members[i].type;
    const StructureField* field = sema_.declared.find_field(type, types()[type].members[i].name);
    const bool whole = field != nullptr && field->bit < 0;
    StartCode outside(body_, PouScope());  // it sees what the members' arguments name
    outside.span_ = span_;
    outside.content(member, member.type,
                    whole ? outside.ask<Objects>().construction(field->spec) : nullptr);
  }
}

// Pump[(1), (2)] has arguments for each element; otherwise all have the same.
void StartCode::elements(const ir::Place& at, ir::TypeId type, const Spec* spec) {
  const std::vector<ir::Dimension> dims = types()[type].dims;
  const ir::TypeId base = types()[type].base;
  const bool written = spec != nullptr && spec->kind == SpecKind::kArray;
  if (!written || spec->element_args.count == 0) {
    const Spec* inner = written ? ask<Objects>().construction(spec->element) : nullptr;
    return loop(at, dims, 0, base, [&](const ir::Place& one) { content(one, base, inner); });
  }
  uint64_t total = 1;
  for (const ir::Dimension& dim : dims) total *= dim.count();
  if (total != spec->element_args.count || !types().is_instance(base)) {
    error(DiagnosticCode::kBadConstruction, spec->span,
          std::to_string(spec->element_args.count) + " lists of arguments for " +
              std::to_string(total) + " elements",
          "give one for each, or one for all: ARRAY[..] OF Block(arguments)");
    return;
  }
  for (uint32_t i = 0; i < total; ++i) {
    const Expr& list = sema_.tree[sema_.tree.expr_lists[spec->element_args.first + i]];
    instance(element(at, dims, base, i), base, list.list);
  }
}

// One loop for each dimension, from the first.
void StartCode::loop(const ir::Place& at, const std::vector<ir::Dimension>& dims, size_t number,
                     ir::TypeId element, const PerElement& each) {
  if (number == dims.size()) {
    ir::Place one = at;
    one.type = element;
    return each(one);
  }
  constexpr ir::Scalar kI64 = ir::Scalar::kI64;
  const ir::Place counter = temporary_place(types().elementary(ir::Kind::kLint));
  const ir::BlockId head = build_.new_block();
  const ir::BlockId body = build_.new_block();
  const ir::BlockId done = build_.new_block();
  auto constant = [&](int64_t value) {
    return build_.constant(kI64, static_cast<uint64_t>(value));
  };
  build_.store(counter, kI64, constant(dims[number].low));
  build_.jump(head);
  build_.start(head);
  const ir::ValueId now = build_.load(counter, kI64);
  build_.branch(build_.compare(ir::Op::kLe, kI64, now, constant(dims[number].high)), body, done);
  build_.start(body);
  ir::Place inner = at;
  inner.steps.push_back(step_to(ir::StepKind::kIndex));
  inner.steps.back().value = now;
  loop(inner, dims, number + 1, element, each);
  build_.store(counter, kI64, build_.binary(ir::Op::kAdd, kI64, now, constant(1)));
  build_.jump(head);
  build_.start(done);
}

void StartCode::when(ir::ValueId condition, const std::function<void()>& then) {
  const ir::BlockId inside = build_.new_block();
  const ir::BlockId behind = build_.new_block();
  build_.branch(condition, inside, behind);
  build_.start(inside);
  then();
  build_.jump(behind);
  build_.start(behind);
}

const PouInfo* StartCode::code_of(const PouInfo& block, std::string_view name) const {
  const uint32_t method = ask<Objects>().find_code(block.number, name).code.method;
  return method == kNoPou ? nullptr : &sema_.declared.pous[method];
}

void StartCode::construct(const ir::Place& at, ir::TypeId type, Range32 args,
                          base::SourceSpan span) {
  span_ = span;
  instance(at, type, args);
}

void StartCode::exit(const ir::Place& at, const PouInfo& block) {
  if (const PouInfo* method = code_of(block, kFbExit)) call(at, *method, {});
}

// What leaves, leaves from the outside in; the other way round, what is inside is ready first.
void StartCode::instance(const ir::Place& at, ir::TypeId type, Range32 args, bool new_ones) {
  constexpr ir::Scalar kU32 = ir::Scalar::kU32;
  const PouInfo& block = *sema_.declared.pou_of(type);
  const PouInfo* init = code_of(block, kFbInit);
  const PouInfo* reinit = code_of(block, kFbReinit);
  ir::Place stamp = at;
  if (block.stamp.valid()) {
    stamp.steps.push_back(step_to(ir::StepKind::kEnter));
    stamp.steps.push_back(step_to(ir::StepKind::kMember, resolve(block.stamp).index));
    stamp.type = resolve(block.stamp).type;
  }
  auto is = [&](uint32_t value) {
    return build_.compare(ir::Op::kEq, kU32, build_.load(stamp, kU32), number(value));
  };
  auto set = [&](uint32_t value) { build_.store(stamp, kU32, number(value)); };
  const uint32_t made = block.stamp.valid() ? ask<Objects>().stamp_of(block) : 0;
  if (code_of(block, kFbExit) != nullptr) {
    when(is(ir::kLeavingStamp), [&] {
      exit(at, block);
      set(ir::kLeftStamp);
    });
  }
  if (block.start != kNoPou) {
    info_.callees.push_back(block.start);
    build_.call_method(sema_.declared.pous[block.start].id, at);
  }
  if (init == nullptr && args.count != 0) {
    error(DiagnosticCode::kBadConstruction, span_,
          quoted_name(block.decl->name) + " has no FB_Init that takes arguments");
  }
  if (!block.stamp.valid()) return;
  if (new_ones) {
    when(is(ir::kNewStamp), [&] {
      if (init != nullptr) call(at, *init, args);
      set(made);
    });
  }
  if (reinit == nullptr) return;
  const ir::ValueId now = build_.load(stamp, kU32);
  when(build_.compare(ir::Op::kLe, kU32, number(ir::kFirstShapeStamp), now), [&] {
    when(build_.compare(ir::Op::kNe, kU32, now, number(made)), [&] {
      call(at, *reinit, {});
      set(made);
    });
  });
}

void StartCode::call(const ir::Place& at, const PouInfo& method, Range32 args) {
  constexpr ir::Scalar kBool = ir::Scalar::kBool;
  Expr written;
  written.kind = ExprKind::kCall;
  written.list = args;
  written.span = span_;
  std::vector<Binding> bindings;
  if (!bind(written, method, bindings) ||
      !ask<Arguments>().check_in_outs(written, method, bindings))
    return;
  info_.callees.push_back(method.number);
  ask<Arguments>().evaluate_arguments(written, bindings);
  if (!sema_.started.change_flag.valid()) return;  // there are errors
  const ir::Place flag = variable_place(sema_.started.change_flag);
  const ir::ValueId changed =
      build_.compare(ir::Op::kNe, ir::Scalar::kU32, build_.load(flag, ir::Scalar::kU32), number(0));
  for (const Binding& binding : bindings) {
    ask<Arguments>().pass_input(binding,
                                ask<Arguments>().argument_place(method, resolve(binding.variable)));
  }
  ask<Arguments>().pass_defaults(method, bindings);
  for (VarId id : method.locals) {
    const Variable& variable = resolve(id);
    if (variable.section != VarSection::kInput || !is_implicit(variable.name)) continue;
    if (!traits_of(types(), variable.type).boolean) continue;
    // What is made has its initial values, retained variables too.
    const bool retains = ir::same_name(variable.name.text, kImplicit[0]);
    build_.store(ask<Arguments>().argument_place(method, variable), kBool,
                 retains ? build_.constant(kBool, 1) : changed);
  }
  build_.call_method(method.id, at);
}

// bInitRetains and bInCopyCode are given by the system; the others by the declaration.
bool StartCode::bind(const Expr& call, const PouInfo& method, std::vector<Binding>& bindings) {
  const std::string name(method.decl->name.text);
  const std::string of = name + " of " + quoted_name(sema_.declared.pous[method.owner].decl->name);
  std::vector<VarId> parameters;
  for (VarId id : method.locals) {
    const Variable& variable = resolve(id);
    const bool input =
        variable.section == VarSection::kInput || variable.section == VarSection::kInOut;
    if (input && !is_implicit(variable.name)) parameters.push_back(id);
  }
  for (uint32_t i = 0; i < call.list.count; ++i) {
    const Arg& arg = sema_.tree.args[call.list.first + i];
    if (arg.output) {
      error(DiagnosticCode::kBadConstruction, arg.span, name + " has no outputs here");
      return false;
    }
    if (!arg.name.empty()) {
      if (!ask<Arguments>().bind_named(arg, method, bindings)) return false;
    } else if (i >= parameters.size()) {
      error(DiagnosticCode::kBadConstruction, arg.span,
            of + " takes " + std::to_string(parameters.size()) + " arguments");
      return false;
    } else if (arg.value.valid()) {
      bindings.push_back({parameters[i], &arg, {}, {}, {}});
    }
  }
  for (VarId id : parameters) {
    const Variable& variable = resolve(id);
    bool given = variable.decl != nullptr && variable.decl->init.valid();
    for (const Binding& binding : bindings) given = given || binding.variable == id;
    if (given) continue;
    error(DiagnosticCode::kBadConstruction, call.span, of + " needs " + quoted_name(variable.name),
          ir::same_name(name, kFbInit)
              ? "give it in the declaration: name : Block(" + std::string(variable.name.text) +
                    " := value);"
              : "give it an initial value: nobody calls " + name + " with arguments");
    return false;
  }
  return true;
}

}  // namespace frontend
