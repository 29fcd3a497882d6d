// How the tools reach another machine: by OpenSSH, so that keys, users and encryption are its own.
// $STVM_SSH names another program than ssh.
#pragma once

#include <string>
#include <vector>

#include "base/result.h"

namespace tools {

// The command line that runs `command` there, without a terminal. kUsage where `host` is none.
base::Result<std::vector<std::string>> ssh_command(const std::string& host,
                                                   const std::string& command);

}  // namespace tools
