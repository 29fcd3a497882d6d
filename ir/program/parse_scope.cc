#include "ir/program/parse_scope.h"

namespace ir {

ParseScope::ParseScope() {
  for (uint32_t i = 0; i < kElementaryCount; ++i) {
    types_.emplace(fold_name(elementary_name(static_cast<Kind>(i))), i);
  }
  type_count_ = kElementaryCount;
}

bool ParseScope::add_type(LineReader& line) {
  const uint32_t number = type_count_++;
  if (line.take("%") && line.index() != number) {
    line.fail("types are numbered in order; this is %" + std::to_string(number));
    return false;
  }
  if (line.peek_name()) {
    types_.emplace(fold_name(line.name()), number);
  }
  return true;
}

void ParseScope::add_pou(std::string_view name) { pous_.emplace(fold_name(name), pou_count_++); }

std::string ParseScope::type_label(LineReader& line) const {
  if (line.take("%")) {
    line.index();
  }
  return line.peek_name() ? line.name() : std::string();
}

TypeId ParseScope::type(LineReader& line) const {
  if (line.take("%")) {
    const uint32_t number = line.index();
    if (number >= type_count_) {
      line.fail("there is no type %" + std::to_string(number));
      return TypeId();
    }
    return TypeId(number);
  }
  const std::string name = line.name();
  const auto found = types_.find(fold_name(name));
  if (found == types_.end()) {
    line.fail("there is no type " + name);
    return TypeId();
  }
  return TypeId(found->second);
}

PouId ParseScope::pou(LineReader& line) const {
  if (line.take("#")) {
    return PouId(line.index());
  }
  const std::string name = line.name();
  const auto found = pous_.find(fold_name(name));
  if (found == pous_.end()) {
    line.fail("there is no POU " + name);
    return PouId();
  }
  return PouId(found->second);
}

}  // namespace ir
