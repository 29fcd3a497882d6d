// SIGINT and SIGTERM end a run at the next boundary instead of killing it; nor does a
// file size limit kill it.
#pragma once

namespace stvm {

// A signal handler can reach a static only; this is the one in the tool.
class StopSignal {
 public:
  static void install();
  static bool received();
};

}  // namespace stvm
