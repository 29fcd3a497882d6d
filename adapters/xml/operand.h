// Text of XML that becomes an operand between other text.
#pragma once

#include <string_view>

namespace xml {

// Is `text` one expression, without comments, pragmas, statements or open brackets? It can stand
// between other text then and change nothing of that.
bool is_operand(std::string_view text);
bool is_plain_operand(std::string_view text);  // the same without calls and brackets
// A number, a text, TRUE, INT#5: nothing that could change.
bool is_literal(std::string_view operand);
bool is_dotted_name(std::string_view text);  // names with points between them: Lib.Block

}  // namespace xml
