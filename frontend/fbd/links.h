// Operands of one network of FBD as text -> links. What an operand names is known when all boxes
// of the network are, so the reader gives every operand a source in front of its element; here
// those that name a box become links to it, and their sources go. A source whose expression has
// wires in it gets inputs for them (network/expressions.h).
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "base/diagnostics.h"
#include "frontend/network/network.h"

namespace frontend::fbd {

class Links {
 public:
  explicit Links(base::Diagnostics& diagnostics) : diagnostics_(diagnostics) {}

  // A box of that name; of a function's result when `wire`. Reports a name that stands twice.
  void add_box(const network::Text& name, uint32_t element, bool wire);
  // `operand` is connected to that input; its source stands in front of `element`.
  void add_use(uint32_t element, uint32_t input, const network::Text& operand);

  size_t uses() const { return uses_.size(); }
  // Forgets uses from that number on and boxes from that element on.
  void forget(size_t uses, size_t elements);

  // At the end of the network: links, drops sources, forgets everything.
  void finish(network::Network& network);

 private:
  struct Box {
    std::vector<uint32_t> elements;  // ascending; several of one instance
    bool wire = false;
    network::Text name;
  };
  struct Use {
    uint32_t element = 0;
    uint32_t input = 0;
    network::Text operand;
  };
  struct Found {  // what an operand names
    std::optional<network::Link> link;
    bool reported = false;
    std::vector<network::Input> wires;  // of an expression
  };

  Found find(const Use& use, network::Network& network);
  uint32_t output_number(network::Network& network, uint32_t box, std::string_view name);
  static uint32_t box_for(const Use& use, const Box& box);
  Found whole_box(const Use& use, const Box& box);
  Found feedback(const Use& use, const Box& box);
  Found expression(const Use& use, network::Network& network);
  Found part_in_expression(const Use& use, std::string_view part);

  base::Diagnostics& diagnostics_;
  std::unordered_map<std::string, Box> boxes_;  // by folded name
  std::vector<std::string> names_;              // of boxes_, as they were added
  size_t longest_ = 0;                          // of these names
  std::vector<Use> uses_;
  // For boxes whose outputs are used, by element: the outputs' numbers by folded name.
  std::unordered_map<uint32_t, std::unordered_map<std::string, uint32_t>> outputs_;
};

}  // namespace frontend::fbd
