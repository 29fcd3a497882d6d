// stvm: the controller's command line.
#include "tools/common/refusal_text.h"
#include "tools/stvm/commands.h"
#include "vm/native/program.h"
#include "vm/runtime/protocol.h"

namespace {

std::vector<std::string> adapters() {
#ifdef STC_HAS_MODBUS
  return {"modbus"};
#else
  return {};
#endif
}

}  // namespace

int main(int argc, char** argv) {
  const tools::Entry* const entries[] = {
      &stvm::kRun,    &stvm::kBench, &stvm::kServe,   &stvm::kStatus,  &stvm::kGet,
      &stvm::kSet,    &stvm::kForce, &stvm::kUnforce, &stvm::kWatch,   &stvm::kChange,
      &stvm::kEdits,  &stvm::kUndo,  &stvm::kRedo,    &stvm::kRevert,  &stvm::kAccept,
      &stvm::kAbort,  &stvm::kStop,  &stvm::kRestart, &stvm::kJournal, &stvm::kEvents,
      &stvm::kFleet,  &stvm::kSource, &stvm::kImage,  &stvm::kBridge,  &stvm::kReplay,
      &stvm::kTop,    &stvm::kDoctor};
  const tools::Tool tool{
      "stvm",
      "Runs images of stc, and changes them while they run.",
      entries,
      {tools::image_formats(),
       {"protocol", tools::VersionFact::kNumber, {std::to_string(vm::kProtocolVersion)}},
       {"adapters", tools::VersionFact::kTexts, adapters()},
       tools::native_tier(vm::native::is_available())},
      {},
      {{"json", tools::refusal_json}}};
  return tools::dispatch(tool, argc, argv);
}
