#include <cstdlib>

#include "tools/common/exit.h"
#include "tools/stvm/commands.h"

namespace stvm {

bool wants_json(const tools::Options& options) { return options.text("--format") == "json"; }

std::string state_directory(const tools::Options& options) {
  const char* preset = std::getenv("STVM_DIR");
  return options.text("--dir", preset != nullptr && *preset != '\0' ? preset : ".stvm");
}

int refuse(const base::Error& error) { return tools::refuse("stvm", error); }
int refuse_reported(const base::Error& error) { return tools::refuse_reported("stvm", error); }

}  // namespace stvm
