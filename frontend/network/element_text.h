// Elements as they stand in the text forms; the inside of write.h.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "frontend/network/layout.h"
#include "frontend/network/network.h"

namespace frontend::network {

// Sinks at each output of each box of one network, which must outlive it.
class Sinks {
 public:
  explicit Sinks(const Network& network);
  // Elements, in their order.
  const std::vector<uint32_t>& at(uint32_t element, uint32_t output) const;

 private:
  std::vector<std::vector<std::vector<uint32_t>>> sinks_;
};

// What stands between the brackets of ladder, brackets included. nullopt when ladder/read.h has no
// text for it: a power pin that is negated, a sink with S or R.
std::optional<std::string> ladder_element(const Network& network, const Sinks& sinks,
                                          const Cell& cell);

// `x`, `NOT x`, `[/ x]`, `[P x]`, `[N x]`.
std::string pin_value(Modifier modifier, std::string_view operand);
std::string_view modifier_mark(Modifier modifier);

// Names and dots alone, as A.B.
bool is_plain_name(std::string_view operand);
bool is_result(const Element& block, uint32_t output);

// A comment with its marks; its further lines begin with `indent` spaces.
std::string comment_rows(std::string_view comment, uint32_t indent);

// Does the lexer take `rows` between LADDER and END_LADDER, or FBD and END_FBD, for one diagram?
bool is_one_diagram(Language language, std::string_view rows);

bool is_utf8(std::string_view text);
// Characters when `wide`, otherwise bytes.
uint32_t count_columns(std::string_view text, bool wide);

}  // namespace frontend::network
