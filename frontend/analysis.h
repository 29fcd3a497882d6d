// The steps of one compilation, for those who take them one by one: compile.cc takes all of them
// once, the resident front end (resident.h) some of them again.
#pragma once

#include <memory>

#include "base/diagnostics.h"
#include "base/source.h"
#include "frontend/compile.h"
#include "frontend/parse/tree.h"
#include "frontend/sema/sema.h"

namespace frontend {

// All sources as one tree.
struct Parsed {
  base::SourceMap sources;  // with the library, whose files begin at `library_file`
  uint32_t library_file = 0;
  Tree tree;
};
// Of the standard library: all, where names of it may be asked for later, or what the sources need
// (lex/library_index.h). Programs and messages are the same.
enum class LibraryExtent : uint8_t { kWhole, kNeeded };
// Null, with a message, when there is nothing to be found in it.
std::unique_ptr<Parsed> parse_project(const base::SourceMap& sources, const CompileOptions& options,
                                      LibraryExtent extent, base::Diagnostics& diagnostics);

// Everything in front of the bodies. The program has all types, interfaces and heads of POUs.
void declare_all(Sema& sema);
// The body of one POU; `sema.pous` may grow.
void lower_body(Sema& sema, uint32_t pou);
// What needs all bodies.
void check_whole(Sema& sema);
// The part of it that depends on who calls whom and uses what, and on nothing else of bodies.
void check_uses(Sema& sema);

}  // namespace frontend
