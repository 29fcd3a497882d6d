#include "frontend/compile.h"
#include "frontend/sema/configuration/configuration.h"
#include "frontend/sema/declarations/collection.h"
#include "frontend/sema/declarations/interfaces.h"

#include <algorithm>
#include <memory>

#include "base/limits.h"
#include "frontend/analysis.h"
#include "frontend/coverage.h"
#include "frontend/finished_bodies.h"
#include "frontend/lex/declaration_index.h"
#include "frontend/lex/library_index.h"
#include "frontend/lower/body.h"
#include "frontend/parse/address_map.h"
#include "frontend/parse/parse.h"
#include "frontend/sema/configuration/common_uses.h"
#include "frontend/sema/declarations/migrations.h"
#include "frontend/sema/declarations/rename_rules.h"
#include "frontend/sema/declarations/shared_addresses.h"
#include "frontend/sema/declarations/unused.h"
#include "frontend/sema/objects/objects.h"
#include "frontend/sema/sema.h"
#include "frontend/sfc/declare.h"
#include "stdlib/sources.h"

namespace frontend {

namespace {

// For as many nodes as usual sources have of the largest kinds: growing copies all of them.
void make_room(const base::SourceMap& sources, Tree& tree) {
  constexpr size_t kBytesPerStatement = 48;
  constexpr size_t kBytesPerLiteral = 54;
  constexpr size_t kBytesPerSpec = 96;
  size_t bytes = 0;
  for (uint32_t file = 0; file < sources.file_count(); ++file) {
    if (sources.is_source(file)) bytes += sources.text(file).size();
  }
  tree.stmts.reserve(tree.stmts.size() + bytes / kBytesPerStatement);
  tree.literals.reserve(tree.literals.size() + bytes / kBytesPerLiteral);
  tree.specs.reserve(tree.specs.size() + bytes / kBytesPerSpec);
}

}  // namespace

void parse_all(const base::SourceMap& sources, const CompileOptions& options, Tree& tree,
               base::Diagnostics& diagnostics) {
  DeclarationIndex declarations(sources);
  LexOptions lexing;
  lexing.defines = options.defines;
  lexing.declarations = &declarations;
  make_room(sources, tree);
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

// The library's files come after the project's, so positions stay what they were.
base::SourceMap with_library(const base::SourceMap& sources, const std::vector<uint32_t>& files) {
  base::SourceMap all = sources;
  for (const uint32_t file : files) {
    const stdlib::LibrarySource& library = stdlib::library_sources()[file];
    all.add(std::string(library.name), std::string(library.text));
  }
  return all;
}

}  // namespace

std::unique_ptr<Parsed> parse_project(const base::SourceMap& sources, const CompileOptions& options,
                                      LibraryExtent extent, base::Diagnostics& diagnostics) {
  if (!fits(sources, options.max_source_bytes, diagnostics)) return nullptr;
  auto parsed = std::make_unique<Parsed>();
  const LibraryIndex& library = LibraryIndex::of(options.dialect == Dialect::kIec);
  parsed->sources = with_library(
      sources, extent == LibraryExtent::kWhole ? library.all() : library.needed(sources));
  parsed->library_file = sources.file_count();
  parse_all(parsed->sources, options, parsed->tree, diagnostics);
  if (has_open_comment(diagnostics)) return nullptr;
  map_addresses(parsed->tree, diagnostics);
  sfc::declare_charts(parsed->tree, parsed->sources, diagnostics);
  check_renames(parsed->tree, diagnostics);
  return parsed;
}

void declare_all(Sema& sema) {
  Collection(sema).collect();
  Interfaces(sema).check_underlines();
  Interfaces(sema).resolve_declarations();
  Migrations(sema).collect();
  Configuration(sema).configure();
  Objects(sema).add_start();
}

void lower_body(Sema& sema, uint32_t pou) {
  if (sema.declared.pous[pou].id.valid()) write_body(sema, pou);
}

void check_uses(Sema& sema) {
  Objects(sema).check_recursion();
  CommonUses(sema).check_output_tasks();
  CommonUses(sema).check_call_instances();
  CommonUses(sema).check_second_coils();
  report_unused(Phase(sema));
}

void check_whole(Sema& sema) {
  Interfaces(sema).finish_programs();
  Migrations(sema).check_code();
  Objects(sema).check_recursion();
  sema.program.overrides = ir::find_overrides(sema.program);
  CommonUses(sema).check_output_tasks();
  CommonUses(sema).check_call_instances();
  CommonUses(sema).check_second_coils();
  SharedAddresses(sema).check();
  report_unused(Phase(sema));
}

namespace {

struct Analysed {
  TestProgram made;
  ResourceUses uses;
};
// `once`: nobody needs the bodies of the tree afterwards.
std::optional<Analysed> analyse(Purpose purpose, Parsed& parsed, bool once,
                                const CompileOptions& options, base::Diagnostics& diagnostics) {
  Sema sema(parsed.sources, parsed.tree, parsed.library_file, options, purpose, diagnostics);
  declare_all(sema);
  Coverage* coverage = options.coverage;
  if (coverage != nullptr) {
    coverage->begin(parsed.sources, parsed.tree, parsed.library_file, sema.program);
  }
  // Grows while bodies use functions in new instances.
  std::optional<FinishedBodies> finished;
  if (once && coverage == nullptr) finished.emplace(sema, parsed.tree);
  for (uint32_t pou = 0; pou < sema.declared.pous.size(); ++pou) {
    lower_body(sema, pou);
    if (finished) finished->finish(pou);
  }
  check_whole(sema);
  if (coverage != nullptr) coverage->finish(sema.program);
  if (diagnostics.has_errors()) return std::nullopt;
  ResourceUses uses = CommonUses(sema).of_resource();
  return Analysed{{std::move(sema.program), std::move(sema.tests.cases)}, std::move(uses)};
}

std::optional<TestProgram> compile_as(Purpose purpose, const base::SourceMap& sources,
                                      const CompileOptions& options,
                                      base::Diagnostics& diagnostics) {
  const std::unique_ptr<Parsed> parsed =
      parse_project(sources, options, LibraryExtent::kNeeded, diagnostics);
  if (parsed == nullptr) return std::nullopt;
  const bool once = purpose == Purpose::kRun;
  std::optional<Analysed> analysed = analyse(purpose, *parsed, once, options, diagnostics);
  if (!analysed) return std::nullopt;
  return std::move(analysed->made);
}

const std::vector<ResourceDecl>& resources_of(const Tree& tree) {
  static const std::vector<ResourceDecl> kNone;
  return tree.configs.size() == 1 ? tree.configs[0].resources : kNone;
}

}  // namespace

std::optional<ir::Program> compile(const base::SourceMap& sources, const CompileOptions& options,
                                   base::Diagnostics& diagnostics) {
  auto made = compile_as(Purpose::kRun, sources, options, diagnostics);
  if (!made) return std::nullopt;
  return std::move(made->program);
}

std::optional<Resources> compile_resources(const base::SourceMap& sources,
                                           const CompileOptions& options,
                                           base::Diagnostics& diagnostics) {
  const std::unique_ptr<Parsed> parsed =
      parse_project(sources, options, LibraryExtent::kNeeded, diagnostics);
  if (parsed == nullptr) return std::nullopt;
  CompileOptions of_one = options;
  const auto named = [&](const std::string& name) {
    const auto& all = resources_of(parsed->tree);
    return std::any_of(all.begin(), all.end(), [&](const ResourceDecl& resource) {
      return ir::same_name(resource.name.text, name);
    });
  };
  if (options.resource.empty() && named(options.likely_resource)) {
    of_one.resource = options.likely_resource;
  }
  const std::string wanted = of_one.resource;
  Resources out;
  const bool several = resources_of(parsed->tree).size() > 1;
  if (!several || (!wanted.empty() && !named(wanted))) {
    std::optional<Analysed> only = analyse(Purpose::kRun, *parsed, true, of_one, diagnostics);
    if (!only) return std::nullopt;
    out.programs.push_back({"", {}, std::move(only->made.program), {}});
    return out;
  }
  std::vector<ResourceUses> uses;
  for (const ResourceDecl& resource : resources_of(parsed->tree)) {
    of_one.resource = resource.name.text;
    std::optional<Analysed> one = analyse(Purpose::kRun, *parsed, false, of_one, diagnostics);
    if (!one) return std::nullopt;
    out.names.push_back(of_one.resource);
    uses.push_back(std::move(one->uses));
    if (!wanted.empty() && !ir::same_name(wanted, of_one.resource)) continue;
    out.programs.push_back({of_one.resource, resource.name.span, std::move(one->made.program),
                            std::move(uses.back().other_code)});
  }
  check_resources(uses, diagnostics);
  if (diagnostics.has_errors()) return std::nullopt;
  return out;
}

std::optional<TestProgram> compile_tests(const base::SourceMap& sources,
                                         const CompileOptions& options,
                                         base::Diagnostics& diagnostics) {
  return compile_as(Purpose::kTest, sources, options, diagnostics);
}

}  // namespace frontend
