// An Error as people and as programs read it.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "base/result.h"

namespace tools {

// The code, the text and the way out; of a mistake in stc.toml (toml_error()) also where it is.
struct Refused {
  std::string code;  // "R0506"
  std::string text;
  std::string help;
  std::string file;  // "": of no place
  uint32_t line = 0;
  uint32_t column = 0;      // of a byte
  uint32_t end_column = 0;  // exclusive
  std::string line_text;
};
Refused refused(const base::Error& error);

// "stc: R0501: ..." and the help, or what the compiler says of a mistake in a source: place, line
// and caret.
std::string refusal_text(std::string_view tool, const base::Error& error, bool colour);
// As `stc check --format json` has diagnostics.
std::string refusal_json(const base::Error& error);

}  // namespace tools
