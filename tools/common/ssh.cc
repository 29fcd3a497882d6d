#include "tools/common/ssh.h"

#include <cstdlib>

namespace tools {

base::Result<std::vector<std::string>> ssh_command(const std::string& host,
                                                   const std::string& command) {
  // ssh would take it for one of its options.
  if (host.empty() || host[0] == '-') {
    return base::Error{base::Refusal::kUsage, "--host names a machine, not `" + host + "`"};
  }
  const char* preset = std::getenv("STVM_SSH");
  const std::string ssh = preset != nullptr && *preset != '\0' ? preset : "ssh";
  return std::vector<std::string>{ssh, "-T", host, command};
}

}  // namespace tools
