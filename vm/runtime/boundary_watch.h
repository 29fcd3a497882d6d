// What looks at the program at each boundary, on the control thread.
#pragma once

namespace vm {

class BoundaryWatch {
 public:
  virtual ~BoundaryWatch() = default;
  // After each cycle that ends at a boundary, and each call of Controller::cycle() after a fault.
  // Allocates nothing and takes little time: the next cycle waits for it.
  virtual void at_boundary() = 0;
};

}  // namespace vm
