#include "ir/program/eval_variable.h"

#include <algorithm>
#include <cstring>

#include "ir/program/eval_bytes.h"
#include "ir/program/eval_scalar.h"

namespace ir {
namespace {

bool is_string(Kind kind) { return kind == Kind::kString || kind == Kind::kWstring; }

size_t unit_of(const Type& type) { return type.kind == Kind::kWstring ? 2 : 1; }

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

// What `list` says about a member or element; the last mention counts.
ConstId Variables::listed(ConstId list, uint32_t index) const {
  ConstId found;
  if (list.valid()) {
    for (const ConstElement& element : program_.constants[list].elements) {
      if (index >= element.first && index - element.first < element.count) {
        found = element.value;
      }
    }
  }
  return found;
}

// An initial value replaces what the declarations below it say: the instance's or
// variable's first, then the type's, then the member's (docs/LANGUAGE.md).
Variable Variables::make_member(const Type& owner, uint32_t index, ConstId init) const {
  const Member& member = owner.members[index];
  if (member.section == Section::kInOut || program_.types[member.type].kind == Kind::kProgram) {
    return make_slot(member.type);
  }
  if (const ConstId own = listed(init, index); own.valid()) {
    return make(member.type, own);
  }
  const ConstId of_type = listed(owner.init, index);
  return make(member.type, of_type.valid() ? of_type : member.init);
}

void Variables::make_elements(const Type& array, ConstId init, Variable& variable) const {
  variable.parts.assign(array.element_count(), make(array.base));
  for (const ConstId list : {array.init, init}) {
    if (!list.valid()) {
      continue;
    }
    for (const ConstElement& element : program_.constants[list].elements) {
      const Variable value = make(array.base, element.value);
      std::fill_n(variable.parts.begin() + element.first, element.count, value);
    }
  }
}

// A scalar or string without an initial value of its own takes its type's, then its base type's.
void Variables::make_leaf(const Type& type, ConstId init, Variable& variable) const {
  const ConstId value = init.valid() ? init : type.init;
  if (is_string(type.kind)) {
    variable.bytes.assign((size_t{type.capacity} + 1) * unit_of(type), 0);
    set_text(variable, value.valid() ? std::string_view(program_.constants[value].text) : "");
  } else if (value.valid()) {
    variable.bits = canonical(program_.types.scalar(variable.type), program_.constants[value].bits);
  } else if (type.kind == Kind::kSubrange) {
    variable.bits = make(type.base).bits;
  } else if (type.kind == Kind::kEnum && !type.literals.empty()) {
    variable.bits = static_cast<uint64_t>(type.literals[0].value);
  }
}

Variable Variables::make(TypeId type_id, ConstId init) const {
  const Type& type = program_.types[type_id];
  Variable variable;
  variable.type = type_id;
  if (program_.types.overlaps(type_id)) {
    return make_overlapping(type_id, init);
  }
  if (type.kind == Kind::kArray) {
    make_elements(type, init, variable);
  } else if (program_.types.has_members(type_id)) {
    variable.parts.reserve(type.members.size());
    for (uint32_t i = 0; i < type.members.size(); ++i) {
      variable.parts.push_back(make_member(type, i, init));
    }
  } else {
    make_leaf(type, init, variable);
  }
  return variable;
}

void Variables::reset(Variable& variable, ConstId init) const {
  copy(variable, make(variable.type, init));
}

Variable Variables::make_overlapping(TypeId type, ConstId init) const {
  Variable variable;
  variable.type = type;
  if (layouts_ == nullptr) {
    return variable;
  }
  const TypeLayout& layout = (*layouts_)[type];
  variable.bytes.assign(layout.size, 0);
  const EvalBytes bytes(program_.types, *layouts_);
  for (const MemberInit& part : overlap_inits(program_.types, program_.constants, type, init)) {
    const TypeId member = program_.types[type].members[part.member].type;
    std::vector<uint8_t> value((*layouts_)[member].size);
    bytes.read(make(member, part.value), 0, value);
    std::copy(value.begin(), value.end(),
              variable.bytes.begin() + layout.member_offsets[part.member]);
  }
  return variable;
}

void Variables::copy(Variable& to, const Variable& from) const {
  if (is_string(program_.types[to.type].kind)) {
    return set_text(to, from.bytes);
  }
  copy_all(to, from);
}

// A BOOL that was written as bytes may be any of them; a single one is read as TRUE, in a
// structure the byte stays.
void Variables::copy_all(Variable& to, const Variable& from) const {
  to.bits = from.bits;
  to.bytes = from.bytes;
  for (size_t i = 0; i < to.parts.size(); ++i) {
    copy_all(to.parts[i], from.parts[i]);
  }
}

void Variables::set_text(Variable& variable, std::string_view text) const {
  const Type& type = program_.types[variable.type];
  const size_t unit = unit_of(type);
  const size_t length = std::min(size_t{type.capacity} * unit, find_nul(text, unit));
  std::memmove(variable.bytes.data(), text.data(), length);
  std::fill_n(variable.bytes.begin() + static_cast<ptrdiff_t>(length), unit, '\0');
}

std::string_view Variables::text(const Variable& variable) const {
  const Type& type = program_.types[variable.type];
  const std::string_view all = variable.bytes;
  return all.substr(0,
                    std::min(size_t{type.capacity} * unit_of(type), find_nul(all, unit_of(type))));
}

}  // namespace ir
