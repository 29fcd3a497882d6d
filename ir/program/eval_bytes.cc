#include "ir/program/eval_bytes.h"

#include <algorithm>

#include "ir/program/eval_scalar.h"

namespace ir {
namespace {

uint8_t leaf_byte(const Variable& leaf, uint32_t index) {
  return leaf.bytes.empty() ? static_cast<uint8_t>(leaf.bits >> (8 * index))
                            : static_cast<uint8_t>(leaf.bytes[index]);
}

}  // namespace

uint32_t EvalBytes::leaf_size(const Variable& leaf) const {
  return leaf.bytes.empty() ? scalar_size(types_.scalar(leaf.type))
                            : static_cast<uint32_t>(leaf.bytes.size());
}

template <class Var, class Visit>
void EvalBytes::for_leaves(Var& variable, uint64_t at, uint64_t begin, uint64_t end,
                           Visit visit) const {
  const Type& type = types_[variable.type];
  if (type.kind == Kind::kArray) {
    const uint64_t stride = layouts_[type.base].size;
    size_t i = begin > at && stride != 0 ? static_cast<size_t>((begin - at) / stride) : 0;
    for (; i < variable.parts.size() && at + i * stride < end; ++i) {
      if (!types_.is_instance(type.base)) {
        for_leaves(variable.parts[i], at + i * stride, begin, end, visit);
      }
    }
    return;
  }
  if (variable.parts.empty()) {
    if (!types_.has_members(variable.type) || !variable.bytes.empty()) {
      visit(variable, at);
    }
    return;
  }
  if (is_padded(variable)) visit(variable, at);
  for (size_t i = 0; i < variable.parts.size(); ++i) {
    Var& part = variable.parts[i];
    const uint64_t first = at + layouts_[variable.type].member_offsets[i];
    const bool meets = first < end && begin < first + layouts_[part.type].size;
    if (!part.slot && !types_.is_instance(part.type) && meets) {
      for_leaves(part, first, begin, end, visit);
    }
  }
}

bool EvalBytes::is_padded(const Variable& variable) const {
  return !variable.parts.empty() && types_[variable.type].kind == Kind::kStruct;
}

void EvalBytes::read(const Variable& root, uint32_t offset, std::span<uint8_t> out) const {
  std::fill(out.begin(), out.end(), uint8_t{0});
  const uint64_t end = uint64_t{offset} + out.size();
  for_leaves(root, 0, offset, end, [&](const Variable& leaf, uint64_t at) {
    if (is_padded(leaf) && leaf.bytes.empty()) return;
    for (uint32_t i = 0; i < leaf_size(leaf); ++i) {
      if (at + i >= offset && at + i < end) {
        out[at + i - offset] = leaf_byte(leaf, i);
      }
    }
  });
}

void EvalBytes::write(Variable& root, uint32_t offset, std::span<const uint8_t> in) const {
  const uint64_t end = uint64_t{offset} + in.size();
  for_leaves(root, 0, offset, end, [&](Variable& leaf, uint64_t at) {
    // The bytes of its members go along, and are never looked at.
    if (is_padded(leaf) && leaf.bytes.empty()) leaf.bytes.assign(layouts_[leaf.type].size, 0);
    for (uint32_t i = 0; i < leaf_size(leaf); ++i) {
      if (at + i < offset || at + i >= end) {
        continue;
      }
      const uint8_t byte = in[at + i - offset];
      if (!leaf.bytes.empty()) {
        leaf.bytes[i] = static_cast<char>(byte);
      } else {
        leaf.bits = (leaf.bits & ~(uint64_t{0xff} << (8 * i))) | uint64_t{byte} << (8 * i);
      }
    }
    if (leaf.bytes.empty()) {
      const Scalar scalar = types_.scalar(leaf.type);
      leaf.bits = scalar == Scalar::kBool ? leaf.bits & 0xff : canonical(scalar, leaf.bits);
    }
  });
}

Variable* EvalBytes::find(Variable& root, uint32_t offset, TypeId wanted) const {
  Variable* at = &root;
  while (offset != 0 || at->type != wanted || at->slot) {
    const Type& type = types_[at->type];
    if (at->parts.empty() || at->slot || (at != &root && types_.is_instance(at->type))) {
      return nullptr;
    }
    Variable* next = nullptr;
    if (type.kind == Kind::kArray) {
      const uint32_t stride = layouts_[type.base].size;
      if (stride == 0 || offset / stride >= at->parts.size()) {
        return nullptr;
      }
      next = &at->parts[offset / stride];
      offset %= stride;
    }
    for (size_t i = 0; next == nullptr && i < at->parts.size(); ++i) {
      const uint32_t first = layouts_[at->type].member_offsets[i];
      const uint32_t size = at->parts[i].slot ? 4 : layouts_[at->parts[i].type].size;
      if (offset >= first && offset - first < size) {
        next = &at->parts[i];
        offset -= first;
      }
    }
    if (next == nullptr) {
      return nullptr;
    }
    at = next;
  }
  return at;
}

}  // namespace ir
