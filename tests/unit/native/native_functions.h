// Functions of one block for tests, and running them as machine code of this machine.
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "vm/exec/context.h"
#include "vm/native/code_memory.h"
#include "vm/native/host.h"

namespace vm::native {

class FunctionMaker {
 public:
  explicit FunctionMaker(uint32_t blocks = 1) { f_.blocks.resize(blocks); }
  Function& function() { return f_; }

  Val append(Node node, uint8_t width, bool floating = false) {
    node.result = static_cast<Val>(f_.values.size());
    f_.values.push_back({floating, width, false, 0, static_cast<uint32_t>(f_.nodes.size()), 0});
    f_.blocks[0].nodes.push_back(static_cast<uint32_t>(f_.nodes.size()));
    f_.nodes.push_back(node);
    return node.result;
  }
  // Of the frame.
  Val load(int64_t at, uint8_t width, bool floating = false) {
    Node node;
    node.op = Op::kLoad;
    node.width = width;
    node.mem.disp = at;
    return append(node, width, floating);
  }
  Val constant(uint64_t bits, uint8_t width, bool floating = false) {
    f_.values.push_back({floating, width, true, bits, kNone, 0});
    return static_cast<Val>(f_.values.size() - 1);
  }
  void store(int64_t at, Val v, uint8_t width, Block block = 0) {
    Node node;
    node.op = Op::kStore;
    node.width = width;
    node.in[0] = v;
    node.mem.disp = at;
    f_.blocks[block].nodes.push_back(static_cast<uint32_t>(f_.nodes.size()));
    f_.nodes.push_back(node);
  }
  void end(Block block = 0) {
    f_.blocks[block].end.exit = static_cast<uint32_t>(f_.exits.size());
    f_.exits.emplace_back();
  }
  // frame[16] := a cond b
  void branch(Op compare, Cond cond, uint8_t width, Val a, Val b) {
    End& e = f_.blocks[0].end;
    e.kind = EndKind::kBranch;
    e.compare = compare;
    e.cond = cond;
    e.width = width;
    e.in[0] = a;
    e.in[1] = b;
    e.target[0] = 1;
    e.target[1] = 2;
    store(16, constant(1, 1), 1, 1);
    store(16, constant(0, 1), 1, 2);
    end(1);
    end(2);
  }

 private:
  Function f_;
};

class NativeFunctions {
 public:
  // `folds`: operations read memory themselves where this machine can.
  explicit NativeFunctions(bool folds = false) : shared_(host::emit_shared(a_)), folds_(folds) {
    context_.call = &record_;
  }

  uint32_t add(Function function, bool plain = false) {
    if (folds_) fold_loads(function, host::HostTarget());
    const base::Result<Allocated> places = allocate(function, host::HostTarget(), {});
    EXPECT_TRUE(places.ok());
    const SideUnits side;
    begins_.push_back(
        host::Emitter({&function, &*places, &side, nullptr, 0, plain}, shared_, a_).run().begin);
    return static_cast<uint32_t>(begins_.size() - 1);
  }
  // Before the first one runs.
  void finish() {
    a_.patch();
    code_ = CodeMemory::make(a_.code());
  }
  void run(uint32_t function, void* frame) {
    using Enter = uint64_t (*)(const void*, uint8_t*, uint8_t*, uint8_t*, Context*);
    const auto enter = reinterpret_cast<Enter>(
        reinterpret_cast<uintptr_t>(code_->data() + a_.offset_of(shared_.enter)));
    enter(code_->data() + begins_[function], static_cast<uint8_t*>(frame), nullptr, nullptr,
          &context_);
  }

 private:
  host::Assembler a_;
  Shared shared_;
  bool folds_;
  std::vector<uint32_t> begins_;
  std::shared_ptr<const CodeMemory> code_;
  CallRecord record_;
  Context context_;
};

}  // namespace vm::native
