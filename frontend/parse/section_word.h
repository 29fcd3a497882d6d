// The words that begin a block of declarations.
#pragma once

#include <cstddef>
#include <iterator>

#include "frontend/parse/tree.h"

namespace frontend {

constexpr const char* section_word(VarSection section) {
  constexpr const char* kWords[] = {"VAR",      "VAR_INPUT",    "VAR_OUTPUT", "VAR_IN_OUT",
                                    "VAR_TEMP", "VAR_EXTERNAL", "VAR_GLOBAL", "VAR_STAT",
                                    "VAR_INST", "VAR_ACCESS",   "VAR_CONFIG"};
  static_assert(std::size(kWords) == static_cast<size_t>(VarSection::kConfig) + 1);
  return kWords[static_cast<size_t>(section)];
}

}  // namespace frontend
