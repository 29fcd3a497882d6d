// What a drawing does not say, and execution needs: which of its elements belong together, and
// which comes first. Pure functions on the model, for readers of drawings that know elements and
// links only (XML). Costs time in proportion to n log n.
#pragma once

#include <span>
#include <vector>

#include "frontend/network/network.h"

namespace frontend::network {

// `first` is executed in front of `second` although nothing leads from one to the other.
struct Precedence {
  uint32_t first = 0;
  uint32_t second = 0;
};

// The connected parts of `all` as networks of their own, from top to bottom (by the upmost element
// of each, then by the order in which elements stand in `all`); where each has an Element::order,
// by that, and those that it mixes are one. Rails connect nothing: each network gets one of each
// side that it uses, the left one first. Links come from left rails or from other elements, and
// lead to right rails or others. `all` may have its elements in any order; links are kept. Labels
// and comments stay with nobody: see place_between().
struct Part {
  Network network;
  std::vector<uint32_t> from;           // its elements in `all`
  std::vector<Precedence> precedences;  // those between its elements, by their numbers here
};
std::vector<Part> split(const Network& all, std::span<const Precedence> precedences);

// Puts the elements of one network into the order of execution: where Element::order is given, by
// it, and what has none in front of the first that needs it; where data flows, along it; otherwise
// from top to bottom, then from left to right, and what a box gives to a variable right after the
// box. Loops are cut where the output of a function block
// instance leads back: upwards in the drawing if it does. Gives the elements, by their numbers in
// `network`, of a loop that has no such output; `network` stays as it was then.
std::vector<uint32_t> order(Network& network, std::span<const Precedence> precedences);

// Where Element::order puts something in front of what it reads, and that keeps no value, it gets
// the order of what it reads, so that order() follows the data. Gives those pairs, `first` is read.
// Empty, and nothing is changed, where data goes in a circle.
std::vector<Precedence> follow_data(Network& network, std::span<const Precedence> precedences);

// Where each network ends, for place_between(): the largest end of it and those above.
std::vector<int32_t> ends_of(const std::vector<Part>& parts);

// The network that something at `y` belongs to which is linked to nothing: the first that ends at
// or below it, else the last. 0 when there is none.
size_t place_between(const std::vector<int32_t>& ends, int32_t y);

}  // namespace frontend::network
