// The state directory of one controller: its lock, its records, its socket.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "base/result.h"
#include "vm/runtime/descriptor.h"

namespace stvm {

class StateFolder {
 public:
  // Locks the directory until the owner goes; with `create`, makes it (owner only) when it is not
  // there. One that others can write is refused: they could exchange what runs. kAlreadyRunning,
  // kFileUnwritable, kFileNotFound.
  static base::Result<StateFolder> open(const std::string& path, bool create);

  // Without links: those could be made to lead elsewhere after they were looked at.
  const std::string& path() const { return path_; }
  int descriptor() const { return locks_[1].get(); }  // of the directory that is locked
  bool is_new() const { return is_new_; }             // open() has made it

 private:
  using Locks = std::array<vm::Descriptor, 2>;
  StateFolder(std::string path, Locks locks, bool is_new)
      : path_(std::move(path)), locks_(std::move(locks)), is_new_(is_new) {}
  std::string path_;
  Locks locks_;
  bool is_new_;
};

// Has a controller ever stored something there, whatever is left of it?
bool holds_program(const std::string& directory);
// Names of the resources whose state folders lie below, sorted; none where a single one is.
std::vector<std::string> stored_resources(const std::string& directory);

}  // namespace stvm
