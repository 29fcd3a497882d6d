#include "vm/native/code_memory.h"

#include <sys/mman.h>

#include <cstring>

namespace vm::native {

std::shared_ptr<const CodeMemory> CodeMemory::make(std::span<const uint8_t> code) {
  if (code.empty()) return nullptr;
  void* const at =
      mmap(nullptr, code.size(), PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (at == MAP_FAILED) return nullptr;
  std::memcpy(at, code.data(), code.size());
  if (mprotect(at, code.size(), PROT_READ | PROT_EXEC) != 0) {
    munmap(at, code.size());
    return nullptr;
  }
  __builtin___clear_cache(static_cast<char*>(at), static_cast<char*>(at) + code.size());
  return std::make_shared<const CodeMemory>(Key(), static_cast<uint8_t*>(at), code.size());
}

CodeMemory::~CodeMemory() { munmap(data_, size_); }

}  // namespace vm::native
