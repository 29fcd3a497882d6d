// The plain method of exchanging a program, as a baseline for measurements only (A18): at the
// boundary all values are saved, the program is switched, and all values are restored by name.
// What can be done beforehand is: names are looked up, memory is allocated, code is prepared.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "vm/runtime/controller.h"

namespace bench {

class PlainMethod {
 public:
  PlainMethod(vm::Controller& controller, const ir::VerifiedImage& next);
  // At a boundary; takes this long.
  int64_t make_switch();

 private:
  struct Value {  // a variable that both versions have
    ir::Symbol from;
    ir::Symbol to;
    uint32_t size = 0;  // in the old version
    size_t at = 0;      // in saved_
    bool same_type = false;
  };
  void save();
  void restore();

  vm::Controller& controller_;
  ir::VerifiedImage old_;
  ir::VerifiedImage next_;
  std::unique_ptr<vm::Generation> prepared_;
  std::vector<Value> values_;
  std::vector<uint8_t> saved_;
};

}  // namespace bench
