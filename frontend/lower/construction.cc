// An instance that is made: FB_Init of its bases and its own, what its declaration gives it, and
// methods with 'call_after_init'; one that leaves: FB_Exit.
#include "frontend/lower/arguments.h"
#include "frontend/lower/given_values.h"
#include "frontend/lower/start_code.h"
#include "frontend/sema/objects/objects.h"
#include "ir/types/stamps.h"

namespace frontend {
namespace {

constexpr std::string_view kImplicit[] = {"bInitRetains", "bInCopyCode"};

bool is_implicit(const Name& name) {
  return ir::same_name(name.text, kImplicit[0]) || ir::same_name(name.text, kImplicit[1]);
}

}  // namespace

// The method of that name that the block has, and those that it has from its bases, which vendors
// run too; else its own alone.
std::vector<const PouInfo*> StartCode::codes_of(const PouInfo& block, std::string_view name) const {
  std::vector<const PouInfo*> codes;
  for (uint32_t at = block.number; at != kNoPou; at = sema_.declared.pous[at].base) {
    const NameMap<MemberCode>& own = sema_.declared.pous[at].code;
    const auto found = own.find(name);
    if (found == own.end() || found->second.method == kNoPou) continue;
    codes.push_back(&sema_.declared.pous[found->second.method]);
    if (!ask<Objects>().runs_bases(name)) break;
  }
  return codes;
}

void StartCode::construct(const ir::Place& at, ir::TypeId type, Range32 args,
                          base::SourceSpan span) {
  span_ = span;
  instance(at, type, args, {});
}

void StartCode::exit(const ir::Place& at, const PouInfo& block) {
  for (const PouInfo* method : codes_of(block, kFbExit)) call(at, *method);
}

// What leaves, leaves from the outside in; the other way round, what is inside is ready first.
void StartCode::instance(const ir::Place& at, ir::TypeId type, Range32 args, ir::ConstId values,
                         bool new_ones) {
  constexpr ir::Scalar kU32 = ir::Scalar::kU32;
  const PouInfo& block = *sema_.declared.pou_of(type);
  GivenValues given = ask<GivenValues>();
  if (!block.stamp.valid()) {
    if (args.count != 0) {
      error(DiagnosticCode::kBadConstruction, span_,
            quoted_name(block.decl->name) + " has no FB_Init that takes arguments");
    }
    if (new_ones) given.find_inner(at, type, values);
    start_members(at, block);
    return given.write_inner();
  }
  const ir::Place stamp = stamp_place(at, block);
  auto is = [&](uint32_t value) {
    return build_.compare(ir::Op::kEq, kU32, build_.load(stamp, kU32), number(value));
  };
  auto set = [&](uint32_t value) { build_.store(stamp, kU32, number(value)); };
  if (!codes_of(block, kFbExit).empty()) {
    when(is(ir::kLeavingStamp), [&] {
      exit(at, block);
      set(ir::kLeftStamp);
    });
  }
  if (new_ones && values.valid()) {
    when(is(ir::kNewStamp), [&] { given.take_back(at, type, values); });
  }
  start_members(at, block);
  const uint32_t made = ask<Objects>().stamp_of(block);
  if (new_ones) {
    when(is(ir::kNewStamp), [&] {
      initialize(at, block, args);
      if (values.valid()) given.write(at, type, values);
      call_after(at, block);
      set(made);
    });
  }
  const std::vector<const PouInfo*> reinit = codes_of(block, kFbReinit);
  if (reinit.empty()) return;
  const ir::ValueId now = build_.load(stamp, kU32);
  when(build_.compare(ir::Op::kLe, kU32, number(ir::kFirstShapeStamp), now), [&] {
    when(build_.compare(ir::Op::kNe, kU32, now, number(made)), [&] {
      call(at, *reinit[0]);
      set(made);
    });
  });
}

ir::ValueId StartCode::is_new(const ir::Place& at, const PouInfo& block) const {
  constexpr ir::Scalar kU32 = ir::Scalar::kU32;
  return build_.compare(ir::Op::kEq, kU32, build_.load(stamp_place(at, block), kU32),
                        build_.constant(kU32, ir::kNewStamp));
}

ir::Place StartCode::stamp_place(const ir::Place& at, const PouInfo& block) const {
  ir::Place stamp = at;
  stamp.steps.push_back(step_to(ir::StepKind::kEnter));
  stamp.steps.push_back(step_to(ir::StepKind::kMember, resolve(block.stamp).index));
  stamp.type = resolve(block.stamp).type;
  return stamp;
}

void StartCode::start_members(const ir::Place& at, const PouInfo& block) {
  if (block.start == kNoPou) return;
  info_.callees.push_back(block.start);
  build_.call_method(sema_.declared.pous[block.start].id, at);
}

// The bases first, each with those of the arguments that it has a parameter for.
void StartCode::initialize(const ir::Place& at, const PouInfo& block, Range32 args) {
  const std::vector<const PouInfo*> codes = codes_of(block, kFbInit);
  if (codes.empty()) {
    if (args.count == 0) return;
    return error(DiagnosticCode::kBadConstruction, span_,
                 quoted_name(block.decl->name) + " has no FB_Init that takes arguments");
  }
  Expr written;
  written.kind = ExprKind::kCall;
  written.list = args;
  written.span = span_;
  std::vector<Binding> bindings;
  if (!bind(written, *codes[0], bindings)) return;
  for (size_t i = codes.size(); i-- > 1;) {
    std::vector<Binding> of_base;
    if (bind_base(*codes[i], block, bindings, of_base)) call(at, *codes[i], written, of_base);
  }
  call(at, *codes[0], written, bindings);
}

// Methods with 'call_after_init' of the block and its bases, once for each name.
void StartCode::call_after(const ir::Place& at, const PouInfo& block) {
  for (uint32_t method : ask<Objects>().called_after_init(block)) {
    call(at, sema_.declared.pous[method]);
  }
}

// Nobody gives it arguments.
void StartCode::call(const ir::Place& at, const PouInfo& method) {
  Expr written;
  written.span = span_;
  std::vector<Binding> none;
  if (check_all_given(method, none)) call(at, method, written, none);
}

void StartCode::call(const ir::Place& at, const PouInfo& method, const Expr& written,
                     std::vector<Binding>& bindings) {
  constexpr ir::Scalar kBool = ir::Scalar::kBool;
  if (!ask<Arguments>().check_in_outs(written, method, bindings)) return;
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
  const std::vector<VarId> parameters = parameters_of(method);
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
            method_text(method) + " takes " + std::to_string(parameters.size()) + " arguments");
      return false;
    } else if (arg.value.valid()) {
      bindings.push_back({parameters[i], &arg, {}, {}, {}});
    }
  }
  return check_all_given(method, bindings);
}

// A parameter of the base takes what the one of that name takes.
bool StartCode::bind_base(const PouInfo& method, const PouInfo& block,
                          const std::vector<Binding>& given, std::vector<Binding>& bindings) {
  for (VarId id : parameters_of(method)) {
    for (const Binding& binding : given) {
      if (!ir::same_name(resolve(binding.variable).name.text, resolve(id).name.text)) continue;
      bindings.push_back({id, binding.arg, {}, {}, {}});
    }
  }
  const Variable* missing = find_missing(method, bindings);
  if (missing == nullptr) return true;
  const std::string name = quoted_name(missing->name);
  error(DiagnosticCode::kBadConstruction, span_,
        method_text(method) + " runs first and needs " + name,
        "declare " + name + " in FB_Init of " + quoted_name(block.decl->name) +
            " too, or give it an initial value in that of the base");
  return false;
}

std::vector<VarId> StartCode::parameters_of(const PouInfo& method) const {
  std::vector<VarId> parameters;
  for (VarId id : method.locals) {
    const Variable& variable = resolve(id);
    const bool input =
        variable.section == VarSection::kInput || variable.section == VarSection::kInOut;
    if (input && !is_implicit(variable.name)) parameters.push_back(id);
  }
  return parameters;
}

std::string StartCode::method_text(const PouInfo& method) const {
  return std::string(method.decl->name.text) + " of " +
         quoted_name(sema_.declared.pous[method.owner].decl->name);
}

// A parameter without an initial value that nothing is bound to; nullptr: there is none.
const Variable* StartCode::find_missing(const PouInfo& method,
                                        const std::vector<Binding>& bindings) const {
  for (VarId id : parameters_of(method)) {
    const Variable& variable = resolve(id);
    bool given = variable.decl != nullptr && variable.decl->init.valid();
    for (const Binding& binding : bindings) given = given || binding.variable == id;
    if (!given) return &variable;
  }
  return nullptr;
}

bool StartCode::check_all_given(const PouInfo& method, const std::vector<Binding>& bindings) {
  const Variable* missing = find_missing(method, bindings);
  if (missing == nullptr) return true;
  const std::string name(method.decl->name.text);
  error(DiagnosticCode::kBadConstruction, span_,
        method_text(method) + " needs " + quoted_name(missing->name),
        ir::same_name(name, kFbInit)
            ? "give it in the declaration: name : Block(" + std::string(missing->name.text) +
                  " := value);"
            : "give it an initial value: nobody calls " + name + " with arguments");
  return false;
}

}  // namespace frontend
