// Exit codes of both tools (docs/reference/exit_codes.md), and the one way to say that something
// was refused.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "base/result.h"

namespace tools {

inline constexpr int kOk = 0;
inline constexpr int kFindings = 1;
inline constexpr int kUsage = 2;
inline constexpr int kRefused = 7;
inline constexpr int kInternal = 70;
inline constexpr int kOutputLost = 74;

struct ExitRow {
  int code;
  const char* name;
  const char* meaning;
};
std::span<const ExitRow> exit_rows();

// What `--format` asks for when something is refused, printed to standard output beside the text
// for people on standard error. dispatch() says it once.
using RefusalForm = std::string (*)(const base::Error& error);
void set_refusal_form(RefusalForm form);
bool has_refusal_form();

// Says "TOOL: R0401: text" and the way out on stderr; returns the exit code.
int refuse(const char* tool, const base::Error& error);
// Refuses after a report on standard output that says it already.
int refuse_reported(const char* tool, const base::Error& error);
int exit_code(const base::Error& error);

}  // namespace tools
