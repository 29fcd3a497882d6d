#include "ir/program/print_names.h"

#include "ir/program/place.h"
#include "ir/program/text_names.h"

namespace ir {
namespace {

std::string number(uint32_t index) { return "#" + std::to_string(index); }

// The first element of that name is the one that the parser finds.
template <class Elements>
std::string element(const Elements& elements, uint32_t index) {
  if (index >= elements.size() || elements[index].name.empty()) {
    return number(index);
  }
  for (uint32_t i = 0; i < elements.size(); ++i) {
    if (i != index && same_name(elements[i].name, elements[index].name)) {
      return number(index);
    }
  }
  return name_text(elements[index].name);
}

std::string base_text(const PrintNames& names, const Pou& pou, const Place& place) {
  switch (place.base) {
    case PlaceBase::kLocal:
      return "local." + names.local(pou, place.base_index);
    case PlaceBase::kSelf:
      return "self";
    case PlaceBase::kGlobal:
      return "global";
    case PlaceBase::kArg:
      return "arg(" + names.pou(place.pou) + ")";
    case PlaceBase::kConst:
      return "const(#" + std::to_string(place.constant.index) + " : " +
             names.type(place.base_type) + ")";
    case PlaceBase::kPointee:
      return "pointee(v" + std::to_string(place.value.index) + " : " + names.type(place.base_type) +
             ")";
    case PlaceBase::kTarget:
      return "target(v" + std::to_string(place.value.index) + " : " + names.type(place.base_type) +
             ")";
  }
  return "?";
}

std::string step_text(const PrintNames& names, const PlaceState* state, const Step& step) {
  switch (step.kind) {
    case StepKind::kMember:
      return "." + (state != nullptr ? names.member(state->type, step.index) : number(step.index));
    case StepKind::kIndex:
      return step.value.valid() ? "[v" + std::to_string(step.value.index) + "]"
                                : "[" + std::to_string(step.constant_index) + "]";
    case StepKind::kEnter:
      return "!";
    case StepKind::kDeref:
      return "^";
  }
  return "?";
}

}  // namespace

bool UniqueNames::unique(std::string_view name) const {
  const auto found = count_.find(fold_name(name));
  return !name.empty() && found != count_.end() && found->second == 1;
}

PrintNames::PrintNames(const Program& program) : program_(program) {
  for (uint32_t i = 0; i < program.types.size(); ++i) {
    types_.add(program.types[TypeId(i)].name);
  }
  for (const Pou& pou : program.pous) {
    pous_.add(pou.name);
  }
}

bool PrintNames::is_unique_type(TypeId id) const {
  return program_.types.contains(id) && types_.unique(program_.types[id].name);
}

std::string PrintNames::type(TypeId id) const {
  return is_unique_type(id) ? name_text(program_.types[id].name) : "%" + std::to_string(id.index);
}

std::string PrintNames::pou(PouId id) const {
  const bool named = id.index < program_.pous.size() && pous_.unique(program_.pous[id.index].name);
  return named ? name_text(program_.pous[id.index].name) : number(id.index);
}

std::string PrintNames::member(TypeId type, uint32_t index) const {
  return program_.types.contains(type) ? element(program_.types[type].members, index)
                                       : number(index);
}

std::string PrintNames::local(const Pou& pou, uint32_t index) const {
  return element(pou.locals, index);
}

std::string print_place(const Program& program, const PrintNames& names, const Pou& pou,
                        PlaceId id) {
  if (id.index >= pou.places.size()) {
    return "?" + std::to_string(id.index);
  }
  const Place& place = pou.places[id.index];
  std::string text = base_text(names, pou, place);
  if (place.base == PlaceBase::kArg) {
    const bool known = place.pou.index < program.pous.size();
    text += "." + (known ? names.local(program.pous[place.pou.index], place.base_index)
                         : number(place.base_index));
  }
  base::Result<PlaceState> state = place_base(program, pou, place);
  for (const Step& step : place.steps) {
    text += step_text(names, state.ok() ? &*state : nullptr, step);
    if (state.ok()) {
      state = place_step(program.types, *state, step);
    }
  }
  return text;
}

}  // namespace ir
