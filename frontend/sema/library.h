// Store: what the standard library offers. Its types and POUs enter the program when their name is
// first used.
#pragma once

#include "base/source.h"
#include "frontend/sema/model.h"
#include "stdlib/registry.h"

namespace frontend {

struct Library {
  // Files from `first_file` on are the library; those that come later are the project's again.
  Library(const base::SourceMap& sources, uint32_t first_file)
      : begin(first_file < sources.file_count() ? sources.begin(first_file) : sources.end()),
        end(sources.end()) {
    for (const auto& row : stdlib::function_rows()) functions.emplace(row.name, &row);
  }
  // Does its source stand there?
  bool holds(base::SourceSpan span) const {
    return span.begin.valid() && !(span.begin < begin) && span.begin < end;
  }

  base::SourcePos begin, end;
  NameMap<const PouDecl*> pous;
  NameMap<const TypeDecl*> types;
  NameMap<const TypeDecl*> literals;  // the enumeration that has it
  NameMap<const stdlib::FunctionRow*> functions;
};

}  // namespace frontend
