#include "frontend/compile.h"

#include "base/limits.h"
#include "frontend/lower/body.h"
#include "frontend/parse/parse.h"
#include "frontend/sema/sema.h"
#include "stdlib/sources.h"

namespace frontend {

std::optional<ir::Program> compile(const base::SourceMap& sources, const CompileOptions& options,
                                   base::Diagnostics& diagnostics) {
  uint64_t bytes = 0;
  for (uint32_t file = 0; file < sources.file_count(); ++file) bytes += sources.text(file).size();
  if (bytes > base::kMaxSourceBytes) {
    diagnostics.add(base::DiagnosticCode::kSourceTooLarge, {},
                    std::to_string(bytes) + " bytes of source text");
    return std::nullopt;
  }
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
  sema.check_output_tasks();
  sema.report_unused();
  if (diagnostics.has_errors()) return std::nullopt;
  return std::move(sema.program);
}

}  // namespace frontend
