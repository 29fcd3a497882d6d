// One POU as text: declarations of its frame, blocks, instructions.
#pragma once

#include <string>

#include "ir/program/print_names.h"

namespace ir {

// Appends the section of one POU in the format of text.h.
void print_pou(const Program& program, const PrintNames& names, const Pou& pou, std::string& text);

}  // namespace ir
