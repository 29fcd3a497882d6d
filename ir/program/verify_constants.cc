#include "ir/program/verify_parts.h"

namespace ir {
namespace {

uint64_t value_count(const Type& type) {
  if (type.kind != Kind::kArray) {
    return type.members.size();
  }
  return type.element_count();
}

std::string name(ConstId id) { return "constant #" + std::to_string(id.index); }

}  // namespace

base::Status ConstantCheck::fits(TypeId type, ConstId constant) {
  open_.assign(1, {type, constant});
  while (!open_.empty()) {
    const Pair pair = open_.back();
    open_.pop_back();
    if (!pair.constant.valid() || !known_.insert({pair.type.index, pair.constant.index}).second) {
      continue;
    }
    if (!constants_.contains(pair.constant)) {
      return not_verified(name(pair.constant) + " does not exist");
    }
    if (base::Status status = push_elements(pair); !status.ok()) {
      return status;
    }
  }
  return base::Ok{};
}

base::Status ConstantCheck::push_elements(const Pair& pair) {
  const Type& type = types_[pair.type];
  const std::vector<ConstElement>& elements = constants_[pair.constant].elements;
  if (types_.is_scalar(pair.type) || type.kind == Kind::kString || type.kind == Kind::kWstring) {
    return elements.empty() ? base::Status(base::Ok{})
                            : not_verified(name(pair.constant) + " has elements, but is for " +
                                           types_.text(pair.type));
  }
  const uint64_t count = value_count(type);
  for (const ConstElement& element : elements) {
    if (uint64_t{element.first} + element.count > count || element.count == 0 ||
        (type.kind != Kind::kArray && element.count != 1)) {
      return not_verified(name(pair.constant) + " has an element outside of " +
                          types_.text(pair.type));
    }
    // Constants are built from the leaves up, so no constant contains itself.
    if (element.value.index >= pair.constant.index) {
      return not_verified(name(pair.constant) + " refers to a later constant");
    }
    open_.push_back(
        {type.kind == Kind::kArray ? type.base : type.members[element.first].type, element.value});
  }
  return base::Ok{};
}

}  // namespace ir
