// Memory for machine code: written once, then executable and never writable again.
#pragma once

#include <cstdint>
#include <memory>
#include <span>

namespace vm::native {

class CodeMemory {
  struct Key {};

 public:
  CodeMemory(Key, uint8_t* data, size_t size) : data_(data), size_(size) {}
  // Null when the system gives none.
  static std::shared_ptr<const CodeMemory> make(std::span<const uint8_t> code);
  ~CodeMemory();
  CodeMemory(const CodeMemory&) = delete;
  CodeMemory& operator=(const CodeMemory&) = delete;

  const uint8_t* data() const { return data_; }
  size_t size() const { return size_; }

 private:
  uint8_t* data_ = nullptr;
  size_t size_ = 0;
};

}  // namespace vm::native
