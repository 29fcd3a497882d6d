#include "linker/pool.h"

#include <algorithm>
#include <cstring>

#include "ir/bytecode/image.h"

namespace linker {
namespace {

constexpr size_t kPoolAlign = 8;

// Bytes of constants that no code needs any more, besides as many as it needs.
constexpr size_t kPoolWaste = 4096;

// A value that is laid out already is no scalar.
bool is_scalar(const ir::ObjectConstant& constant) {
  return !constant.type.valid() && constant.cls != ir::Class::kA;
}

// The first word, what is missing as zeros: scalars are padded so.
uint64_t first_word(const uint8_t* bytes, size_t size) {
  uint64_t word = 0;
  std::memcpy(&word, bytes, std::min(size, kPoolAlign));
  return word;
}

}  // namespace

ConstantPool::ConstantPool(const base::Bytes& base) : bytes_(base), base_size_(base.size()) {
  for (size_t at = 0; at + kPoolAlign <= base_size_; at += kPoolAlign) {
    words_[first_word(base.data() + at, kPoolAlign)].push_back(static_cast<uint32_t>(at));
  }
}

std::optional<uint32_t> ConstantPool::in_base(base::ByteSpan entry) const {
  const auto found = words_.find(first_word(entry.data(), entry.size()));
  if (found == words_.end()) return std::nullopt;
  for (uint32_t at : found->second) {
    const bool fits = entry.size() <= base_size_ - at;
    if (fits && std::memcmp(bytes_.data() + at, entry.data(), entry.size()) == 0) return at;
  }
  return std::nullopt;
}

uint32_t ConstantPool::intern(base::ByteSpan entry) {
  const auto [found, added] = offsets_.try_emplace(std::string(entry.begin(), entry.end()), 0);
  if (!added) return found->second;
  if (const std::optional<uint32_t> known = in_base(entry)) return found->second = *known;
  found->second = static_cast<uint32_t>(bytes_.size());
  bytes_.insert(bytes_.end(), entry.begin(), entry.end());
  bytes_.resize((bytes_.size() + kPoolAlign - 1) / kPoolAlign * kPoolAlign);
  return found->second;
}

void ConstantPool::add_scalars(const ir::Object& object) {
  std::vector<uint32_t>& offsets = of_object_[&object];
  offsets.resize(object.constants.size());
  for (size_t i = 0; i < offsets.size(); ++i) {
    const ir::ObjectConstant& constant = object.constants[i];
    if (is_scalar(constant)) offsets[i] = intern(constant.bytes);
  }
}

void ConstantPool::add_values(const ir::Object& object, const InitialValues& initial,
                              const ir::Layouts& layouts) {
  std::vector<uint32_t>& offsets = of_object_[&object];
  for (size_t i = 0; i < offsets.size(); ++i) {
    const ir::ObjectConstant& constant = object.constants[i];
    if (is_scalar(constant)) continue;
    if (!constant.type.valid()) {
      offsets[i] = intern(constant.bytes);
      continue;
    }
    base::Bytes bytes(layouts[constant.type].size, 0);
    initial.write_value(constant.type, constant.value, bytes);
    offsets[i] = intern(bytes);
  }
}

ConstantPool make_pool(const std::vector<const ir::Object*>& objects, const InitialValues& initial,
                       const ir::Layouts& layouts, const base::Bytes* base) {
  const auto fill = [&](ConstantPool& pool) {
    for (const ir::Object* object : objects) {
      if (object != nullptr) pool.add_scalars(*object);
    }
    for (const ir::Object* object : objects) {
      if (object != nullptr) pool.add_values(*object, initial, layouts);
    }
  };
  ConstantPool own;
  fill(own);
  base::Bytes bytes = own.bytes();
  if (base != nullptr && base->size() <= 2 * bytes.size() + kPoolWaste) {
    ConstantPool grown(*base);
    fill(grown);
    if (grown.bytes().size() <= ir::kConstPoolLimit) bytes = grown.bytes();
  }
  ConstantPool pool(bytes);
  fill(pool);
  return pool;
}

}  // namespace linker
