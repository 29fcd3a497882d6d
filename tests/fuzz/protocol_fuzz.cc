// The control channel with any bytes: requests, answers, and what a client makes of a controller
// that answers what it likes.
//
// An input is {what, bytes}: a request, or the answer of each request of one call.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>

#include "base/check.h"
#include "tools/stvm/controller_client.h"
#include "tools/stvm/event_text.h"
#include "vm/runtime/protocol.h"

namespace {

class Anything : public vm::Transport {
 public:
  explicit Anything(base::ByteSpan answer) : answer_(answer.begin(), answer.end()) {}
  base::Result<base::Bytes> exchange(base::ByteSpan) override { return answer_; }

 private:
  base::Bytes answer_;
};

// Pages that never end are an error, so each call comes back.
void ask_everything(base::ByteSpan answer) {
  stvm::ControllerClient client(std::make_unique<Anything>(answer));
  if (auto events = client.events(0); events.ok()) (void)stvm::events_json(*events);
  (void)client.status().ok();
  (void)client.get({"a"}).ok();
  (void)client.list("*").ok();
  (void)client.forces().ok();
  (void)client.journal().ok();
  (void)client.units().ok();
  (void)client.edits().ok();
  (void)client.fates().ok();
  (void)client.image_before().ok();
  (void)client.task_times("T").ok();
}

void check_request(base::ByteSpan bytes) {
  const base::Result<vm::Request> request = vm::decode_request(bytes);
  if (!request.ok()) return;
  base::Bytes again = encode(*request);
  if (bytes[0] > vm::kProtocolVersion) again.resize(std::max(again.size(), bytes.size()));
  again[0] = bytes[0];
  base::check(again == base::Bytes(bytes.begin(), bytes.end()), "a request is exact");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  if (size == 0) return 0;
  const base::ByteSpan input(data + 1, size - 1);
  switch (data[0] % 3) {
    case 0:
      check_request(input);
      break;
    case 1:
      ask_everything(input);
      break;
    default:
      ask_everything(vm::encode_answer(input));
  }
  return 0;
}
