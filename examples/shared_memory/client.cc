// A process beside the controller: every 5 ms it reads the outputs from shared memory and answers
// with inputs, here a tank that fills while the pump runs. usage: shared_memory_client NAME CYCLES
//
// Needs nothing of the controller but vm/io/shared_memory.h.
#include "vm/io/shared_memory.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>

namespace {

uint64_t now_ns() {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return static_cast<uint64_t>(now.tv_sec) * 1'000'000'000 + static_cast<uint64_t>(now.tv_nsec);
}

// The controller makes it; until then there is none.
uint8_t* open_memory(const char* name) {
  for (int attempt = 0; attempt < 1000; ++attempt, usleep(5000)) {
    const int file = shm_open(name, O_RDWR, 0);
    struct stat facts {};
    if (file < 0) continue;
    void* memory = MAP_FAILED;
    if (fstat(file, &facts) == 0 && facts.st_size > 0) {
      memory = mmap(nullptr, static_cast<size_t>(facts.st_size), PROT_READ | PROT_WRITE, MAP_SHARED,
                    file, 0);
    }
    close(file);
    if (memory == MAP_FAILED) continue;
    const auto* header = static_cast<const vm::SharedHeader*>(memory);
    if (header->magic == vm::kSharedMagic) return static_cast<uint8_t*>(memory);
    munmap(memory, static_cast<size_t>(facts.st_size));
  }
  return nullptr;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fprintf(stderr, "usage: shared_memory_client NAME CYCLES\n");
    return 2;
  }
  uint8_t* memory = open_memory(argv[1]);
  if (memory == nullptr) {
    std::fprintf(stderr, "no controller has made %s\n", argv[1]);
    return 1;
  }
  const auto* header = reinterpret_cast<const vm::SharedHeader*>(memory);
  auto* inputs = reinterpret_cast<vm::SharedBlock*>(memory + header->header_bytes);
  auto* outputs = reinterpret_cast<vm::SharedBlock*>(memory + header->header_bytes +
                                                     vm::shared_block_size(header->input_bytes));
  int16_t level = 0;
  uint8_t bytes[2] = {};
  for (int cycle = std::atoi(argv[2]); cycle > 0; --cycle, usleep(5000)) {
    uint64_t written_ns = 0;
    while (!vm::shared_read(outputs, bytes, 1, written_ns)) {
    }
    const bool pump = written_ns != 0 && (bytes[0] & 1) != 0;
    if (pump && level < 1000) level = static_cast<int16_t>(level + 10);
    if (!pump && level > 0) level = static_cast<int16_t>(level - 5);
    std::memcpy(bytes, &level, sizeof level);
    vm::shared_write(inputs, bytes, sizeof bytes, now_ns());
  }
  return 0;
}
