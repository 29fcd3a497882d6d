// The code of __START (sema/start.cc): FB_Init of every instance, inner ones first, with the
// arguments that its declaration gives.
#include "frontend/lower/call.h"

namespace frontend {
namespace {

constexpr std::string_view kImplicit[] = {"bInitRetains", "bInCopyCode"};

bool is_implicit(const Name& name) {
  return ir::same_name(name.text, kImplicit[0]) || ir::same_name(name.text, kImplicit[1]);
}

ir::Step step(ir::StepKind kind, uint32_t index = 0) {
  ir::Step out;
  out.kind = kind;
  out.index = index;
  return out;
}

}  // namespace

void Body::start_code() {
  if (info_.owner == kNoPou) {
    for (VarId id : sema_.objects.start_globals()) start_variable(id);
    return;
  }
  const PouInfo& block = sema_.pous[info_.owner];
  const uint32_t base = block.base == kNoPou ? kNoPou : sema_.pous[block.base].start;
  if (base != kNoPou) {
    info_.callees.push_back(base);
    build_.call_method(sema_.pous[base].id);
  }
  for (VarId id : block.members) start_variable(id);
}

void Body::start_variable(VarId id) {
  const Variable& variable = sema_.resolve(id);
  if (variable.section == VarSection::kInOut || !sema_.objects.starts(variable.type)) return;
  const Spec* spec = variable.decl == nullptr ? nullptr : &tree_[variable.decl->spec];
  set_line(variable.name.span);
  start_span_ = variable.name.span;
  start_value(variable_place(id), variable.type, spec);
}

void Body::start_value(const ir::Place& at, ir::TypeId type, const Spec* spec) {
  if (!sema_.objects.starts(type)) return;
  const ir::Kind kind = types()[type].kind;
  if (kind == ir::Kind::kArray) return start_elements(at, type, spec);
  if (!ir::is_structure(kind)) {
    return start_instance(at, type, spec == nullptr ? Range32() : spec->args);
  }
  for (uint32_t i = 0; i < types()[type].members.size(); ++i) {
    ir::Place member = at;
    member.steps.push_back(step(ir::StepKind::kMember, i));
    member.type = types()[type].members[i].type;
    start_value(member, member.type, nullptr);
  }
}

// Pump[(1), (2)] has arguments for each element; otherwise all have the same.
void Body::start_elements(const ir::Place& at, ir::TypeId type, const Spec* spec) {
  const std::vector<ir::Dimension> dims = types()[type].dims;
  const ir::TypeId element = types()[type].base;
  const bool written = spec != nullptr && spec->kind == SpecKind::kArray;
  if (!written || spec->element_args.count == 0) {
    return start_loop(at, dims, 0, element, written ? &tree_[spec->element] : nullptr);
  }
  uint64_t total = 1;
  for (const ir::Dimension& dim : dims) total *= dim.count();
  if (total != spec->element_args.count || !types().is_instance(element)) {
    sema_.error(DiagnosticCode::kBadConstruction, spec->span,
                std::to_string(spec->element_args.count) + " lists of arguments for " +
                    std::to_string(total) + " elements",
                "give one for each, or one for all: ARRAY[..] OF Block(arguments)");
    return;
  }
  for (uint32_t i = 0; i < total; ++i) {
    ir::Place one = at;
    uint64_t rest = i;
    for (size_t d = dims.size(); d-- > 0; rest /= dims[d].count()) {
      ir::Step index = step(ir::StepKind::kIndex);
      index.constant_index = dims[d].low + static_cast<int64_t>(rest % dims[d].count());
      one.steps.insert(one.steps.begin() + static_cast<ptrdiff_t>(at.steps.size()), index);
    }
    one.type = element;
    const Expr& list = tree_[tree_.expr_lists[spec->element_args.first + i]];
    start_instance(one, element, list.args);
  }
}

// One loop for each dimension, from the first.
void Body::start_loop(const ir::Place& at, const std::vector<ir::Dimension>& dims, size_t number,
                      ir::TypeId element, const Spec* spec) {
  if (number == dims.size()) {
    ir::Place one = at;
    one.type = element;
    return start_value(one, element, spec);
  }
  constexpr ir::Scalar kI64 = ir::Scalar::kI64;
  const ir::Place counter = temporary_place(elementary(ir::Kind::kLint));
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
  inner.steps.push_back(step(ir::StepKind::kIndex));
  inner.steps.back().value = now;
  start_loop(inner, dims, number + 1, element, spec);
  build_.store(counter, kI64, build_.binary(ir::Op::kAdd, kI64, now, constant(1)));
  build_.jump(head);
  build_.start(done);
}

void Body::start_instance(const ir::Place& at, ir::TypeId type, Range32 args) {
  const PouInfo& block = *sema_.pou_of(type);
  if (block.start != kNoPou) {
    info_.callees.push_back(block.start);
    build_.call_method(sema_.pous[block.start].id, at);
  }
  const uint32_t init = sema_.objects.find_code(block.number, kFbInit).code.method;
  if (init != kNoPou) {
    call_init(at, sema_.pous[init], args);
  } else if (args.count != 0) {
    sema_.error(DiagnosticCode::kBadConstruction, start_span_,
                quoted_name(block.decl->name) + " has no FB_Init that takes arguments");
  }
}

void Body::call_init(const ir::Place& at, const PouInfo& init, Range32 args) {
  Expr call;
  call.kind = ExprKind::kCall;
  call.args = args;
  call.span = start_span_;
  std::vector<Binding> bindings;
  if (!bind_init(call, init, bindings) || !check_in_outs(call, init, bindings)) return;
  info_.callees.push_back(init.number);
  evaluate_arguments(call, bindings);
  for (const Binding& binding : bindings) {
    pass_input(binding, argument_place(init, sema_.resolve(binding.variable)));
  }
  pass_defaults(init, bindings);
  for (VarId id : init.locals) {  // a cold start: retained variables have initial values too
    const Variable& variable = sema_.resolve(id);
    if (variable.section != VarSection::kInput || !traits_of(types(), variable.type).boolean)
      continue;
    if (!ir::same_name(variable.name.text, kImplicit[0])) continue;
    build_.store(argument_place(init, variable), ir::Scalar::kBool,
                 build_.constant(ir::Scalar::kBool, 1));
  }
  build_.call_method(init.id, at);
}

// bInitRetains and bInCopyCode are given by the system; the others by the declaration.
bool Body::bind_init(const Expr& call, const PouInfo& init, std::vector<Binding>& bindings) {
  std::vector<VarId> parameters;
  for (VarId id : init.locals) {
    const Variable& variable = sema_.resolve(id);
    const bool input =
        variable.section == VarSection::kInput || variable.section == VarSection::kInOut;
    if (input && !is_implicit(variable.name)) parameters.push_back(id);
  }
  for (uint32_t i = 0; i < call.args.count; ++i) {
    const Arg& arg = tree_.args[call.args.first + i];
    if (arg.output) {
      sema_.error(DiagnosticCode::kBadConstruction, arg.span, "FB_Init has no outputs here");
      return false;
    }
    if (!arg.name.empty()) {
      if (!bind_named(arg, init, bindings)) return false;
    } else if (i >= parameters.size()) {
      sema_.error(DiagnosticCode::kBadConstruction, arg.span,
                  "FB_Init of " + quoted_name(sema_.pous[init.owner].decl->name) + " takes " +
                      std::to_string(parameters.size()) + " arguments");
      return false;
    } else if (arg.value.valid()) {
      bindings.push_back({parameters[i], &arg, {}, {}, {}});
    }
  }
  for (VarId id : parameters) {
    const Variable& variable = sema_.resolve(id);
    bool given = variable.decl != nullptr && variable.decl->init.valid();
    for (const Binding& binding : bindings) given = given || binding.variable == id;
    if (given) continue;
    sema_.error(DiagnosticCode::kBadConstruction, call.span,
                "FB_Init of " + quoted_name(sema_.pous[init.owner].decl->name) + " needs " +
                    quoted_name(variable.name),
                "give it in the declaration: name : Block(" + std::string(variable.name.text) +
                    " := value);");
    return false;
  }
  return true;
}

}  // namespace frontend
