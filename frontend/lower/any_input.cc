// What is passed to an input of type ANY (sema/declarations/any_inputs.cc).
#include "frontend/lower/arguments.h"
#include "frontend/lower/references.h"
#include "frontend/sema/calls/open_functions.h"
#include "ir/types/parts.h"

namespace frontend {
namespace {

constexpr uint32_t kTypeClass = 0;  // members of AnyType
constexpr uint32_t kPvalue = 1;
constexpr uint32_t kSize = 2;

// As TYPE_CLASS of stdlib/st/any.st.
uint64_t any_class(ir::Kind kind) {
  constexpr uint64_t kNone = 29;
  static constexpr uint64_t kElementary[] = {
      0,  6,  7,  8,  9,  10, 11, 12, 13, 2,  3,     4,     5,
      14, 15, 18, 37, 19, 46, 21, 48, 20, 47, kNone, kNone,
  };
  static_assert(std::size(kElementary) == ir::kElementaryCount);
  if (ir::is_elementary(kind)) return kElementary[static_cast<size_t>(kind)];
  switch (kind) {
    case ir::Kind::kString:
      return 16;
    case ir::Kind::kWstring:
      return 17;
    case ir::Kind::kPointer:
    case ir::Kind::kRefTo:
      return 22;
    case ir::Kind::kReferenceTo:
      return 23;
    case ir::Kind::kSubrange:
      return 24;
    case ir::Kind::kEnum:
      return 25;
    case ir::Kind::kArray:
      return 26;
    case ir::Kind::kStruct:
    case ir::Kind::kUnion:
      return 28;
    default:
      return kNone;
  }
}

}  // namespace

void Arguments::evaluate_any(Binding& binding) {
  const Variable& parameter = resolve(binding.variable);
  const ExprId id = binding.arg->value;
  const Note& note = infer(id);
  if (!note.type.valid()) return;
  if (note.type == parameter.type) {  // another such input
    binding.place = place(id);
    return;
  }
  const std::string_view group = sema_.tree[parameter.decl->spec].name.text;
  if (!OpenFunctions::belongs(types(), group, note.type) ||
      ir::holds_instance(types(), note.type)) {
    error(DiagnosticCode::kBadGenericArgument, binding.arg->span,
          "`" + sema_.report.type_text(note.type) + "` cannot be given to an input of type " +
              std::string(group));
    return;
  }
  const ir::Place record = temporary_place(parameter.type);
  const auto store_part = [&](uint32_t member, ir::ValueId part) {
    ir::Place at = record;
    at.steps.push_back(step_to(ir::StepKind::kMember, member));
    at.type = types()[record.type].members[member].type;
    build_.store(at, scalar(at.type), part);
  };
  store_part(kPvalue, ask<References>().handle_of(id));
  store_part(kTypeClass, build_.constant(ir::Scalar::kI32, any_class(types()[note.type].kind)));
  store_part(kSize, build_.unary(ir::Op::kWrap, ir::Scalar::kI32, build_.size_of(note.type)));
  binding.place = record;
}

}  // namespace frontend
