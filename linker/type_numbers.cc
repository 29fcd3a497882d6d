#include "linker/type_numbers.h"

#include <algorithm>
#include <deque>
#include <string>
#include <unordered_map>

#include "ir/bytecode/image_fields.h"

namespace linker {
namespace {

using ir::TypeId;

constexpr uint32_t kNone = 0xffffffffu;

std::string key_of(const ir::TypeTable& types, TypeId id) {
  return std::to_string(static_cast<uint32_t>(types[id].kind)) + ":" +
         ir::fold_name(types.text(id));
}

// An archive (ir/bytecode/image_fields.h) that gives every type its new number.
class Renumberer {
 public:
  explicit Renumberer(const std::vector<uint32_t>& number_of) : number_of_(&number_of) {}
  void operator()(TypeId& v) const {
    if (v.index < number_of_->size()) v = TypeId((*number_of_)[v.index]);
  }
  template <class T>
  void operator()(T&) const {}
  void text_bytes(const std::string&) const {}
  template <class E>
  void enumerator(E&, uint32_t) const {}
  template <class L, class U>
  void enumerators(L&, uint32_t, U&, uint32_t) const {}
  template <class T, class Each>
  void list(std::vector<T>& v, size_t, Each each) const {
    for (T& item : v) each(item);
  }

 private:
  const std::vector<uint32_t>* number_of_;
};

// What has no type of its own: BYTE(0..0).
ir::Type placeholder(const ir::TypeTable& types) {
  ir::Type type;
  type.kind = ir::Kind::kSubrange;
  type.base = types.elementary(ir::Kind::kByte);
  return type;
}

void renumber_code(std::vector<ir::Unit>& code, const Renumberer& renumber) {
  for (size_t i = 0; i < code.size(); ++i) {
    const ir::OpcodeRow& row = ir::opcode_row(code[i].opcode());
    if (!row.extended) continue;
    ir::Unit& extension = code[++i];
    const auto field = [&](const ir::Field& what, uint32_t value) {
      if (what.kind != ir::FieldKind::kType) return value;
      ir::Region region = ir::region_of_field(value);
      renumber(region.type);
      return ir::region_field(region);
    };
    extension = ir::Unit::extension(field(row.x, extension.x()), field(row.y, extension.y()));
  }
}

}  // namespace

TypeNumbers::TypeNumbers(const ir::TypeTable& types, const ir::Image* base)
    : number_of_(types.size(), kNone), count_(types.size()) {
  const uint32_t base_count = base == nullptr ? 0 : base->types.size();
  of_base_.resize(base_count);
  std::unordered_map<std::string, std::deque<uint32_t>> in_base;
  for (uint32_t i = ir::kElementaryCount; i < base_count; ++i) {
    in_base[key_of(base->types, TypeId(i))].push_back(i);
  }
  std::vector<bool> taken(std::max(base_count, types.size()), false);
  for (uint32_t i = 0; i < types.size(); ++i) {
    if (base == nullptr || i < ir::kElementaryCount) {
      number_of_[i] = i;
    } else if (const auto found = in_base.find(key_of(types, TypeId(i)));
               found != in_base.end() && !found->second.empty()) {
      number_of_[i] = found->second.front();
      found->second.pop_front();
    }
    if (number_of_[i] == kNone) continue;
    taken[number_of_[i]] = true;
    if (number_of_[i] < base_count) of_base_[number_of_[i]] = TypeId(i);
  }
  uint32_t next = 0;
  for (uint32_t& number : number_of_) {
    if (number != kNone) continue;
    while (next < taken.size() && taken[next]) ++next;
    number = next++;
  }
  for (uint32_t number : number_of_) count_ = std::max(count_, number + 1);
}

bool TypeNumbers::are_own() const {
  for (uint32_t i = 0; i < number_of_.size(); ++i) {
    if (number_of_[i] != i) return false;
  }
  return count_ == number_of_.size();
}

void TypeNumbers::apply(ir::Image& image) const {
  const Renumberer renumber(number_of_);
  std::vector<ir::Type> types(count_, placeholder(image.types));
  std::vector<ir::TypeLayout> layouts(count_);
  for (ir::TypeLayout& layout : layouts) layout.size = layout.align = 1;
  for (uint32_t i = 0; i < number_of_.size(); ++i) {
    types[number_of_[i]] = image.types[TypeId(i)];
    type_fields(renumber, types[number_of_[i]]);
    layouts[number_of_[i]] = image.layouts->of[i];
  }
  ir::TypeTable table;
  table.set_old_names(image.types.old_names());
  for (uint32_t i = ir::kElementaryCount; i < count_; ++i) table.declare(std::move(types[i]));
  image.types = std::move(table);
  image.layouts = ir::Layouts{std::move(layouts)};
  renumber(image.globals);
  for (ir::LinkedPou& pou : image.pous) {
    pou_fields(renumber, pou);
    slots_of(renumber, pou.slots.own());
  }
  renumber_code(image.code, renumber);
  for (ir::LinkedBound& bound : image.bounds) bound_fields(renumber, bound);
  for (ir::LinkedOverride& row : image.overrides) override_fields(renumber, row);
  for (ir::Instance& row : image.instances) instance_fields(renumber, row);
  for (ir::LinkedMigration& row : image.migrations) migration_fields(renumber, row);
  for (ir::IoBinding& row : image.io) renumber(row.type);
  std::sort(image.overrides.begin(), image.overrides.end(), [](const auto& a, const auto& b) {
    return std::pair(a.type.index, a.prototype) < std::pair(b.type.index, b.prototype);
  });
}

}  // namespace linker
