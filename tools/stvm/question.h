// The one question that a command asks before it does something to a controller.
#pragma once

#include <string>

#include "base/result.h"

namespace stvm {

bool can_ask();  // a person at a terminal

// Ok for y or yes. kUsage without a terminal, which says --yes; else kBusy with what is so instead:
// `otherwise`, "not switched; the old program runs on".
base::Status ask(const char* question, const std::string& otherwise);

// The answer about one of many; at a terminal only. No answer that is known is no.
enum class Answer : uint8_t { kNo, kYes, kAll, kQuit };
Answer ask_for_each(const char* question);

}  // namespace stvm
