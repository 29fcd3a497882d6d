// The control channel with any bytes: requests, answers, and what a client makes of a controller
// that answers what it likes.
//
// An input is {what, bytes}: a request, the answer of each request of one call, the conditions of a
// trial (X6-03) as a tool sends them, one as people write it, the file of a plan (X6-02), the body
// of one answer, or what `stvm change --watch` and the stc that it starts say to each other.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "base/check.h"
#include "tools/common/followed_change.h"
#include "tools/stvm/condition_parse.h"
#include "tools/stvm/controller_client.h"
#include "tools/stvm/event_text.h"
#include "tools/stvm/fleet_plan.h"
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
  (void)client.facts().ok();
  (void)client.every_fate().ok();
  (void)client.stage({}, 0).ok();
  (void)client.make_switch(0).ok();
  (void)client.undo().ok();
}

// Messages grow at their ends, so what is read is written as this version has it.
template <class T, class Decode>
void check_body(const base::Result<T>& body, Decode&& decode) {
  using stvm::encode;  // of a report, too
  using vm::encode;
  if (!body.ok()) return base::check(!body.error().text.empty(), "a reason");
  const base::Bytes once = encode(*body);
  const auto again = decode(base::ByteSpan(once));
  base::check(again.ok() && encode(*again) == once, "a body is written as it was read");
}

void check_bodies(base::ByteSpan bytes) {
  check_body(stvm::decode_switch_report(bytes), stvm::decode_switch_report);
  check_body(vm::decode_abort_answer(bytes), vm::decode_abort_answer);
  check_body(vm::decode_staged_answer(bytes), vm::decode_staged_answer);
}

template <class T>
void check_followed(const base::Result<T>& message, base::ByteSpan bytes) {
  if (!message.ok()) return base::check(!message.error().text.empty(), "a reason");
  base::check(std::ranges::equal(encode(*message), bytes), "a message is exact");
}

void check_request(base::ByteSpan bytes) {
  const base::Result<vm::Request> request = vm::decode_request(bytes);
  if (!request.ok()) return;
  base::Bytes again = encode(*request);
  if (bytes[0] > vm::kProtocolVersion) again.resize(std::max(again.size(), bytes.size()));
  again[0] = bytes[0];
  base::check(again == base::Bytes(bytes.begin(), bytes.end()), "a request is exact");
}

// What is taken computes, whatever the variables are.
void compute_all(const stvm::GuardOrder& order) {
  using Value = stvm::ConditionValue;
  for (uint8_t round = 0; round < 3; ++round) {
    std::vector<stvm::ConditionVariable> variables(order.names.size());
    std::vector<Value> now(order.names.size());
    std::vector<Value> baseline(order.names.size());
    const uint8_t memory[8] = {round, 0xff, 0x7f, round, 0x80, 0xff, 0x7f, round};
    for (size_t i = 0; i < variables.size(); ++i) {
      const auto kind = static_cast<size_t>(ir::Kind::kLreal) + 1;
      variables[i].kind = static_cast<ir::Kind>((i * 7 + round * 5) % kind);
      (void)read_variable(variables[i], memory, now[i]);
      (void)read_variable(variables[i], memory, baseline[i]);
    }
    for (const stvm::Condition& condition : order.conditions) {
      if (!check_condition(condition, variables).ok()) continue;
      (void)stvm::compute(condition, now, baseline);
    }
  }
}

void check_order(base::ByteSpan bytes) {
  const base::Result<stvm::GuardOrder> order = stvm::decode_guard_order(bytes);
  if (!order.ok()) return;
  const base::Result<stvm::GuardOrder> again = stvm::decode_guard_order(encode(*order));
  base::check(again.ok() && encode(*again) == encode(*order), "an order is exact");
  compute_all(*order);
}

void check_written(base::ByteSpan bytes) {
  const std::string text(bytes.begin(), bytes.end());
  stvm::GuardOrder order;
  order.deadline_ns = 1;
  size_t at = 0;
  if (!stvm::add_condition(text, order, at).ok()) {
    base::check(at <= text.size(), "a mistake is in the text");
    return;
  }
  compute_all(order);
  base::check(stvm::decode_guard_order(encode(order)).ok(), "what was written can be sent");
}

void check_plan(base::ByteSpan bytes) {
  const auto plan = stvm::parse_plan("fuzz.plan", std::string(bytes.begin(), bytes.end()));
  if (!plan.ok()) return;
  const std::string text = plan_text(*plan);
  const auto again = stvm::parse_plan("fuzz.plan", text);
  base::check(again.ok() && plan_text(*again) == text, "a plan is written as it was read");
  constexpr int64_t kNow = 1'800'000'000'000;
  base::check(!plan_page(*plan, kNow).empty() && !plan_json(*plan, kNow).empty(), "it is shown");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  if (size == 0) return 0;
  const base::ByteSpan input(data + 1, size - 1);
  switch (data[0] % 8) {
    case 0:
      check_request(input);
      break;
    case 1:
      ask_everything(input);
      break;
    case 2:
      ask_everything(vm::encode_answer(input));
      break;
    case 3:
      check_order(input);
      break;
    case 4:
      check_written(input);
      break;
    case 5:
      check_plan(input);
      break;
    case 6:
      check_bodies(input);
      break;
    default:
      check_followed(tools::decode_followed_change(input), input);
      check_followed(tools::decode_followed_answer(input), input);
  }
  return 0;
}
