// The IR as text, printed for golden tests and `stc dump --ir`, and parsed back:
// parse(print(p)) is p. The printer's output is the specification of the format.
#pragma once

#include <string>
#include <string_view>

#include "base/result.h"
#include "ir/program/ir.h"

namespace ir {

std::string print(const Program& program);
std::string print(const Program& program, const Pou& pou);
base::Result<Program> parse_program(std::string_view text);

}  // namespace ir
