// Which lists of global variables a file has.
#pragma once

#include <string_view>
#include <vector>

#include "base/source.h"
#include "frontend/parse/tree.h"

namespace frontend {

// For each of `tree.globals`, the block that its list begins with: what stands in front of that one
// holds for all of them. Only in a file with nothing but VAR_GLOBAL, as a GVL of CODESYS and
// TwinCAT is, does a list have several.
std::vector<const VarBlock*> list_heads(const Tree& tree, const base::SourceMap& sources);

// What {attribute 'list' := 'Name'} says, else the file's name without folder and extension.
std::string_view list_name(const Tree& tree, const base::SourceMap& sources, const VarBlock& head);

}  // namespace frontend
