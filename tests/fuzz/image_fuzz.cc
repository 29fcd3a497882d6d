// Images that somebody has tampered with and hashed anew: the verifier refuses them, or
// the machine runs 100 scans, and 10 with variables forced, without touching memory that the image
// does not declare.
//
// An input is either stored bytes (those that begin like an image), whose length and hash
// are put right, or a script of changes to a good image: 6 bytes {what, where, value} each.
#include <sys/mman.h>
#include <unistd.h>

#include <cstdint>
#include <cstring>
#include <functional>
#include <optional>
#include <vector>

#include "base/check.h"
#include "base/limits.h"
#include "ir/bytecode/symbols.h"
#include "ir/bytecode/verify.h"
#include "tests/fuzz/image_changes.h"
#include "tests/unit/bytecode/sample_objects.h"
#include "vm/exec/execution.h"
#include "vm/exec/memory.h"
#include "vm/load/forced_code.h"

namespace {

constexpr uint64_t kFuelOfAScan = 200;
constexpr uint64_t kMaxPages = 64 * 1024;  // images that declare more memory are not run

// Of two images; the first byte's upper half says which.
base::Bytes scripted(const uint8_t* data, size_t size) {
  const bool objects = size != 0 && (data[0] & 0x10) != 0;
  ir::Image image = objects ? sample::busy_object_image() : sample::busy_image();
  for (size_t at = 0; at + 6 <= size && at < 6 * 8; at += 6) {
    fuzz::Change change{data[at], 0, 0, data[at + 5]};
    std::memcpy(&change.where, data + at + 1, 2);
    std::memcpy(&change.value, data + at + 3, 2);
    fuzz::apply(image, change);
  }
  return ir::encode(image);
}

// Stored bytes with the header as it must be.
base::Bytes repaired(const uint8_t* data, size_t size) {
  base::Bytes bytes(data, data + size);
  const base::Bytes good = ir::encode(ir::Image{});
  const auto length = static_cast<uint32_t>(size);
  std::memcpy(bytes.data(), good.data(), 12);
  std::memcpy(bytes.data() + 12, &length, 4);
  const base::Digest digest = base::sha256(base::ByteSpan(bytes).subspan(48));
  std::memcpy(bytes.data() + 16, digest.data(), digest.size());
  return bytes;
}

// --- running ----------------------------------------------------------------------

uint64_t pages(uint64_t bytes) { return (bytes + 4095) / 4096; }

// Only pages of what the image declares may ever have been touched.
void check_untouched(vm::Memory& memory, uint64_t begin, uint64_t end) {
  constexpr uint64_t kChunk = uint64_t{1} << 28;
  static std::vector<unsigned char> resident(kChunk / 4096);
  for (uint64_t at = pages(begin) * 4096; at < end; at += kChunk) {
    const uint64_t size = std::min(kChunk, end - at);
    base::check(mincore(memory.data() + at, size, resident.data()) == 0, "mincore");
    base::check(std::memchr(resident.data(), 1, pages(size)) == nullptr,
                "memory outside of what the image declares is untouched");
  }
}

void check_memory(vm::Memory& memory, const ir::Image& image) {
  for (uint32_t i = 0; i < ir::kDataBegin; ++i) {
    base::check(memory.data()[i] == 0, "the first bytes are untouched");
  }
  base::check(image.pool.empty() || std::memcmp(memory.data() + ir::kConstPoolA, image.pool.data(),
                                                image.pool.size()) == 0,
              "constants are as they were");
  check_untouched(memory, image.data_capacity, ir::kConstPoolA);
  check_untouched(memory, ir::kConstPoolA + image.pool.size(), ir::kStackBegin);
  check_untouched(memory, uint64_t{ir::kStackBegin} + image.stack_bytes, uint64_t{1} << 32);
}

void run(const vm::Generation& generation, const vm::CodeTable& code, vm::Memory& memory,
         int scans) {
  const ir::Image& image = generation.image();
  vm::Execution execution(image.call_depth, 0, generation.try_depth());
  for (int scan = 0; scan < scans; ++scan) {
    for (const ir::ImageTask& task : image.tasks) {
      for (uint32_t program : task.programs) {
        execution.start(generation, code, memory.data(), program, ir::kStackBegin, scan);
        if (execution.run(kFuelOfAScan) == vm::Exit::kTrap) {
          base::check(!vm::describe(image, execution.trap()).text.empty(), "a trap has a text");
        }
      }
    }
  }
}

// Some variables have the values of other moments.
std::vector<vm::ForcedVariable> forced_variables(const ir::Image& image, vm::Memory& memory) {
  std::vector<vm::ForcedVariable> out;
  uint32_t count = 0;
  ir::for_each_leaf(image, [&](const std::string&, const ir::Symbol& symbol) {
    if (symbol.constant || count++ % 3 != 0) return;
    const uint32_t size = image.layouts[symbol.type].size;
    const uint8_t* const at = memory.data() + symbol.data;
    out.push_back({{symbol.data, size, symbol.type}, base::Bytes(at, at + size)});
  });
  return out;
}

void run_scans(const ir::VerifiedImage& verified, bool look_at_pages) {
  const ir::Image& image = verified.image();
  if (pages(image.data_capacity) > kMaxPages) return;
  vm::Memory memory = std::move(vm::Memory::reserve()).value();
  for (const ir::DataRun& run : image.data) {
    if (!run.bytes.empty()) {
      std::memcpy(memory.data() + run.offset, run.bytes.data(), run.bytes.size());
    }
  }
  const auto generation = vm::Generation::build(verified, 0, memory.data());
  run(*generation, *generation->code(), memory, 1);
  const std::vector<vm::ForcedVariable> variables = forced_variables(image, memory);
  run(*generation, *generation->code(), memory, 99);
  const auto forced = vm::ForcedCode::make(verified, *generation->code(), variables, {});
  if (forced != nullptr) run(*generation, forced->table(), memory, 10);
  ir::state_hash(image, memory.view());
  if (look_at_pages) check_memory(memory, image);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const bool stored = size >= 48 && std::memcmp(data, "STCIMAGE", 8) == 0;
  const base::Bytes bytes = stored ? repaired(data, size) : scripted(data, size);
  const auto verified = ir::verify(bytes);
  static uint64_t accepted = 0;
  if (verified.ok()) run_scans(*verified, ++accepted % 16 == 1);
  return 0;
}
