#include "vm/load/same_code.h"

#include <algorithm>
#include <cstring>
#include <functional>

namespace vm {

namespace {

template <class Table, class Same>
bool begins_with(const Table& longer, const Table& begin, Same same) {
  return longer.size() >= begin.size() &&
         std::equal(begin.begin(), begin.end(), longer.begin(), same);
}

bool same_bound(const ir::LinkedBound& a, const ir::LinkedBound& b) {
  return a.low == b.low && a.count == b.count && a.stride == b.stride;
}

}  // namespace

bool have_same_places(const ir::Image& before, const ir::Image& after) {
  const size_t bounds = std::min(before.bounds.size(), after.bounds.size());
  return before.types.is_one_with(after.types) && before.layouts.is_one_with(after.layouts) &&
         before.instances.is_one_with(after.instances) && before.data.is_one_with(after.data) &&
         before.globals == after.globals &&
         std::equal(before.bounds.begin(), before.bounds.begin() + static_cast<ptrdiff_t>(bounds),
                    after.bounds.begin(), same_bound) &&
         std::ranges::equal(before.pous, after.pous,
                            [](const ir::LinkedPou& a, const ir::LinkedPou& b) {
                              return a.kind == b.kind && a.self == b.self &&
                                     a.recursion_depth == b.recursion_depth;
                            });
}

// Numbers of constants, bounds and ranges stay; more of them may follow.
bool stand_on_the_same(const ir::Image& before, const ir::Image& after) {
  return have_same_places(before, after) &&
         std::equal(before.overrides.begin(), before.overrides.end(), after.overrides.begin(),
                    after.overrides.end(),
                    [](const ir::LinkedOverride& a, const ir::LinkedOverride& b) {
                      return a.type == b.type && a.prototype == b.prototype && a.target == b.target;
                    }) &&
         before.bounds.size() <= after.bounds.size() &&
         begins_with(after.ranges.all(), before.ranges.all(),
                     [](const ir::Range& a, const ir::Range& b) {
                       return a.low == b.low && a.high == b.high;
                     });
}

bool have_same_code(const ir::Image& before, const ir::Image& after, uint32_t number) {
  const ir::LinkedPou& a = before.pous[number];
  const ir::LinkedPou& b = after.pous[number];
  return a.frame_size == b.frame_size && a.slots.is_one_with(b.slots) &&
         a.merges.is_one_with(b.merges) && a.unit_count == b.unit_count &&
         std::memcmp(before.code.data() + a.first_unit, after.code.data() + b.first_unit,
                     a.unit_count * sizeof(ir::Unit)) == 0;
}

}  // namespace vm
