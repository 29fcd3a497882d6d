// A program in IR text, run by the evaluator and by the interpreter side by side: after every scan
// both must have the same trap and the same state.
#pragma once

#include <gtest/gtest.h>

#include <cstring>
#include <memory>
#include <string>
#include <string_view>

#include "ir/bytecode/symbols.h"
#include "ir/program/evaluate.h"
#include "tests/unit/linker/linked.h"
#include "vm/exec/execution.h"
#include "vm/exec/memory.h"

namespace references {

class Rig {
 public:
  explicit Rig(std::string_view text)
      : program_(linker::parsed(text)),
        image_(linker::linked(text)),
        memory_(std::move(vm::Memory::reserve()).value()),
        execution_(image_.call_depth),
        evaluator_(program_, eval_memory()) {
    auto verified = ir::verify(ir::encode(image_));
    if (!verified.ok()) return;
    for (const ir::DataRun& run : image_.data) {
      std::memcpy(memory_.data() + run.offset, run.bytes.data(), run.bytes.size());
    }
    generation_ = vm::Generation::build(*verified, 0, memory_.data());
  }

  // The trap, "" without one.
  std::string scan() {
    EXPECT_NE(generation_, nullptr);
    if (generation_ == nullptr) return "no image";
    const std::string oracle = evaluate();
    const std::string trap = execute();
    EXPECT_EQ(oracle, trap);
    EXPECT_EQ(evaluator_.state(), ir::state_text(image_, memory_.view()));
    return trap;
  }

  std::string value(std::string_view path) const {
    const auto symbol = ir::find_symbol(image_, path);
    return symbol ? ir::format_value(image_, *symbol, memory_.view()) : symbol.error().text;
  }
  const ir::Image& image() const { return image_; }
  vm::Execution& execution() { return execution_; }

 private:
  ir::EvalMemory eval_memory() const {
    ir::EvalMemory memory{image_.layouts, {}};
    for (uint32_t id = 0; id < image_.instances.size(); ++id) {
      const ir::Instance& row = image_.instances[id];
      if (row.live)
        memory.areas.push_back({image_.instance_path(id), id, row.generation, row.data});
    }
    return memory;
  }

  std::string evaluate() {
    const std::vector<ir::EvalTrap> traps = evaluator_.scan(0, 50'000'000);
    if (traps.empty()) return "";
    return std::string(ir::trap_name(traps[0].kind)) + " " + traps[0].pou + ":" +
           std::to_string(traps[0].line);
  }

  // Suspended at every safe point, so that exposures and calls survive that.
  std::string execute() {
    execution_.start(*generation_, memory_.data(), image_.program_ids()[0], ir::kStackBegin, 0);
    vm::Exit exit = vm::Exit::kSuspended;
    while (exit == vm::Exit::kSuspended) exit = execution_.run(1);
    if (exit == vm::Exit::kDone) return "";
    const vm::TrapText text = vm::describe(image_, execution_.trap());
    return std::string(ir::trap_name(execution_.trap().kind)) + " " + text.pou + ":" +
           std::to_string(text.line);
  }

  ir::Program program_;
  ir::Image image_;
  vm::Memory memory_;
  vm::Execution execution_;
  std::unique_ptr<vm::Generation> generation_;
  ir::Evaluator evaluator_;
};

// Types that the tests share, numbered from %25 on.
inline constexpr std::string_view kTypes =
    "type PInt = pointer INT\n"             // %25
    "type PByte = pointer BYTE\n"           // %26
    "type Bytes = array BYTE [0..32000]\n"  // %27
    "type PBytes = pointer Bytes\n"         // %28
    "type S10 = string 10\n"                // %29
    "type S80 = string 80\n"
    "type PS80 = pointer S80\n"
    "type Words = array WORD [0..3]\n"
    "type Motor = struct\n  member local on : BOOL\n  member local speed : INT\n"
    "  member local load : REAL\n  member local table : Words\n"
    "type PMotor = pointer Motor\n"
    "type Raw = union\n  member local real : REAL\n  member local dword : DWORD\n"
    "  member local words : Words\n  member local flag : BOOL\n  member local text : S10\n"
    "type Fb = function_block\n  member input x : INT\n  member in_out io : INT\n"
    "  member output y : INT\n"
    "type PFb = pointer Fb\n"
    "type Box = struct\n  member local a : INT\n  member local fb : Fb\n"
    "type PBox = pointer Box\n";

inline constexpr std::string_view kFbPou =
    "pou function_block Fb self Fb\n  b0:\n    v0 = load i16 self.x\n    v1 = add i16 v0, v0\n"
    "    store i16 self.y, v1\n    return\n";

// Main with the members and the body; more POUs in front.
inline std::string main_with(std::string_view members, std::string_view body,
                             std::string_view pous = "", std::string_view globals = "") {
  return linker::simple("  member global gInt : INT\n" + std::string(globals), members, kTypes,
                        std::string(kFbPou) + std::string(pous), body);
}

}  // namespace references
