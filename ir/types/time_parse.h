// Literals of durations, dates and times of day to nanoseconds, in every spelling
// of IEC 61131-3 tables 8 and 9, long and short prefixes; the prefix may be missing.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "ir/types/types.h"

namespace ir {

std::optional<int64_t> parse_duration(std::string_view text);
// `kind`: one of the date group; decides which prefix and which parts are expected.
std::optional<int64_t> parse_date(Kind kind, std::string_view text);

}  // namespace ir
