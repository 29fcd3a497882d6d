// Edits of one function block in a generated project (project.cc).
#pragma once

#include <string>

#include "base/result.h"

namespace bench {

// Statements at the beginning of a function block, in the middle of a file in the middle of all.
struct Edit {
  const char* what;
  const char* text;  // behind the END_VAR of the block
};
inline constexpr Edit kEdits[] = {
    {"a statement is added", "  Stop := Stop OR Tripped;\n"},
    {"a constant is changed", "  Stop := Stop OR Delay.ET > T#1234ms;\n"},
    {"lines move", "\n\n  Stop := Stop OR Reset;\n\n"},
};

// The text of a file with statements that were added so.
inline std::string edited(const std::string& text, const char* added) {
  const size_t block = text.find("FUNCTION_BLOCK Drive", text.size() / 2);
  base::check(block != std::string::npos, "bench_project wrote the project");
  size_t at = text.find("END_VAR\n  IF", block);
  base::check(at != std::string::npos, "a drive has statements");
  at += 8;
  return text.substr(0, at) + added + text.substr(at);
}

}  // namespace bench
