// Signals end a run at the next boundary instead of killing it; nor does a file size limit kill it.
#pragma once

namespace stvm {

// A signal handler can reach a static only; this is the one in the tool.
class StopSignal {
 public:
  // For commands at a terminal: SIGINT and SIGTERM.
  static void install();
  // For whoever has outputs, which must be safe when it ends: every signal that ends a process and
  // can be caught in order stops it; those that would halt it in the middle of a plant's work
  // (SIGTSTP, SIGTTIN, SIGTTOU) are ignored.
  static void install_for_outputs();
  // Installs handlers for a service, whom no terminal may end: SIGHUP is only noted, SIGPIPE
  // ignored.
  static void install_service();
  static bool received();
  // SIGHUP has come since the last call.
  static bool take_hangup();
};

}  // namespace stvm
