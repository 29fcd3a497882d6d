#include "linker/tables.h"

#include "linker/offsets.h"

namespace linker {
namespace {

// The name of an entry that nothing uses. No variable has this name.
constexpr const char* kUnused = "(unused)";

std::string text_of(const base::ByteWriter& key) {
  return {key.bytes().begin(), key.bytes().end()};
}

// Entries of one table on their way to their numbers.
template <class T>
class Table {
 public:
  void need(std::string key, T value) {
    if (numbers_.try_emplace(key, kNone).second) needed_.emplace_back(std::move(key), value);
  }

  // The base has `key` at `number`.
  void keep(const std::string& key, uint32_t number) {
    const auto found = numbers_.find(key);
    if (found == numbers_.end() || found->second != kNone) return;
    found->second = number;
    if (taken_.size() <= number) taken_.resize(number + 1, false);
    taken_[number] = true;
  }

  void finish(std::vector<T>& table, std::unordered_map<std::string, uint32_t>& numbers) {
    uint32_t next = 0;
    for (const auto& [key, value] : needed_) {
      uint32_t& number = numbers_[key];
      if (number == kNone) {
        while (next < taken_.size() && taken_[next]) ++next;
        number = next++;
      }
      if (table.size() <= number) table.resize(number + 1, unused());
      table[number] = value;
      numbers.emplace(key, number);
    }
  }

 private:
  static constexpr uint32_t kNone = 0xffffffffu;

  // As good as any other for whoever checks the table.
  T unused() const {
    T entry = needed_.front().second;
    entry.name = kUnused;
    return entry;
  }

  std::vector<std::pair<std::string, T>> needed_;
  std::unordered_map<std::string, uint32_t> numbers_;
  std::vector<bool> taken_;
};

}  // namespace

std::string bound_key(ir::TypeId array, uint8_t dim, const std::string& name) {
  base::ByteWriter key;
  key.u8('b');
  key.u32(array.index);
  key.u8(dim);
  key.text(name);
  return text_of(key);
}

std::string range_key(const ir::Range& range) {
  base::ByteWriter key;
  key.u8('r');
  key.i64(range.low);
  key.i64(range.high);
  key.text(range.name);
  return text_of(key);
}

void fill_tables(LinkContext& context, const ir::Image* base, const TypeNumbers& types) {
  Table<ir::LinkedBound> bounds;
  Table<ir::Range> ranges;
  for (const ir::Object* object : context.objects) {
    if (object == nullptr) continue;
    for (const ir::Bound& row : object->bounds) {
      const ir::Dimension& dim = context.program.types[row.array].dims[row.dim];
      const uint64_t stride =
          stride_of(context.program.types, context.image.layouts, row.array, row.dim);
      bounds.need(
          bound_key(row.array, row.dim, row.name),
          {dim.low, dim.count(), static_cast<uint32_t>(stride), {row.array, row.dim}, row.name});
    }
    for (const ir::Range& row : object->ranges) ranges.need(range_key(row), row);
  }
  if (base != nullptr) {
    for (uint32_t i = 0; i < base->bounds.size(); ++i) {
      const ir::LinkedBound& row = base->bounds[i];
      const ir::TypeId array = types.of_base(row.from.type);
      if (array.valid() && row.name != kUnused) {
        bounds.keep(bound_key(array, row.from.dim, row.name), i);
      }
    }
    for (uint32_t i = 0; i < base->ranges.size(); ++i) {
      if (base->ranges[i].name != kUnused) ranges.keep(range_key(base->ranges[i]), i);
    }
  }
  bounds.finish(context.image.bounds.own(), context.table_numbers);
  ranges.finish(context.image.ranges.own(), context.table_numbers);
}

}  // namespace linker
