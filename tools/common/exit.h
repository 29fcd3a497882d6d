// Exit codes of both tools, and the one way to say
// that something was refused.
#pragma once

#include "base/result.h"

namespace tools {

inline constexpr int kOk = 0;
inline constexpr int kFindings = 1;
inline constexpr int kUsage = 2;
inline constexpr int kRefused = 7;
inline constexpr int kInternal = 70;

// Prints "TOOL: R0401: text" and the way out to stderr; returns the exit code.
int refuse(const char* tool, const base::Error& error);
int exit_code(const base::Error& error);

}  // namespace tools
