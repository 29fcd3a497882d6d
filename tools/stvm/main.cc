// stvm: the controller's command line.
#include "tools/stvm/commands.h"

int main(int argc, char** argv) {
  const tools::Entry* const entries[] = {
      &stvm::kRun,   &stvm::kBench,  &stvm::kServe,   &stvm::kStatus,  &stvm::kGet,
      &stvm::kSet,   &stvm::kForce,  &stvm::kUnforce, &stvm::kWatch,   &stvm::kChange,
      &stvm::kUndo,  &stvm::kRevert, &stvm::kAccept,  &stvm::kAbort,   &stvm::kStop,
      &stvm::kRestart, &stvm::kJournal, &stvm::kSource,
      &stvm::kImage, &stvm::kBridge, &stvm::kReplay,  &stvm::kTop,     &stvm::kDoctor};
  return tools::dispatch("stvm", "Runs images of stc, and changes them while they run.", entries,
                         argc, argv);
}
