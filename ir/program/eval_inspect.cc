#include "ir/program/eval_inspect.h"

#include <algorithm>
#include <charconv>

#include "ir/program/eval_scalar.h"
#include "ir/types/inside.h"
#include "ir/types/listed_name.h"
#include "ir/types/shared_bytes.h"
#include "ir/types/value_text.h"

namespace ir {
namespace {

base::Error no_such_variable(std::string_view path) {
  return {base::Refusal::kNoSuchVariable, "there is no variable `" + std::string(path) + "`"};
}

// "1,-2" as the element number of an array; nullopt when out of bounds.
std::optional<uint64_t> flat_index(const Type& array, std::string_view text) {
  uint64_t flat = 0;
  for (size_t i = 0; i < array.dims.size(); ++i) {
    const size_t comma = std::min(text.find(','), text.size());
    int64_t index = 0;
    const auto read = std::from_chars(text.data(), text.data() + comma, index);
    const Dimension& dim = array.dims[i];
    const bool last = i + 1 == array.dims.size();
    if (read.ec != std::errc() || read.ptr != text.data() + comma || index < dim.low ||
        index > dim.high || last != (comma == text.size())) {
      return std::nullopt;
    }
    flat = flat * dim.count() + (static_cast<uint64_t>(index) - static_cast<uint64_t>(dim.low));
    text.remove_prefix(last ? comma : comma + 1);
  }
  return flat;
}


}  // namespace

// A variable, or a place among bytes that overlap.
Address EvalInspector::whole(Variable& variable) const {
  return {&variable, 0, &variable, 0, variable.type, 0, false};
}

std::optional<Address> EvalInspector::find_first(std::string_view name) const {
  for (size_t i = 0; i < instances_.size(); ++i) {
    if (same_name(program_.instances[i].name, name)) {
      return whole(instances_[i]);
    }
  }
  return find_member(whole(globals_), name);
}

Address EvalInspector::part_of(const Address& at, size_t number) const {
  const Type& type = program_.types[at.type];
  Address part = at;
  if (type.kind == Kind::kArray) {
    part.type = type.base;
    part.offset += static_cast<uint32_t>(number * layouts_[type.base].size);
  } else {
    part.type = type.members[number].type;
    part.bit_mask = bit_mask_of(program_.types, at.type, type.members[number]);
    part.offset += layouts_[at.type].member_offsets[number];
  }
  const bool parts = at.variable != nullptr && !program_.types.overlaps(at.type);
  part.variable = parts ? &at.variable->parts[number] : nullptr;
  if (parts && program_.types.is_instance(part.type)) {
    part.root = part.variable;
    part.offset = 0;
  }
  return part;
}

bool EvalInspector::is_slot(const Address& at) {
  return at.variable != nullptr && at.variable->slot;
}

std::optional<Address> EvalInspector::find_member(const Address& at, std::string_view name) const {
  if (!program_.types.has_members(at.type) || is_slot(at)) {
    return std::nullopt;
  }
  const int32_t member = program_.types.find_member(at.type, name);
  if (member < 0 && at.type == program_.globals) {
    if (const auto shared = find_shared(program_.types, program_.globals, name)) {
      return part_of(part_of(at, shared->global), shared->member);
    }
  }
  return member < 0 ? std::nullopt : std::optional(part_of(at, static_cast<size_t>(member)));
}

std::optional<Address> EvalInspector::find_element(const Address& at,
                                                   std::string_view& rest) const {
  const size_t close = rest.find(']');
  const Type& type = program_.types[at.type];
  if (close == std::string_view::npos || type.kind != Kind::kArray || is_slot(at)) {
    return std::nullopt;
  }
  const std::optional<uint64_t> flat = flat_index(type, rest.substr(1, close - 1));
  rest.remove_prefix(close + 1);
  return flat ? std::optional(part_of(at, *flat)) : std::nullopt;
}

// `end` is after the name.
std::optional<Address> EvalInspector::find_dotted(std::string_view path, size_t& end) const {
  const std::string_view name = listed_name(program_.types, program_.globals, path);
  if (name.empty()) {
    return std::nullopt;
  }
  end = name.size();
  return find_member(whole(globals_), name);
}

// Path grammar of ir/bytecode/symbols.h.
std::optional<Address> EvalInspector::find(std::string_view path) const {
  size_t end = 0;
  std::optional<Address> at = find_dotted(path, end);
  if (!at) {
    end = std::min(path.find_first_of(".["), path.size());
    at = find_first(path.substr(0, end));
  }
  std::string_view rest = path.substr(end);
  while (at && !rest.empty()) {
    if (rest[0] == '[') {
      at = find_element(*at, rest);
    } else if (rest[0] == '.') {
      end = std::min(rest.find_first_of(".[", 1), rest.size());
      at = find_member(*at, rest.substr(1, end - 1));
      rest.remove_prefix(end);
    } else {
      return std::nullopt;
    }
  }
  return at;
}

base::Result<Address> EvalInspector::find_value(std::string_view path) const {
  const std::optional<Address> at = find(path);
  if (!at || is_slot(*at)) {
    return no_such_variable(path);
  }
  return *at;
}

base::Result<Address> EvalInspector::find_scalar(std::string_view path) const {
  const std::optional<Address> at = find(path);
  if (!at) {
    return no_such_variable(path);
  }
  if (is_slot(*at) || !program_.types.is_scalar(at->type)) {
    return base::Error{
        base::Refusal::kBadValue,
        "`" + std::string(path) + "` is " + program_.types.text(at->type) + ", which is no scalar"};
  }
  return *at;
}

base::Result<Address> EvalInspector::find_string(std::string_view path) const {
  const std::optional<Address> at = find(path);
  if (!at) {
    return no_such_variable(path);
  }
  const Kind kind = program_.types[at->type].kind;
  if (is_slot(*at) || (kind != Kind::kString && kind != Kind::kWstring)) {
    return base::Error{base::Refusal::kBadValue, "`" + std::string(path) + "` is no string"};
  }
  return *at;
}

// Text of a string up to its NUL.
std::string EvalInspector::text_of(const Address& at) const {
  const Type& type = program_.types[at.type];
  const size_t unit = type.kind == Kind::kWstring ? 2 : 1;
  std::vector<uint8_t> units((size_t{type.capacity} + 1) * unit);
  if (at.variable != nullptr) {
    units.assign(at.variable->bytes.begin(), at.variable->bytes.end());
  } else {
    references_.bytes().read(*at.root, at.offset, units);
  }
  std::string text;
  for (size_t i = 0; i < type.capacity * unit; i += unit) {
    if (units[i] == 0 && units[i + unit - 1] == 0) {
      break;
    }
    text.append(reinterpret_cast<const char*>(&units[i]), unit);
  }
  return text;
}

uint64_t EvalInspector::bits_of(const Address& at) const {
  const Scalar scalar = program_.types.scalar(at.type);
  uint64_t bits = at.variable != nullptr ? at.variable->bits : 0;
  std::vector<uint8_t> raw(at.variable != nullptr ? 0 : scalar_size(scalar));
  if (!raw.empty()) {
    references_.bytes().read(*at.root, at.offset, raw);
  }
  for (size_t i = 0; i < raw.size(); ++i) {
    bits |= uint64_t{raw[i]} << (8 * i);
  }
  return scalar == Scalar::kBool ? bits != 0 : canonical(scalar, bits);
}

std::string EvalInspector::leaf_text(const Address& at) const {
  const Type& type = program_.types[at.type];
  if (type.kind == Kind::kString) {
    return string_text(text_of(at));
  }
  if (type.kind == Kind::kWstring) {
    return wstring_text(text_of(at));
  }
  const uint64_t bits = bits_of(at);
  if (at.bit_mask != 0) return (bits & at.bit_mask) != 0 ? "TRUE" : "FALSE";
  return is_reference(type.kind) ? references_.text(bits, type.base)
                                 : scalar_text(program_.types, at.type, bits);
}

void EvalInspector::append_state(const std::string& path, const Address& at,
                                 std::string& out) const {
  const Type& type = program_.types[at.type];
  if (is_slot(at)) {
    return;
  }
  if (type.kind == Kind::kArray) {
    for (uint64_t i = 0; i < type.element_count(); ++i) {
      append_state(path + index_text(type, i), part_of(at, i), out);
    }
  } else if (program_.types.has_members(at.type)) {
    for (size_t i = 0; i < type.members.size(); ++i) {
      if (type.members[i].section == Section::kStamp) continue;
      const bool shared = at.type == program_.globals && is_shared(program_.types, type.members[i]);
      const std::string name = shared ? "" : (path.empty() ? "" : ".") + type.members[i].name;
      append_state(path + name, part_of(at, i), out);
    }
  } else {
    out += path + "=" + leaf_text(at) + "\n";
  }
}

std::string EvalInspector::state() const {
  std::string text;
  append_state("", whole(globals_), text);
  for (size_t i = 0; i < instances_.size(); ++i) {
    append_state(program_.instances[i].name, whole(instances_[i]), text);
  }
  return text;
}

}  // namespace ir
