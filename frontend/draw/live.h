// What a picture shows of a running program: values that were read at one boundary, and what they
// say about operands and power. What cannot be told is unknown, and never guessed: edges, calls,
// arithmetic, values that were not read.
#pragma once

#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "frontend/network/network.h"

namespace frontend::draw {

enum class Truth : uint8_t { kUnknown, kFalse, kTrue };

class Live {
 public:
  // Operands are looked for in `instance` (a path, as Main.pump), then among the globals.
  explicit Live(std::string instance) : instance_(std::move(instance)) {}

  void set(std::string_view path, std::string value);
  // Value of a variable as text; null when it was not read.
  const std::string* find(std::string_view variable) const;
  // The truth of a BOOL expression of variables, literals, NOT, AND, OR, XOR and comparisons.
  Truth truth(std::string_view expression) const;
  // What to write beside an operand: its value, or `name=value` of the variables in an
  // expression; empty for BOOL, which colour shows.
  std::string shown(std::string_view operand) const;

 private:
  std::string instance_;
  std::unordered_map<std::string, std::string> values_;  // by folded path
};

// Variables that an expression reads, as far as Live can find them: each once.
std::vector<std::string> variables_in(std::string_view expression);

Truth operator!(Truth a);
Truth all(Truth a, Truth b);
Truth any(Truth a, Truth b);

// Power in one network, element by element in the order of execution.
class Power {
 public:
  // `live` may be null: then everything is unknown.
  Power(const network::Network& network, const Live* live);
  Truth output(network::Link link) const { return outputs_[link.element][link.output]; }
  Truth input(const network::Input& input) const;

 private:
  void element(const network::Element& element, std::vector<Truth>& outputs) const;
  Truth function(const network::Element& block) const;

  const network::Network& network_;
  const Live* live_;
  std::vector<std::vector<Truth>> outputs_;
};

}  // namespace frontend::draw
