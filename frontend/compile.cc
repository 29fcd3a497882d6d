#include "frontend/compile.h"

#include "base/limits.h"
#include "frontend/lex/declaration_index.h"
#include "frontend/lower/body.h"
#include "frontend/parse/address_map.h"
#include "frontend/parse/parse.h"
#include "frontend/sema/migrations.h"
#include "frontend/sema/rename_rules.h"
#include "frontend/sema/sema.h"
#include "frontend/sfc/declare.h"
#include "stdlib/sources.h"

namespace frontend {

void parse_all(const base::SourceMap& sources, const CompileOptions& options, Tree& tree,
               base::Diagnostics& diagnostics) {
  DeclarationIndex declarations(sources);
  LexOptions lexing;
  lexing.defines = options.defines;
  lexing.declarations = &declarations;
  for (uint32_t file = 0; file < sources.file_count(); ++file) {
    if (sources.is_source(file)) parse(sources, file, tree, diagnostics, lexing);
  }
}

namespace {

bool fits(const base::SourceMap& sources, uint64_t most, base::Diagnostics& diagnostics) {
  uint64_t bytes = 0;
  for (uint32_t file = 0; file < sources.file_count(); ++file) bytes += sources.text(file).size();
  if (bytes <= most) return true;
  diagnostics.add(
      base::DiagnosticCode::kSourceTooLarge, {},
      std::to_string(bytes) + " bytes of source text; the limit is " + std::to_string(most));
  return false;
}

// The library's files come behind the project's, so positions stay what they were.
base::SourceMap with_library(const base::SourceMap& sources) {
  base::SourceMap all = sources;
  for (const stdlib::LibrarySource& library : stdlib::library_sources()) {
    all.add(std::string(library.name), std::string(library.text));
  }
  return all;
}

std::optional<TestProgram> compile_as(Purpose purpose, const base::SourceMap& sources,
                                      const CompileOptions& options,
                                      base::Diagnostics& diagnostics) {
  if (!fits(sources, options.max_source_bytes, diagnostics)) return std::nullopt;
  base::SourceMap all = with_library(sources);
  Tree tree;
  parse_all(all, options, tree, diagnostics);
  if (has_open_comment(diagnostics)) return std::nullopt;
  map_addresses(tree, diagnostics);
  sfc::declare_charts(tree, diagnostics);
  check_renames(tree, diagnostics);

  Sema sema(all, tree, sources.file_count(), options, purpose, diagnostics);
  sema.report_not_supported();
  sema.collect();
  sema.resolve_declarations();
  Migrations(sema).collect();
  sema.configure();
  sema.objects.add_start();
  // Grows while bodies use functions in new instances.
  for (uint32_t pou = 0; pou < sema.pous.size(); ++pou) {
    if (sema.pous[pou].id.valid()) Body(sema, pou).run();
  }
  sema.finish_programs();
  Migrations(sema).check_code();
  sema.objects.check_recursion();
  sema.program.overrides = ir::find_overrides(sema.program);
  sema.check_output_tasks();
  sema.check_direct_addresses();
  sema.report_unused();
  if (diagnostics.has_errors()) return std::nullopt;
  return TestProgram{std::move(sema.program), std::move(sema.test_cases)};
}

}  // namespace

std::optional<ir::Program> compile(const base::SourceMap& sources, const CompileOptions& options,
                                   base::Diagnostics& diagnostics) {
  auto made = compile_as(Purpose::kRun, sources, options, diagnostics);
  if (!made) return std::nullopt;
  return std::move(made->program);
}

std::optional<TestProgram> compile_tests(const base::SourceMap& sources,
                                         const CompileOptions& options,
                                         base::Diagnostics& diagnostics) {
  return compile_as(Purpose::kTest, sources, options, diagnostics);
}

}  // namespace frontend
