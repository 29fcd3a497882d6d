// stvm: the controller's command line.
#include "tools/common/refusal_text.h"
#include "tools/stvm/commands.h"
#include "vm/native/available.h"
#include "vm/runtime/protocol_version.h"

namespace {

std::vector<std::string> adapters() {
  return {
#ifdef STC_HAS_MODBUS
      "modbus",
#endif
#ifdef STC_HAS_KEYS
      "keys",
#endif
  };
}

}  // namespace

int main(int argc, char** argv) {
  const tools::Entry* const entries[] = {
#define VERB(entry) &stvm::entry,
#include "tools/stvm/verbs.def"
#undef VERB
  };
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
