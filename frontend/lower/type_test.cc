// Assignments and questions that depend on what an instance is: `i ?= x`,
// __QUERYINTERFACE(x, i), __QUERYPOINTER(x, p). What does not fit leaves NULL.
#include "frontend/lower/places.h"
#include "frontend/lower/references.h"

namespace frontend {

// The reference to an instance that `id` is or holds; reports what is neither.
std::optional<ir::ValueId> References::object_handle(ExprId id) {
  const Note& note = infer(id);
  if (!note.type.valid()) return std::nullopt;
  if (note.constant && note.flex == Flex::kNull) return build_.constant(ir::Scalar::kU64, 0);
  if (types().is_instance(note.type)) return handle_of(id);
  const bool reference = types().is_reference(note.type);
  const ir::TypeId target = reference ? types()[note.type].base : ir::TypeId();
  if (is_interface(types(), note.type) || (reference && types().is_instance(target))) {
    return natural(id).value;
  }
  error(DiagnosticCode::kBadTypeTest, tree_[id].span,
        "`" + sema_.report.type_text(note.type) + "` is no instance of a block and refers to none",
        "use an instance, a reference to one, or a variable of an interface");
  return std::nullopt;
}

// Binds the variable `left` to the instance when its type allows; whether it does.
Attempt References::attempt(ExprId left, ExprId right, base::SourceSpan span) {
  Attempt result{code_.zero(elementary(ir::Kind::kBool)), build_.constant(ir::Scalar::kU64, 0)};
  const Note note = infer(left);
  if (!note.type.valid()) {
    infer(right);
    return result;
  }
  const bool bound = note.reference.valid() && !is_interface(types(), note.type);
  const ir::TypeId reference = bound ? note.reference : note.type;
  const ir::TypeId wanted =
      types().is_reference(reference) ? types()[reference].base : ir::TypeId();
  const bool good = wanted.valid() &&
                    (types().is_instance(wanted) || types()[wanted].kind == ir::Kind::kInterface);
  if (!good) {
    error(DiagnosticCode::kBadTypeTest, tree_[left].span,
          "`" + sema_.report.type_text(reference) + "` cannot take what a type test finds",
          "use a variable of an interface, or a reference to a function block or class");
    return result;
  }
  std::optional<Target> to;
  if (bound) {
    to.emplace();
    to->place = ask<Places>().raw_place(left);
    to->type = to->place.type;
  } else {
    to = target(left);
  }
  const std::optional<ir::ValueId> handle = object_handle(right);
  if (!to || !handle) return result;
  set_line(span);
  result.fits = build_.is_type(*handle, wanted);
  result.handle =
      build_.select(ir::Scalar::kU64, result.fits, build_.constant(ir::Scalar::kU64, 0), *handle);
  store(*to, result.handle);
  return result;
}

}  // namespace frontend
