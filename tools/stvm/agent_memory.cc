#include "tools/stvm/agent_memory.h"

#include "base/archive.h"
#include "tools/stvm/agent_order.h"

namespace stvm {
namespace {

constexpr const char* kMemoryFile = "order";
constexpr uint64_t kMostStored = 16u << 20;

}  // namespace

void AgentMemory::read() {
  const base::Result<uint64_t> size = storage_.size(kMemoryFile);
  if (!size.ok() || *size > kMostStored) return;
  const base::Result<base::Bytes> bytes = storage_.read(kMemoryFile, 0, *size);
  if (!bytes.ok() || bytes->size() < sizeof(base::Digest)) return;
  base::ReadArchive in(*bytes);
  base::Digest sum{};
  in(sum);
  if (base::sha256(base::ByteSpan(*bytes).subspan(sum.size())) != sum) return;
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
  base::WriteArchive all;
  all(base::sha256(bytes));
  base::Bytes sum = all.take();
  const vm::Storage::Piece pieces[] = {{0, sum}, {sum.size(), bytes}};
  return storage_.replace(kMemoryFile, sum.size() + bytes.size(), pieces);
}

}  // namespace stvm
