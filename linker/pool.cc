#include "linker/pool.h"

namespace linker {
namespace {

constexpr size_t kPoolAlign = 8;

}  // namespace

uint32_t ConstantPool::intern(const base::Bytes& entry) {
  const auto [found, added] =
      offsets_.try_emplace(std::string(entry.begin(), entry.end()), bytes_.size());
  if (added) {
    bytes_.insert(bytes_.end(), entry.begin(), entry.end());
    bytes_.resize((bytes_.size() + kPoolAlign - 1) / kPoolAlign * kPoolAlign);
  }
  return found->second;
}

void ConstantPool::add_scalars(const ir::Object& object) {
  std::vector<uint32_t>& offsets = of_object_[&object];
  offsets.resize(object.constants.size());
  for (size_t i = 0; i < offsets.size(); ++i) {
    const ir::ObjectConstant& constant = object.constants[i];
    if (!constant.type.valid()) offsets[i] = intern(constant.bytes);
  }
}

void ConstantPool::add_values(const ir::Object& object, const InitialValues& initial,
                              const ir::Layouts& layouts) {
  std::vector<uint32_t>& offsets = of_object_[&object];
  for (size_t i = 0; i < offsets.size(); ++i) {
    const ir::ObjectConstant& constant = object.constants[i];
    if (!constant.type.valid()) continue;
    base::Bytes bytes(layouts[constant.type].size, 0);
    initial.write_value(constant.type, constant.value, bytes);
    offsets[i] = intern(bytes);
  }
}

uint32_t ConstantPool::offset(const ir::Object& object, uint32_t number) const {
  return of_object_.at(&object)[number];
}

}  // namespace linker
