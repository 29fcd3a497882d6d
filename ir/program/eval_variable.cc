#include "ir/program/eval_variable.h"

#include <algorithm>

#include "ir/program/eval_scalar.h"

namespace ir {
namespace {

bool is_string(Kind kind) { return kind == Kind::kString || kind == Kind::kWstring; }

uint64_t element_count(const Type& type) {
  uint64_t count = 1;
  for (const Dimension& dim : type.dims) {
    count *= dim.count();
  }
  return count;
}

size_t find_nul(std::string_view text, size_t unit) {
  for (size_t at = 0; at + unit <= text.size(); at += unit) {
    if (text.substr(at, unit).find_first_not_of('\0') == std::string_view::npos) {
      return at;
    }
  }
  return text.size();
}

}  // namespace

Variable Variables::make_slot(TypeId type) const {
  Variable variable;
  variable.type = type;
  variable.slot = true;
  return variable;
}

Variable Variables::make_member(const Member& member) const {
  return member.section == Section::kInOut ? make_slot(member.type)
                                           : make(member.type, member.init);
}

Variable Variables::make(TypeId type_id, ConstId init) const {
  const Type& type = program_.types[type_id];
  Variable variable;
  variable.type = type_id;
  if (type.kind == Kind::kArray) {
    variable.parts.assign(element_count(type), make(type.base));
  } else if (type.kind == Kind::kSubrange) {
    variable.bits = make(type.base).bits;
  } else if (type.kind == Kind::kEnum && !type.literals.empty()) {
    variable.bits = static_cast<uint64_t>(type.literals[0].value);
  }
  variable.parts.reserve(variable.parts.size() + type.members.size());
  for (const Member& member : type.members) {
    variable.parts.push_back(make_member(member));
  }
  overlay(variable, type.init);
  overlay(variable, init);
  return variable;
}

void Variables::overlay(Variable& variable, ConstId init) const {
  if (!init.valid()) {
    return;
  }
  const ConstValue& value = program_.constants[init];
  if (program_.types.is_scalar(variable.type)) {
    variable.bits = canonical(program_.types.scalar(variable.type), value.bits);
  } else if (is_string(program_.types[variable.type].kind)) {
    set_text(variable, value.text);
  }
  for (const ConstElement& element : value.elements) {
    for (uint32_t i = 0; i < element.count; ++i) {
      overlay(variable.parts[element.first + i], element.value);
    }
  }
}

void Variables::reset(Variable& variable, ConstId init) const {
  copy(variable, make(variable.type, init));
}

void Variables::copy(Variable& to, const Variable& from) const {
  to.bits = from.bits;
  if (is_string(program_.types[to.type].kind)) {
    set_text(to, from.text);
  }
  for (size_t i = 0; i < to.parts.size(); ++i) {
    copy(to.parts[i], from.parts[i]);
  }
}

void Variables::set_text(Variable& variable, std::string_view text) const {
  const Type& type = program_.types[variable.type];
  const size_t unit = type.kind == Kind::kWstring ? 2 : 1;
  const size_t room = size_t{type.capacity} * unit;
  variable.text = std::string(text.substr(0, std::min(room, find_nul(text, unit))));
}

}  // namespace ir
