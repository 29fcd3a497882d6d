// Edits of one function block in a generated project (project.cc).
#pragma once

#include <cstdint>
#include <string>

#include "base/result.h"

namespace bench {

// Statements at the beginning of a function block, in the middle of a file in the middle of all.
// Every version has others: what it becomes was never made or stored before.
struct Edit {
  const char* what;
  std::string (*text)(uint32_t version);  // behind the END_VAR of the block
};
inline constexpr Edit kEdits[] = {
    {"a statement is changed",
     [](uint32_t version) {
       std::string text;
       for (uint32_t left = version + 1; left != 0; left /= 2) {
         text += left % 2 == 0 ? "  Stop := Stop OR Tripped;\n" : "  Stop := Stop AND Reset;\n";
       }
       return text;
     }},
    {"a constant is changed",
     [](uint32_t version) {
       return "  Stop := Stop OR Delay.ET > T#" + std::to_string(1234 + version) + "ms;\n";
     }},
    {"lines move",
     [](uint32_t version) {
       return std::string(version + 2, '\n') + "  Stop := Stop OR Reset;\n\n";
     }},
};

// The text of a file with statements that were added so.
inline std::string edited(const std::string& text, const std::string& added) {
  const size_t block = text.find("FUNCTION_BLOCK Drive", text.size() / 2);
  base::check(block != std::string::npos, "bench_project wrote the project");
  size_t at = text.find("END_VAR\n  IF", block);
  base::check(at != std::string::npos, "a drive has statements");
  at += 8;
  return text.substr(0, at) + added + text.substr(at);
}

}  // namespace bench
