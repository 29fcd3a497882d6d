// The edits on trial as they are stored (D4): what each of them needs to go back in another
// process, beside the accepted program. The images follow from the packages.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/bytes.h"
#include "base/hash.h"

namespace online_change {

struct StoredEdit {
  std::string name;  // "E1"
  std::string who;
  int64_t time_ns = 0;
  uint64_t cycle = 0;
  uint32_t stage_flags = 0;   // of whoever brought it
  uint32_t switch_flags = 0;  // likewise
  base::Digest from{};
  base::Digest to{};
  base::Bytes package;
  // The cycle of the retained values of `from`, when it was switched.
  uint64_t retained_cycle = 0;
  base::Bytes retained;
};

base::Bytes encode(const std::vector<StoredEdit>& edits);
// Nullopt for what no controller has written; the packages and values are not looked at.
std::optional<std::vector<StoredEdit>> decode_edits(base::ByteSpan payload);

// The edits that lead from what boots to what is on trial, one to the next; none: there is no such
// way. More may be stored: a power cut can come before the list is shorter, or longer.
std::vector<StoredEdit> way_between(const std::vector<StoredEdit>& edits, const base::Digest& boots,
                                    const base::Digest& trial);

}  // namespace online_change
