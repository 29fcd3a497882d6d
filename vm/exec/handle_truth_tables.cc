// The handler of truth tables.
#include "vm/exec/truth_tables.h"

#include <cstddef>

#include "vm/exec/context.h"

namespace vm {

// Rows are read where they are: a copy of a row would be waited for.
void take_truth_tables(STC_HANDLER_ARGS) {
  uint8_t* const places[4] = {frame, self, mem, nullptr};
  const ir::Unit* const series = pc + pc->bc();
  const uint32_t units = series->x();
  const auto* row = reinterpret_cast<const uint8_t*>(series + 1);
  const uint8_t* const end = row + sizeof(TruthRow) * series->y();
  for (; row != end; row += sizeof(TruthRow)) {
    const uint32_t bases = load<uint16_t>(row + offsetof(TruthRow, bases));
    const auto input = [&](uint32_t k) -> uint64_t {
      return places[bases >> 2 * k & 3][load<uint16_t>(row + offsetof(TruthRow, in) + 2 * k)];
    };
    const uint64_t number =
        ((((input(5) * 2 + input(4)) * 2 + input(3)) * 2 + input(2)) * 2 + input(1)) * 2 + input(0);
    const uint64_t table = load<uint64_t>(row + offsetof(TruthRow, table));
    places[bases >> 12][load<uint16_t>(row + offsetof(TruthRow, out))] = table >> (number & 63) & 1;
  }
  STC_NEXT(units);
}

}  // namespace vm
