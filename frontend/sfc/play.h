// Plays a net through from its initial steps, every condition free: which steps can be
// active together. Networks do not touch each other and are played one by one. A net
// with so many parallel branches that this takes too long is played in part: then
// `complete` is FALSE, and `entered` is what single branches can reach.
#pragma once

#include "frontend/sfc/net.h"

namespace frontend::sfc {

struct Play {
  bool complete = true;
  std::vector<bool> entered;     // by step
  std::vector<bool> fired;       // by transition
  std::vector<uint32_t> unsafe;  // by network: the first transition that enters an active step
};

Play play(const Net& net);

}  // namespace frontend::sfc
