// A POSIX shared memory object whose other user is not trusted with this process: it may truncate,
// remove, replace or overwrite the object at any instant. The object is never mapped here: a
// mapping that the other side has cut short raises SIGBUS, a call on the descriptor only fails.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <span>
#include <string>

#include "base/bytes.h"
#include "base/result.h"
#include "vm/runtime/descriptor.h"

namespace vm {

class SharedObject {
 public:
  // `mode`: 0600, with the bits of others who may open it.
  SharedObject(std::string name, size_t size, mode_t mode);

  bool is_open() const { return file_.valid(); }
  // Makes it, or takes one that is there when this user or root owns it and nobody else than `mode`
  // says may write it. kDeviceFailed, and then it is closed.
  base::Status open();
  void close() { file_ = Descriptor(); }

  // Is it still the object of that name, as large and as well protected as when it was opened?
  base::Status check() const;
  base::Status read(uint64_t at, std::span<uint8_t> bytes) const;
  base::Status write(uint64_t at, base::ByteSpan bytes) const;

  base::Error failed(const std::string& what) const;  // kDeviceFailed, with the name

 private:
  base::Error call_failed(const char* call) const;
  base::Status make_or_take();
  base::Status make_room() const;
  base::Status check_owner(uid_t owner, mode_t mode) const;

  const std::string name_;
  const size_t size_;
  const mode_t mode_;
  Descriptor file_;
};

}  // namespace vm
