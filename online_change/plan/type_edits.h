// Which types of the source a change edits: structures, unions, enumerations, and named subranges,
// arrays and references. Function blocks and classes are POUs (pou_edits.h).
#pragma once

#include <string>
#include <vector>

#include "online_change/plan/same_data.h"

namespace online_change {

enum class TypeChange : uint8_t { kAdded, kRemoved, kEdited };
const char* type_change_name(TypeChange change);

struct TypeEdit {
  TypeChange change = TypeChange::kEdited;
  std::string type;
};

// By name, the removed ones last. A type whose members have edited types is not edited itself, nor
// is one whose initial values alone are others: fates say what becomes of variables.
std::vector<TypeEdit> type_edits(const EncodedImage& old_version, const EncodedImage& new_version);

}  // namespace online_change
