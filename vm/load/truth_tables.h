// Makes truth tables (vm/exec/truth_tables.h) of straight lines of boolean logic. Each
// table takes in as much as six variables decide, so that what lies between the variables of a rung
// is computed by none: temporaries that nobody reads after the line are not written.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/bytes.h"
#include "ir/bytecode/image.h"
#include "vm/exec/truth_tables.h"

namespace vm {

// What instructions of boolean logic in a row do, into whose middle nothing jumps. After it, all
// memory is the same, but for temporaries that are never read again.
struct TruthSeries {
  uint32_t first = 0;  // unit of the line
  uint32_t units = 0;
  SlotHome home = kNoHome;
  std::vector<TruthRow> rows;
};

// The lines of at least `least` instructions in the code of a verified POU of an image whose BOOLs
// stay clean and whose constants are `pool`; those that are quicker as tables, or `all`.
std::vector<TruthSeries> truth_tables(const ir::LinkedPou& pou, std::span<const ir::Unit> code,
                                      const base::Bytes& pool, uint32_t least, bool all);

// After the units of `prepared`, and the handler at the beginning of the line.
void put_truth_tables(const TruthSeries& series, std::vector<ir::Unit>& prepared);

}  // namespace vm
