// A ladder or function block diagram of an export -> the model of networks. The body is a list of
// networks, each a tree in prefix order with a word or an operand in each line:
//
//   _NETWORK            and a line with the label, which may be empty
//   _COMMENT 'text' _END_COMMENT
//   _LD_ASSIGN tree _EXPRESSION sign ENABLELIST : n tree... ENABLELIST_END _OUTPUTS : n end...
//   _ASSIGN tree _EXPRESSION sign _OUTPUTS : n end...
//
//   tree: _LD_CONTACT name _EXPRESSION sign | _OPERAND _EXPRESSION sign text | _EMPTY
//         _LD_AND (or _LD_OR) _LD_OPERATOR : n tree... _EXPRESSION sign
//         _FUNCTION (or _OPERATOR) _BOX_EXPR : n [_ENABLED] tree... _EXPRESSION sign name
//         _FUNCTIONBLOCK instance _BOX_EXPR : n tree... _EXPRESSION sign type _OUTPUTS : n end...
//   end:  _OUTPUT sign _NO_SET (or _SET) name; _EMPTY for none
//   sign: _POSITIV or _NEGATIV
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "adapters/text_export/pins.h"
#include "base/diagnostics.h"
#include "frontend/network/network.h"

namespace text_export {

// `at`: in the text; `network`: from 1, 0: of none.
using Report = std::function<void(base::DiagnosticCode code, uint32_t at, uint32_t network,
                                  std::string text, std::string fix)>;

bool is_body_word(std::string_view line);  // _LD_BODY, _SFC_BODY ...
bool is_drawn(std::string_view body);      // does it begin with such a line?

// `text` begins at a body that is_drawn(). `links` counts the pairs of connected elements of the
// whole export, of which there may be base::kMaxLinks. nullopt, after a report (E1083): something
// of it has no meaning here. `what`: how messages call the body.
std::optional<frontend::network::Body> read_networks(std::string_view text, const std::string& what,
                                                     const PinNames& pins, const Report& report,
                                                     size_t& links);

}  // namespace text_export
