// Words of the text format that printer and parser share (text.h).
#pragma once

#include <array>
#include <string>
#include <string_view>

#include "ir/program/ir.h"

namespace ir {

inline constexpr std::array<std::string_view, 6> kSectionWords = {"local",  "input",  "output",
                                                                  "in_out", "global", "stamp"};
inline constexpr std::array<std::string_view, 4> kAreaWords = {"none", "input", "output", "marker"};
inline constexpr std::array<std::string_view, 5> kLocalWords = {"input", "output", "in_out",
                                                                "return", "temp"};
inline constexpr std::array<std::string_view, 4> kPouWords = {"function", "function_block",
                                                              "program", "method"};
// Kinds from kString on.
inline constexpr std::array<std::string_view, 14> kKindWords = {
    "string",       "wstring", "enum",  "subrange",       "array",   "pointer", "ref_to",
    "reference_to", "struct",  "union", "function_block", "program", "globals", "interface"};

// Does the scalar stand after the operation?
bool shows_scalar(Op op);
// Scalar of the result: bool for comparisons, the instruction's otherwise.
Scalar result_scalar(const Inst& inst);

bool is_word_byte(char c);
// NAME of the text format.
std::string name_text(std::string_view name);
// "LEN/i:S"; "#99" when there is no such native function.
std::string native_text(uint32_t native);
// An immediate as the instruction `const` shows it.
std::string immediate_text(Scalar scalar, uint64_t bits);
bool parse_immediate(Scalar scalar, std::string_view text, uint64_t& bits);

}  // namespace ir
