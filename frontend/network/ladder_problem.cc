// What ladder as text has no form for, in words.
#include "base/limits.h"
#include "frontend/network/branches.h"
#include "frontend/network/layout.h"
#include "frontend/network/write.h"

namespace frontend::network {
namespace {

// Power goes through boxes from pin to pin.
std::string pin_problem(const Network& network) {
  for (const Element& element : network.elements) {
    if (element.kind == Kind::kSink && element.modifier > Modifier::kNegated) {
      return "a variable at an output of a box is set, reset or sees an edge";
    }
    if (element.kind != Kind::kBlock) continue;
    const std::string name = element.operand.empty() ? element.type.text : element.operand.text;
    uint32_t powered = 0;
    for (const Input& input : element.inputs) {
      bool power = false;
      for (Link link : input.from) {
        power = power || network.elements[link.element].kind != Kind::kSource;
      }
      powered += power ? 1 : 0;
      if (power && input.modifier != Modifier::kNone) {
        return "the pin of `" + name + "` where power arrives is negated or sees an edge";
      }
    }
    if (powered > 1) return "power arrives at several pins of `" + name + "`";
    if (powered == 0) return "no power arrives at `" + name + "`";
  }
  return {};
}

}  // namespace

std::string ladder_problem(const Network& network) {
  Body body;
  body.networks.push_back(network);
  if (write_ladder(body, 0)) return {};
  std::string pins = pin_problem(network);
  if (!pins.empty()) return pins;
  if (!place(network)) {
    return "its wires are no series and parallel branches (a bridge, a tap inside of a branch, or "
           "more than " +
           std::to_string(kMaxBranchNesting) + " branches inside each other)";
  }
  return "it has a pin, operand or comment that would say something else as text, or is larger "
         "than " +
         std::to_string(base::kMaxRungCells) + " columns times rows";
}

}  // namespace frontend::network
