// What another program writes to its standard error, on ours: a machine at the other end of ssh may
// be hostile, and its bytes would move the cursor or colour the terminal (base/visible_text.h).
#pragma once

#include <memory>
#include <string>
#include <thread>

#include "base/result.h"

namespace tools {

class VisibleErrors {
 public:
  static base::Result<std::unique_ptr<VisibleErrors>> make();
  VisibleErrors() = default;
  VisibleErrors(const VisibleErrors&) = delete;
  VisibleErrors& operator=(const VisibleErrors&) = delete;
  // Shows what has come, and waits for nobody: somebody may have left a process with our pipe.
  ~VisibleErrors();

  int for_child() const { return in_; }  // its standard error
  void started();                        // the child has it

 private:
  void run();
  bool take();  // false: there is nothing to read
  void show(size_t size);

  int in_ = -1;
  int out_ = -1;
  int stop_[2] = {-1, -1};
  std::string waits_;  // for the end of its line
  std::thread thread_;
};

}  // namespace tools
