// stvm abort: ends a change that is being prepared, whoever brings it.
#include <cstdio>

#include "base/visible_text.h"
#include "tools/common/exit.h"
#include "tools/common/json.h"
#include "tools/stvm/commands.h"
#include "tools/stvm/controller_client.h"

namespace stvm {
namespace {

constexpr tools::OptionRow kAbortOptions[] = {STVM_CONTROLLER_OPTIONS, STVM_FORMAT_OPTION};
constexpr tools::Command kAbortCommand{
    "abort",       "", "Ends a change that is being prepared, at once; the program runs on.",
    kAbortOptions, 0,  0};

// One question and nothing before it: the controller answers it in the middle of what it does.
base::Status abort(const tools::Options& options) {
  const bool json = wants_json(options);
  base::Result<ControllerClient> client = ControllerClient::connect(options);
  if (!client.ok()) return client.error();
  base::Result<base::Bytes> body = client->call({.command = vm::Command::kAbort});
  if (!body.ok()) return body.error();
  base::Result<vm::AbortAnswer> answer = vm::decode_abort_answer(*body);
  if (!answer.ok()) return answer.error();
  if (json) {
    tools::JsonWriter out;
    out.begin_object().field("aborted", answer->done).field("text", answer->text).end_object();
    std::fputs(out.finish().c_str(), stdout);
  } else {
    std::printf("%s\n", answer->text.c_str());
  }
  return base::Ok{};
}

int run_abort(const tools::Options& options) {
  base::Status done = abort(options);
  return done.ok() ? tools::kOk : refuse(done.error());
}

}  // namespace

const Entry kAbort{&kAbortCommand, run_abort};

}  // namespace stvm
