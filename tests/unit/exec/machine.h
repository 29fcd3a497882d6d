// A machine for tests: one verified image, its memory, one execution of program Main.
#pragma once

#include <gtest/gtest.h>

#include <cstring>
#include <memory>
#include <string>

#include "ir/bytecode/symbols.h"
#include "ir/bytecode/verify.h"
#include "tests/unit/bytecode/sample_image.h"
#include "vm/exec/execution.h"
#include "vm/exec/memory.h"

namespace sample {

class Machine {
 public:
  explicit Machine(const ir::Image& image, const vm::TierOptions& tier = {})
      : memory_(std::move(vm::Memory::reserve()).value()), execution_(image.call_depth) {
    auto verified = ir::verify(ir::encode(image));
    EXPECT_TRUE(verified.ok()) << (verified.ok() ? "" : base::to_string(verified.error()));
    if (!verified.ok()) return;
    for (const ir::DataRun& run : image.data) {
      std::memcpy(memory_.data() + run.offset, run.bytes.data(), run.bytes.size());
    }
    generation_ = vm::Generation::build(*verified, 0, memory_.data(), tier);
  }
  bool good() const { return generation_ != nullptr; }
  uint8_t* data() { return memory_.data(); }
  vm::Execution& execution() { return execution_; }
  const vm::Generation& generation() const { return *generation_; }
  const ir::Image& image() const { return generation_->image(); }

  void start(int64_t time_ns = 0) {
    execution_.start(*generation_, memory_.data(), kMainInstance, ir::kStackBegin, time_ns);
  }
  vm::Exit scan(uint64_t fuel = 1'000'000, int64_t time_ns = 0) {
    if (!good()) return vm::Exit::kTrap;
    start(time_ns);
    return execution_.run(fuel);
  }
  template <class T>
  T main(uint32_t offset) const {  // a variable of Main
    T value;
    std::memcpy(&value, memory_.data() + kMainData + offset, sizeof value);
    return value;
  }
  template <class T>
  void set_main(uint32_t offset, T value) {
    std::memcpy(memory_.data() + kMainData + offset, &value, sizeof value);
  }
  std::string value(std::string_view path) const {
    const auto symbol = ir::find_symbol(image(), path);
    return symbol ? ir::format_value(image(), *symbol, memory_.view()) : symbol.error().text;
  }
  std::string state() const { return ir::state_text(image(), memory_.view()); }
  std::string trap_text() const { return vm::describe(image(), execution_.trap()).text; }

 private:
  vm::Memory memory_;
  vm::Execution execution_;
  std::unique_ptr<vm::Generation> generation_;
};

}  // namespace sample
