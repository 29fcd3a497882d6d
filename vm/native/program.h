// Machine code of a generation's POUs, made when the generation is built and immutable from then
// on. What the native tier has no code for is interpreted, and says why.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "ir/bytecode/pou_version.h"
#include "vm/exec/tier.h"
#include "vm/native/available.h"

namespace vm {
struct CodeTable;
struct Context;
struct PouEntry;
}  // namespace vm

namespace vm::native {

class CodeMemory;
struct PouNative;

// How far a Program is that is made while others look.
struct Progress {
  std::atomic<bool> stop = false;  // no more POUs: those that are not done are interpreted
  std::atomic<bool> unwanted = false;  // with `stop`: nor what is done
  std::atomic<uint32_t> pous = 0;  // are done
  std::shared_ptr<const CodeTable> stopped;  // what had been made by then, for another one to share
};

class Program {
  struct Key {};

 public:
  explicit Program(Key) {}
  ~Program();
  // Sets entry and machine of `pous`. Code of `running` that is still right is shared; with the
  // image that it is of, made without `versions` and with the same `clean_bools`, it is not looked
  // at what is the same there. Null when everything is interpreted.
  // `versions`: code that stands for that of the image, sorted by POU (forced_code.h).
  // `clean_bools`: BOOLs of the image are 0 or 1 wherever they lie (ir/bytecode/bools.h).
  static std::shared_ptr<const Program> make(const ir::Image& image, bool clean_bools,
                                             std::vector<PouEntry>& pous,
                                             const TierOptions& options, const Program* running,
                                             std::span<const ir::PouVersion> versions = {},
                                             Progress* progress = nullptr,
                                             const ir::Image* running_image = nullptr);

  // Runs machine code. True: its POU returned, and the caller's record is on top; else the Context
  // says where the interpreter goes on, or that it has stopped.
  bool enter(const void* code, uint8_t* frame, uint8_t* self, uint8_t* memory, Context* ctx) const {
    using Enter = uint64_t (*)(const void*, uint8_t*, uint8_t*, uint8_t*, Context*);
    const auto go = reinterpret_cast<Enter>(reinterpret_cast<uintptr_t>(enter_));
    return go(code, frame, self, memory + (uint64_t{1} << 31), ctx) == 0;
  }
  // Where to go on at `unit` of POU number `pou`: a side unit when it is an entry of machine code.
  const ir::Unit* entry(uint32_t pou, const ir::Unit* unit) const;
  // The POU's own unit that a side unit stands for.
  const ir::Unit* real_unit(uint32_t pou, const ir::Unit* unit) const;

  // The size of all memory that its POUs' code lies in, with what earlier versions have there.
  uint64_t code_bytes() const { return code_bytes_; }
  uint32_t native_pous() const;
  // Why the POU is interpreted; "" when it is not.
  const std::string& reason(uint32_t pou) const;

 private:
  std::vector<std::shared_ptr<const PouNative>> pous_;
  std::shared_ptr<const CodeMemory> shared_code_;
  const void* enter_ = nullptr;
  uint64_t code_bytes_ = 0;
};

}  // namespace vm::native
