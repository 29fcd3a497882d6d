// What an agent must not forget: its last order and what it has answered. So an order that comes
// again, as the broker keeps it, is answered and not done again; and one that a crash has ended in
// the middle is gone on with.
#pragma once

#include "base/bytes.h"
#include "base/result.h"
#include "vm/runtime/ports.h"

namespace stvm {

class AgentMemory {
 public:
  // `storage` must outlive it.
  explicit AgentMemory(vm::Storage& storage) : storage_(storage) {}
  // What is stored; nothing where there is none, or where it is damaged: then the trust record
  // alone keeps old orders out.
  void read();
  // Durable when they return. begin(): a new order, not answered.
  base::Status begin(base::ByteSpan order);
  base::Status end(base::ByteSpan answer);

  const base::Bytes& order() const { return order_; }
  const base::Bytes& answer() const { return answer_; }  // empty: it has not ended

 private:
  base::Status write() const;

  vm::Storage& storage_;
  base::Bytes order_;
  base::Bytes answer_;
};

}  // namespace stvm
