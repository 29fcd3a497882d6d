// The front end as one function: sources -> typed program in IR form. The passes
// are parse (parse/), declarations, types, constants and bodies (sema/), and
// lowering to IR (lower/).
#pragma once

#include <optional>

#include "base/diagnostics.h"
#include "base/source.h"
#include "ir/program/ir.h"

namespace frontend {

enum class Dialect : uint8_t { kIec, kCodesys, kTwincat };

struct CompileOptions {
  Dialect dialect = Dialect::kCodesys;
  std::string name = "project";  // used when there is no CONFIGURATION
};

// All files of `sources` are one project; the standard function blocks (ST, from
// stdlib) that it uses are compiled along. nullopt when any error was reported.
// Without a CONFIGURATION: one task of 10 ms; every PROGRAM type runs once in it,
// under its own name, in source order.
std::optional<ir::Program> compile(const base::SourceMap& sources, const CompileOptions& options,
                                   base::Diagnostics& diagnostics);

}  // namespace frontend
