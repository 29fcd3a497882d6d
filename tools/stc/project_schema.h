// What may stand in stc.toml (tools/common/project_keys.def, the drivers of ir/bytecode/devices.h),
// for editors and for people.
#pragma once

#include <string>

namespace stc {

// JSON schema, draft 2020-12.
std::string project_schema();

}  // namespace stc
