// The state directory of one controller: its lock, its records, its socket.
#pragma once

#include <string>
#include <vector>

#include "base/result.h"
#include "vm/runtime/descriptor.h"

namespace stvm {

class StateFolder {
 public:
  // Makes the directory (owner only) when it is not there, and locks it until the owner goes. One
  // that others can write is refused: they could exchange what runs. kAlreadyRunning,
  // kFileUnwritable.
  static base::Result<StateFolder> open(const std::string& path);

  // Without links: those could be made to lead elsewhere after they were looked at.
  const std::string& path() const { return path_; }

 private:
  StateFolder(std::string path, vm::Descriptor lock)
      : path_(std::move(path)), lock_(std::move(lock)) {}
  std::string path_;
  vm::Descriptor lock_;
};

// Is a program stored there?
bool holds_program(const std::string& directory);
// Names of the resources whose state folders lie below, sorted; none where a single one is.
std::vector<std::string> stored_resources(const std::string& directory);

}  // namespace stvm
