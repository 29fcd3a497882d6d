// Values of variables in JSON: what the controller gives as IEC literals becomes a number, a
// boolean, a text, an array or an object. What JSON's readers cannot hold exactly stays a text:
// integers of 64 bits, NaN and infinities; so do times, dates, enumerations and references. NULL is
// null.
#pragma once

#include <string_view>

#include "tools/common/json.h"

namespace stvm {

// {"type": "INT", "value": 5}. `type` as ir::TypeTable::text() has it; members of structures have
// none here, so a whole number there is a text only from 2^53 on.
void typed_value(tools::JsonWriter& json, std::string_view type, std::string_view literal);
// Writes the two fields in an object that is open.
void typed_fields(tools::JsonWriter& json, std::string_view type, std::string_view literal);

}  // namespace stvm
