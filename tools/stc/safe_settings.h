// `[outputs] safe = ["%QX0.0 = TRUE", "%QW2 = 16#1234", "%QB4 = hold", "%QX0.1 = hold 500ms then
// TRUE"]` of stc.toml: what outputs become when their task stops (docs/PROJECT.md).
#pragma once

#include <string>
#include <vector>

#include "base/result.h"
#include "ir/bytecode/image.h"
#include "tools/common/toml.h"

namespace stc {

struct SafeSettings {
  std::string file;                      // for messages; empty: there are none
  std::vector<ir::SafeOutput> rows;      // sorted, disjoint
  std::vector<tools::TomlPlace> places;  // of them
};

// Errors: kBadProject, with the entry and its place.
base::Result<SafeSettings> parse_safe_settings(const std::string& file,
                                               const tools::TomlValue& value);
// Every row lies inside the outputs of the program; kBadProject.
base::Status check_safe_settings(const SafeSettings& settings, uint32_t output_bytes);

// The rows that lie inside.
std::vector<ir::SafeOutput> safe_rows_inside(const SafeSettings& settings, uint32_t output_bytes);

}  // namespace stc
