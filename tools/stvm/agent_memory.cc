#include "tools/stvm/agent_memory.h"

#include "base/archive.h"
#include "tools/stvm/agent_order.h"

namespace stvm {
namespace {

constexpr const char* kMemoryFile = "order";
constexpr uint64_t kMostStored = 16u << 20;
constexpr size_t kHeadBytes = sizeof(base::Digest) + sizeof(uint64_t);

}  // namespace

// A file may be longer than what is in it: storage has sectors.
void AgentMemory::read() {
  const base::Result<uint64_t> size = storage_.size(kMemoryFile);
  if (!size.ok() || *size > kMostStored) return;
  const base::Result<base::Bytes> bytes = storage_.read(kMemoryFile, 0, *size);
  if (!bytes.ok()) return;
  base::ReadArchive head(*bytes);
  base::Digest sum{};
  uint64_t length = 0;
  head(sum);
  head(length);
  if (head.failed() || length > bytes->size() - kHeadBytes) return;
  const base::ByteSpan content = base::ByteSpan(*bytes).subspan(kHeadBytes, length);
  if (base::sha256(content) != sum) return;
  base::ReadArchive in(content);
  base::Bytes order;
  base::Bytes answer;
  in(order);
  in(answer);
  if (!in.done()) return;
  order_ = std::move(order);
  answer_ = std::move(answer);
}

base::Status AgentMemory::begin(base::ByteSpan order) {
  order_.assign(order.begin(), order.end());
  answer_.clear();
  return write();
}

base::Status AgentMemory::end(base::ByteSpan answer) {
  answer_.assign(answer.begin(), answer.end());
  return write();
}

base::Status AgentMemory::write() const {
  base::WriteArchive content;
  content(order_);
  content(answer_);
  const base::Bytes bytes = content.take();
  base::WriteArchive head;
  head(base::sha256(bytes));
  head(uint64_t{bytes.size()});
  const base::Bytes begin = head.take();
  const vm::Storage::Piece pieces[] = {{0, begin}, {begin.size(), bytes}};
  return storage_.replace(kMemoryFile, begin.size() + bytes.size(), pieces);
}

}  // namespace stvm
