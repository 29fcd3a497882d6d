// What a change does to code: the POUs whose object is another one (E1), whether somebody has
// edited them (E-02, case 76), and whether what their callers see of them stays. It stands beside
// the fates of variables in the report: where an instance goes on with its values under other code,
// its outputs may jump (change case 41).
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/result.h"
#include "ir/bytecode/image.h"
#include "online_change/plan/same_data.h"

namespace online_change {

enum class PouChange : uint8_t {
  kAdded,
  kRemoved,
  kBody,       // callers see the same
  kInterface,  // inputs, outputs, in-outs or result differ
  kFollows,    // nobody edited it: code that it takes in, a type or a constant is another one
};
const char* pou_change_name(PouChange change);

struct PouEdit {
  PouChange change = PouChange::kBody;
  std::string pou;
  uint64_t instances = 0;  // that go on with their values; of a body: function block or program
  std::string what;        // kInterface: "input `speed` INT -> DINT"
};

// By name, then the removed ones, then those that follow. Linear in the POUs of both versions.
std::vector<PouEdit> pou_edits(const ir::Image& old_image, const ir::Image& new_image);
// The same result, sooner where types are as they were; no two POUs of a version have one name, as
// linkers make them.
std::vector<PouEdit> pou_edits(const EncodedImage& old_version, const EncodedImage& new_version);
// D7: kInterfaceEdit when a POU that stays gets another interface.
base::Status check_restricted(const std::vector<PouEdit>& edits);

}  // namespace online_change
