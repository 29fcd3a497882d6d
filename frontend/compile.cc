#include "frontend/compile.h"

#include "frontend/lower/body.h"
#include "frontend/parse/parse.h"
#include "frontend/sema/sema.h"
#include "stdlib/sources.h"

namespace frontend {

std::optional<ir::Program> compile(const base::SourceMap& sources, const CompileOptions& options,
                                   base::Diagnostics& diagnostics) {
  // The library's files come behind the project's, so positions stay what they were.
  base::SourceMap all = sources;
  for (const stdlib::LibrarySource& library : stdlib::library_sources()) {
    all.add(std::string(library.name), std::string(library.text));
  }
  Tree tree;
  for (uint32_t file = 0; file < all.file_count(); ++file) parse(all, file, tree, diagnostics);

  Sema sema(all, tree, sources.file_count(), options, diagnostics);
  sema.collect();
  sema.resolve_declarations();
  sema.configure();
  for (uint32_t pou = 0; pou < sema.pous.size(); ++pou) Body(sema, pou).run();
  sema.report_unused();
  if (diagnostics.has_errors()) return std::nullopt;
  return std::move(sema.program);
}

}  // namespace frontend
