#include "ir/program/parse_scope.h"
#include "ir/program/place.h"

namespace ir {
namespace {

// NAME or #N after a point.
template <class Elements>
uint32_t parse_element(LineReader& line, const Elements& elements, std::string_view what) {
  if (line.take("#")) {
    return line.index();
  }
  const std::string name = line.name();
  for (uint32_t i = 0; i < elements.size(); ++i) {
    if (same_name(elements[i].name, name)) {
      return i;
    }
  }
  line.fail("there is no " + std::string(what) + " " + name);
  return 0;
}

uint32_t parse_local_name(LineReader& line, const Pou& pou) {
  line.expect(".");
  return parse_element(line, pou.locals, "local variable");
}

void parse_argument(const Program& program, const ParseScope& scope, LineReader& line,
                    Place& place) {
  line.expect("(");
  place.pou = scope.pou(line);
  line.expect(")");
  if (line.failed() || place.pou.index >= program.pous.size()) {
    line.fail("there is no such function");
    return;
  }
  place.base_index = parse_local_name(line, program.pous[place.pou.index]);
}

void parse_typed_base(const ParseScope& scope, LineReader& line, Place& place) {
  line.expect("(");
  if (place.base == PlaceBase::kConst) {
    place.constant = line.constant();
  } else {
    place.value = ValueId(line.numbered('v'));
  }
  line.expect(":");
  place.base_type = scope.type(line);
  line.expect(")");
}

void parse_base(const Program& program, const ParseScope& scope, const Pou& pou, LineReader& line,
                Place& place) {
  constexpr std::array<std::string_view, 7> kBases = {"local", "self",    "global", "const",
                                                      "arg",   "pointee", "target"};
  place.base = static_cast<PlaceBase>(line.choice(kBases));
  if (line.failed()) {
    return;
  }
  switch (place.base) {
    case PlaceBase::kLocal:
      place.base_index = parse_local_name(line, pou);
      break;
    case PlaceBase::kArg:
      parse_argument(program, scope, line, place);
      break;
    case PlaceBase::kConst:
    case PlaceBase::kPointee:
    case PlaceBase::kTarget:
      parse_typed_base(scope, line, place);
      break;
    default:
      break;
  }
}

bool parse_step(const TypeTable& types, TypeId type, LineReader& line, Step& step) {
  if (line.take(".")) {
    step.kind = StepKind::kMember;
    step.index = parse_element(line, types[type].members, "member");
  } else if (line.take("[")) {
    step.kind = StepKind::kIndex;
    if (line.peek().starts_with('v')) {
      step.value = ValueId(line.numbered('v'));
    } else {
      step.constant_index = line.signed_number();
    }
    line.expect("]");
  } else if (line.take("!")) {
    step.kind = StepKind::kEnter;
  } else if (line.take("^")) {
    step.kind = StepKind::kDeref;
  } else {
    return false;
  }
  return true;
}

}  // namespace

Place parse_place(const Program& program, const ParseScope& scope, const Pou& pou,
                  LineReader& line) {
  Place place;
  parse_base(program, scope, pou, line, place);
  base::Result<PlaceState> state = PlaceState{};
  if (!line.failed()) {
    state = place_base(program, pou, place);
    place.base_type = state.ok() ? state->type : TypeId();
  }
  while (!line.failed() && state.ok() && program.types.contains(state->type)) {
    Step step;
    if (!parse_step(program.types, state->type, line, step)) {
      break;
    }
    place.steps.push_back(step);
    state = place_step(program.types, *state, step);
  }
  if (!state.ok()) {
    line.fail(state.error().text);
  }
  place.type = state.ok() ? state->type : TypeId();
  return place;
}

}  // namespace ir
