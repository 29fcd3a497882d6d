// Signed files, lists of revoked keys, the stored record of them, and what agents are told, say and
// remember: decoded or refused with a reason; what is decoded is written as it was.
#include <algorithm>

#include "base/check.h"
#include "online_change/package/signed_file.h"
#include "online_change/store/trust_record.h"
#include "tools/stvm/agent_answer.h"
#include "tools/stvm/agent_memory.h"
#include "tools/stvm/memory_storage.h"

namespace {

void check_stored(base::ByteSpan bytes) {
  if (const auto keys = online_change::decode_revoked(bytes); keys.ok()) {
    base::check(std::ranges::equal(online_change::encode_revoked(*keys), bytes),
                "a list is written as it was");
  }
  if (const auto record = online_change::decode_trust(bytes)) {
    base::check(std::ranges::equal(online_change::encode(*record), bytes),
                "a record is written as it was");
  }
}

// Texts for people and names of errors come back as they are shown: so the second time is compared.
template <class T, class Decode>
void check_twice(const base::Result<T>& message, Decode&& decode) {
  if (!message.ok()) {
    base::check(!message.error().text.empty(), "a reason");
    return;
  }
  const base::Bytes once = stvm::encode(*message);
  const auto again = decode(once);
  base::check(again.ok() && stvm::encode(*again) == once, "it is written as it was read");
}

void check_agents(base::ByteSpan bytes) {
  const auto order = stvm::decode_agent_order(bytes);
  if (order.ok()) {
    base::check(std::ranges::equal(stvm::encode(*order), bytes), "an order is written as it was");
  }
  check_twice(stvm::decode_agent_about(bytes), stvm::decode_agent_about);
  check_twice(stvm::decode_agent_answer(bytes), stvm::decode_agent_answer);
}

constexpr const char* kMemoryFile = "order";

void store(vm::Storage& storage, base::ByteSpan bytes) {
  const vm::Storage::Piece pieces[] = {{0, bytes}};
  base::check(storage.replace(kMemoryFile, bytes.size(), pieces).ok(), "it is stored");
}

// The file of an agent's memory, and the content of one whose hash is right.
void check_memory(base::ByteSpan bytes) {
  base::ByteWriter right;
  right.raw(base::sha256(bytes));
  right.u64(bytes.size());
  right.raw(bytes);
  for (const base::ByteSpan file : {bytes, base::ByteSpan(right.bytes())}) {
    stvm::MemoryStorage storage;
    store(storage, file);
    stvm::AgentMemory memory(storage);
    memory.read();
    const base::Bytes order = memory.order();
    const base::Bytes answer = memory.answer();
    if (order.empty()) continue;
    base::check(memory.begin(order).ok() && memory.end(answer).ok(), "it is stored");
    stvm::AgentMemory again(storage);
    again.read();
    base::check(again.order() == order && again.answer() == answer, "it is remembered");
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const base::ByteSpan bytes(data, size);
  check_stored(bytes);
  check_agents(bytes);
  check_memory(bytes);
  base::Bytes content(bytes.begin(), bytes.end());
  const auto file = online_change::open_signed(content);
  if (!file.ok()) {
    base::check(!file.error().text.empty(), "a reason");
    base::check(std::ranges::equal(content, bytes), "what was not opened is as it was");
    return 0;
  }
  const base::Bytes again = online_change::encode(file->statement, file->signature, content);
  base::check(std::ranges::equal(again, bytes), "the same file comes back");
  base::check(file->message == online_change::message_of(file->statement),
              "what is signed is what was read");
  check_stored(content);
  check_agents(content);
  return 0;
}
