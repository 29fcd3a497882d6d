#include "frontend/sema/sema.h"

namespace frontend {

Sema::Sema(const base::SourceMap& source_map, const Tree& syntax, uint32_t library_file,
           const CompileOptions& compile_options, Purpose purpose_of_build,
           base::Diagnostics& diagnostics)
    : sources(source_map),
      tree(syntax),
      options(compile_options),
      purpose(purpose_of_build),
      library(source_map, library_file),
      facts(syntax),
      report(source_map, syntax, compile_options, program, declared, library, diagnostics) {
  program.name = options.name;
  ir::Type globals;
  globals.kind = ir::Kind::kGlobals;
  program.globals = program.types.declare(std::move(globals));
}

void Sema::mark_used(VarId id) {
  declared.variables[id.index].used = true;
  if (log != nullptr) log->marks.push_back(2 * id.index);
}

void Sema::mark_written(VarId id) {
  declared.variables[id.index].written = true;
  if (log != nullptr) log->marks.push_back(2 * id.index + 1);
}

}  // namespace frontend
