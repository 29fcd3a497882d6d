#include "online_change/apply/values_back.h"

#include <algorithm>
#include <cstring>
#include <string>
#include <vector>

#include "ir/bytecode/symbols.h"

namespace online_change {
namespace {

// Places in data memory and the bytes that belong there, sorted.
template <class Bytes>
class Places {
 public:
  void add(uint32_t begin, uint32_t size, Bytes* bytes) {
    places_.push_back({begin, begin + size, bytes});
  }
  void sort() {
    std::sort(places_.begin(), places_.end(),
              [](const Place& a, const Place& b) { return a.begin < b.begin; });
  }
  // Null: not in one of them.
  Bytes* at(uint32_t begin, uint32_t size) const {
    auto found = std::upper_bound(places_.begin(), places_.end(), begin,
                                  [](uint32_t at, const Place& one) { return at < one.begin; });
    if (found == places_.begin()) return nullptr;
    const Place& one = *--found;
    return uint64_t{begin} + size <= one.end ? one.bytes + (begin - one.begin) : nullptr;
  }

 private:
  struct Place {
    uint32_t begin = 0;
    uint32_t end = 0;
    Bytes* bytes = nullptr;
  };
  std::vector<Place> places_;
};

// What the edit took away, its way back makes anew.
Places<const uint8_t> taken_away(const Transfer& way_back) {
  Places<const uint8_t> places;
  for (const Piece& piece : way_back.pieces()) {
    if (piece.kind != StepKind::kInitialise) continue;
    places.add(piece.to, piece.total(), way_back.remembered(piece));
  }
  places.sort();
  return places;
}

Places<uint8_t> made_anew(Plan& plan) {
  Places<uint8_t> places;
  for (UpdateStep& step : plan.steps) {
    if (step.kind != StepKind::kInitialise) continue;
    step.bytes.resize(step.total());
    for (uint32_t i = 0; i < step.count; ++i) {
      uint8_t* const bytes = step.bytes.data() + size_t{i} * step.size;
      places.add(step.to + i * step.to_stride, step.size, bytes);
    }
  }
  places.sort();
  return places;
}

}  // namespace

uint64_t put_values_back(Plan& plan, const ir::Image& next, const Transfer& way_back,
                         const ir::Image& before) {
  const Places<const uint8_t> from = taken_away(way_back);
  const Places<uint8_t> to = made_anew(plan);
  uint64_t count = 0;
  ir::for_each_leaf(before, [&](const std::string& path, const ir::Symbol& there) {
    const uint32_t size = before.layouts[there.type].size;
    const uint8_t* const value = from.at(there.data, size);
    if (value == nullptr || there.bit_mask != 0) return;
    if (ir::is_reference(before.types[there.type].kind)) return;
    const base::Result<ir::Symbol> here = ir::find_symbol(next, path);
    if (!here.ok() || here->bit_mask != 0) return;
    if (!ir::same_value_type(before.types, before.layouts, there.type, next.types, next.layouts,
                             here->type)) {
      return;
    }
    uint8_t* const out = to.at(here->data, size);
    if (out == nullptr) return;
    std::memcpy(out, value, size);
    ++count;
  });
  return count;
}

}  // namespace online_change
