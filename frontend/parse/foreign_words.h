// What people write who come from other languages, and what Structured Text has for it.
#pragma once

#include <string>
#include <string_view>

namespace frontend {

// The way out where `word` stands for a statement's keyword: "write `ELSIF`" for ELSEIF. Empty:
// none is known. Case does not count.
std::string instead_of(std::string_view word);
// The same, and for a type in front of the name `behind`, which declares it elsewhere.
std::string statement_fix(std::string_view word, std::string_view behind);

}  // namespace frontend
