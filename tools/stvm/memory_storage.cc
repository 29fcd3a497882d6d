#include "tools/stvm/memory_storage.h"

#include <algorithm>

namespace stvm {

base::Status MemoryStorage::open(std::string_view name, uint64_t size) {
  base::Bytes& file = files_[std::string(name)];
  file.resize(std::max<size_t>(file.size(), size));
  return base::Ok{};
}

base::Result<uint64_t> MemoryStorage::size(std::string_view name) {
  const auto file = files_.find(name);
  if (file == files_.end()) {
    return base::Error{base::Refusal::kFileNotFound, std::string(name)};
  }
  return uint64_t{file->second.size()};
}

base::Result<base::Bytes> MemoryStorage::read(std::string_view name, uint64_t offset,
                                              uint64_t size) {
  const base::Bytes& file = files_[std::string(name)];
  const uint64_t begin = std::min<uint64_t>(offset, file.size());
  const uint64_t end = begin + std::min<uint64_t>(size, file.size() - begin);
  return base::Bytes(file.begin() + static_cast<std::ptrdiff_t>(begin),
                     file.begin() + static_cast<std::ptrdiff_t>(end));
}

base::Status MemoryStorage::write(std::string_view name, uint64_t offset, base::ByteSpan bytes) {
  base::Bytes& file = files_[std::string(name)];
  if (offset + bytes.size() > file.size()) {
    return base::Error{base::Refusal::kStorageFailed, "write after the end of a file"};
  }
  std::copy(bytes.begin(), bytes.end(), file.begin() + static_cast<std::ptrdiff_t>(offset));
  return base::Ok{};
}

base::Status MemoryStorage::replace(std::string_view name, uint64_t size,
                                    std::span<const Piece> pieces) {
  files_[std::string(name)].assign(size, 0);
  for (const Piece& piece : pieces) {
    if (base::Status done = write(name, piece.offset, piece.bytes); !done.ok()) return done;
  }
  return base::Ok{};
}

}  // namespace stvm
