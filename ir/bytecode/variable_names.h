// Variables as people name them: by their path (symbols.h), by the address that they stand for
// (`%IX0.3`), and by the PROGRAM that the sources declare where it has one instance (`Main.n` of
// `PROGRAM P1 WITH Fast : Main`). Paths are what everything else works with: they stay the same
// over a change.
#pragma once

#include <string>
#include <string_view>

#include "base/result.h"
#include "ir/bytecode/symbols.h"

namespace ir {

// `path`: what find_symbol() takes for the name; the name itself where it is a path.
struct NamedSymbol {
  std::string path;
  Symbol symbol;
};
// kNoSuchVariable says which part is not there, and which one was meant, perhaps.
base::Result<NamedSymbol> named_symbol(const NameIndex& names, std::string_view name);
// For one name: it goes through all of the image's names.
base::Result<Symbol> named_symbol(const Image& image, std::string_view name);

}  // namespace ir
