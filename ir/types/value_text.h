// Scalars and strings as IEC literals, and back: one spelling for monitoring,
// fate reports, golden files and the evaluator.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "base/result.h"
#include "ir/types/types.h"

namespace ir {

// `bits` as in ConstValue: sign-extended low bytes, REAL as f32 bits.
// REAL prints the shortest text that reads back the same ("2.5", "1.0E+10", "NaN", "+Inf").
// A reference is "NULL" or "ref"; who has symbols names its target (ir/bytecode/symbols.h).
std::string scalar_text(const TypeTable& types, TypeId type, uint64_t bits);
std::string string_text(std::string_view bytes);     // 'ab$'c'
std::string wstring_text(std::string_view utf16le);  // "ab"
std::string duration_text(int64_t ns);               // T#1h2m3s4ms5us6ns without zero parts; T#0s

// Parses any literal that people type for a value of `type`: typed or bare
// ("INT#5", "5", "16#FF", "T#5s", "Red", "Color#Red", "TRUE"). kBadValue otherwise.
base::Result<uint64_t> parse_scalar(const TypeTable& types, TypeId type, std::string_view text);
base::Result<std::string> parse_string(std::string_view text);   // single quotes
base::Result<std::string> parse_wstring(std::string_view text);  // double quotes -> UTF-16LE

}  // namespace ir
