#include <cstdlib>

#include "tools/common/exit.h"
#include "tools/stvm/commands.h"

namespace stvm {

base::Result<bool> wants_json(const tools::Options& options) {
  std::string form = options.text("--format", "text");
  if (form == "json") return true;
  if (form == "text") return false;
  return base::Error{base::Refusal::kUsage, "--format is text or json, not `" + form + "`"};
}

std::string state_directory(const tools::Options& options) {
  const char* preset = std::getenv("STVM_DIR");
  return options.text("--dir", preset != nullptr && *preset != '\0' ? preset : ".stvm");
}

int refuse(const base::Error& error) { return tools::refuse("stvm", error); }

}  // namespace stvm
