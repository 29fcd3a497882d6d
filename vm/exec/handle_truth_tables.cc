// The handler of truth tables.
#include "vm/exec/truth_tables.h"

#include <cstddef>

#include "vm/exec/context.h"

namespace vm {

namespace {

// Rows are read where they are: a copy of a row would be waited for.
template <bool has_home>
STC_INLINE void take_rows(const ir::Unit* series, uint8_t* const (&places)[4],
                          const uint8_t* home) {
  const auto* row = reinterpret_cast<const uint8_t*>(series + 1);
  const uint8_t* const end = row + sizeof(TruthRow) * series->y();
  for (; row != end; row += sizeof(TruthRow)) {
    const uint32_t bases = load<uint16_t>(row + offsetof(TruthRow, bases));
    const auto input = [&](uint32_t k) -> uint64_t {
      const bool at_home = has_home && k < kHomeInputs;
      const uint8_t* const place = at_home ? home : places[bases >> 2 * k & 3];
      return place[load<uint16_t>(row + offsetof(TruthRow, in) + 2 * k)];
    };
    const uint64_t number =
        ((((input(5) * 2 + input(4)) * 2 + input(3)) * 2 + input(2)) * 2 + input(1)) * 2 + input(0);
    const uint64_t table = load<uint64_t>(row + offsetof(TruthRow, table));
    places[bases >> 12][load<uint16_t>(row + offsetof(TruthRow, out))] = table >> (number & 63) & 1;
  }
}

}  // namespace

void take_truth_tables(STC_HANDLER_ARGS) {
  uint8_t* const places[4] = {frame, self, mem, nullptr};
  const ir::Unit* const series = pc + pc->bc();
  if (pc->a == kNoHome) {
    take_rows<false>(series, places, nullptr);
  } else {
    take_rows<true>(series, places, places[pc->a]);
  }
  STC_NEXT(series->x());
}

}  // namespace vm
