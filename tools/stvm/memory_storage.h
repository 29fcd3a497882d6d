// Files in memory, for runs that leave nothing behind.
#pragma once

#include <map>

#include "vm/runtime/ports.h"

namespace stvm {

class MemoryStorage : public vm::Storage {
 public:
  base::Status open(std::string_view name, uint64_t size) override;
  base::Result<uint64_t> size(std::string_view name) override;
  base::Result<base::Bytes> read(std::string_view name, uint64_t offset, uint64_t size) override;
  base::Status write(std::string_view name, uint64_t offset, base::ByteSpan bytes) override;
  base::Status sync(std::string_view) override { return base::Ok{}; }
  base::Status replace(std::string_view name, uint64_t size,
                       std::span<const Piece> pieces) override;
  base::Status check(std::string_view) override { return base::Ok{}; }

 private:
  std::map<std::string, base::Bytes, std::less<>> files_;
};

}  // namespace stvm
