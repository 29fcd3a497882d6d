// Do two bodies mean the same? What is written and read again must.
#pragma once

#include <string>
#include <vector>

#include "frontend/network/network.h"

namespace frontend::network {

// A text that two bodies share when they do the same in the same order and have the same labels,
// titles and comments, whatever the positions, the ids, the order of parallel contacts between two
// elements that write something, pins that nothing is connected to, and rails. Contacts without
// use are left out.
//
// A contact is read after what was done before it. With kExact it has to stay there; with kAsRead
// only after what may have written its operand: a coil or variable of that name, a box that is not
// a MOVE, anything through `^` or at an address. Other names of the same memory (AT, references)
// are not seen.
enum class Timing : uint8_t { kExact, kAsRead };
std::string canonical(const Body& body, Timing timing = Timing::kExact);

// A rung with what stands in front of it in text: comments and labels of networks without
// elements belong to what follows them.
struct Headed {
  std::string label;
  std::string title;
  bool disabled = false;
  bool headed = false;  // as in Network
  std::vector<std::string> comments;
  const Network* network = nullptr;  // null: nothing follows
};
std::vector<Headed> with_heads(const Body& body);

}  // namespace frontend::network
