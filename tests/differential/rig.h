// A controller on virtual time without devices, its variables by path, and online changes of it.
#pragma once

#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "base/result.h"
#include "ir/bytecode/symbols.h"
#include "online_change/apply/change.h"
#include "tests/golden/runner/compile.h"
#include "vm/runtime/controller.h"

namespace differential {

struct Leaf {
  ir::Symbol symbol;
  std::string type;
  std::string value;
  uint64_t bits = 0;    // of a scalar
  bool shared = false;  // inside a union
};
using Leaves = std::map<std::string, Leaf>;

class Rig {
 public:
  static base::Result<std::unique_ptr<Rig>> start(
      const golden::Program& program,
      online_change::Strategy strategy = online_change::Strategy::kInPlace);

  std::string scan();  // the trap as text, or ""
  // Everything before the switch; the program may run on in between.
  base::Status arm(const golden::Program& next);
  base::Status make_switch();
  base::Status undo();
  const online_change::Plan& plan() const { return change_->plan(); }
  Leaves leaves() const;
  std::vector<Leaf> structures() const;  // outer ones first; `type` is the path
  std::string state() const;
  // As in ir::ConstValue.
  uint64_t scalar_bits(const Leaf& leaf) const;
  std::span<const uint8_t> bytes(const Leaf& leaf) const;
  const ir::Image& image() const { return controller_->image(); }

 private:
  class Clock : public vm::Clock {
   public:
    int64_t now_ns() override { return now_ns_; }
    void wait_until(int64_t deadline_ns) override { now_ns_ = std::max(now_ns_, deadline_ns); }
    void consumed(uint64_t) override {}
    void worked(int64_t) override {}

   private:
    int64_t now_ns_ = 0;
  };
  class Devices : public vm::IoPort {
   public:
    void receive(std::span<uint8_t>) override {}
    void send(std::span<const uint8_t>) override {}
  };

  Clock clock_;
  Devices devices_;
  std::unique_ptr<vm::Controller> controller_;
  std::unique_ptr<online_change::Change> change_;
  online_change::Strategy strategy_ = online_change::Strategy::kInPlace;
};

}  // namespace differential
