#include "frontend/parse/foreign_words.h"

#include "frontend/parse/token_sets.h"
#include "ir/types/types.h"

namespace frontend {
namespace {

struct ForeignWord {
  std::string_view word;
  std::string_view instead;
};

constexpr ForeignWord kForeignWords[] = {
    {"ELSEIF", "write `ELSIF`"},
    {"ELIF", "write `ELSIF`"},
    {"ENDIF", "write `END_IF`"},
    {"ENDFOR", "write `END_FOR`"},
    {"ENDWHILE", "write `END_WHILE`"},
    {"ENDCASE", "write `END_CASE`"},
    {"NEXT", "write `END_FOR` at the end of a FOR loop"},
    {"WEND", "write `END_WHILE`"},
    {"BREAK", "write `EXIT` to leave a loop; the parts of CASE need none"},
    {"SWITCH", "write `CASE value OF`"},
    {"GOTO", "write `JMP label;`"},
    {"DOWNTO", "write `TO` the last value, and `BY -1`"},
    {"STEP", "write `BY`"},
};

}  // namespace

std::string instead_of(std::string_view word) {
  for (const ForeignWord& row : kForeignWords) {
    if (ir::same_name(word, row.word)) return std::string(row.instead);
  }
  return {};
}

std::string statement_fix(std::string_view word, std::string_view behind) {
  if (behind.empty() || !is_elementary_name(word)) return instead_of(word);
  return "declare variables in front of the statements: `VAR " + std::string(behind) + " : " +
         std::string(word) + "; END_VAR`";
}

}  // namespace frontend
