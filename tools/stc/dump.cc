// stc dump: what each phase made, as text.
#include <cstdio>

#include "base/visible_text.h"
#include "frontend/compile.h"
#include "frontend/lex/lexer.h"
#include "frontend/parse/tree.h"
#include "ir/bytecode/symbols.h"
#include "ir/bytecode/verify.h"
#include "ir/program/text.h"
#include "tools/common/files.h"
#include "tools/common/source_command.h"
#include "tools/stc/addresses_text.h"
#include "tools/stc/commands.h"
#include "tools/stc/edit_version.h"
#include "tools/stc/image_text.h"
#include "tools/stc/package_text.h"
#include "tools/stc/parts_text.h"
#include "tools/stc/session.h"
#include "vm/native/make_function.h"

namespace stc {
namespace {

constexpr tools::OptionRow kDumpOptions[] = {
    TOOLS_COMPILE_OPTIONS,
    STC_CODE_OPTIONS,
    {"--tokens", nullptr, "tokens of the sources"},
    {"--tree", nullptr, "syntax tree"},
    {"--ir", nullptr,
     "intermediate representation (default for sources), not optimised without --passes"},
    {"--object", nullptr, "relocatable objects"},
    {"--code", nullptr, "linked code"},
    {"--native", nullptr, "what the native tier makes of linked code, before registers"},
    {"--image", nullptr, "tables of the image (default for images)"},
    {"--package", "BASE",
     "PATH is a change package that `stc package --base BASE` made: its update records"},
    {"--addresses", nullptr, "what stands at which address of %I, %Q and %M"},
    {"--symbols", nullptr, "every variable with type and offset"},
    {"--parts", nullptr, "what the image is made of, each part with its identity"},
    {"--sources", nullptr, "sources that travel with the image; `stc source` writes them"},
};
constexpr tools::Command kDumpCommand{"dump", "PATHS...",
                                      "Prints what a phase of the compiler made.", kDumpOptions, 1};

std::string tokens_text(const Project& project, base::Diagnostics& diagnostics) {
  std::string out;
  frontend::LexOptions lexing;
  lexing.defines = project.compile.defines;
  for (uint32_t file = 0; file < project.sources.file_count(); ++file) {
    if (!project.sources.is_source(file)) continue;
    out += frontend::print_tokens(frontend::lex(project.sources, file, diagnostics, lexing),
                                  project.sources);
  }
  return out;
}

std::string tree_text(const Project& project, base::Diagnostics& diagnostics) {
  frontend::Tree tree;
  frontend::parse_all(project.sources, project.compile, tree, diagnostics);
  return frontend::print(tree);
}

// Dumps that need sources: tokens, tree, ir, object.
base::Result<std::string> dump_sources(const tools::Options& options) {
  base::Result<Project> project = open_project(options, options.arguments());
  if (!project.ok()) return project.error();
  base::Diagnostics diagnostics = diagnostics_of(*project);
  if (options.has("--tokens") || options.has("--tree")) {
    std::string out = options.has("--tokens") ? tokens_text(*project, diagnostics)
                                              : tree_text(*project, diagnostics);
    report(*project, diagnostics, base::DiagnosticFormat::kText);
    return out;
  }
  const bool objects = options.has("--object");
  if (!objects && !options.has("--passes")) project->passes = ir::PassSet::none();
  base::Result<Compiled> compiled = compile(*project, diagnostics);
  report(*project, diagnostics, base::DiagnosticFormat::kText);
  if (!compiled.ok()) return compiled.error();
  if (!objects) return ir::print(compiled->program);
  std::string out;
  for (const ir::Object& object : compiled->objects) {
    out += ir::disassemble(object, compiled->program) + "\n";
  }
  return out;
}

base::Result<std::string> sources_text(const Version& version) {
  base::Result<ir::EmbeddedSources> sources = ir::sources_of(version.bytes);
  if (!sources.ok()) return sources.error();
  if (sources->none()) return tools::no_sources(version.image.name);
  base::Result<std::vector<ir::SourceText>> texts = ir::unpack_sources(*sources);
  if (!texts.ok()) return texts.error();
  std::string out;
  for (const ir::SourceText& source : *texts) {
    out += (out.empty() ? "==> " : "\n==> ") + source.path + " <==\n" + source.text;
    if (!out.ends_with('\n')) out += '\n';
  }
  return base::visible_lines(out);
}

std::string sources_line(const base::Bytes& image) {
  const base::Result<ir::EmbeddedSources> sources = ir::sources_of(image);
  if (!sources.ok() || sources->none()) return {};
  return "\nsources: " + std::to_string(sources->files.size()) + " files, packed in " +
         std::to_string(sources->packed.size()) + " bytes\n";
}

base::Result<std::string> dump_image(const tools::Options& options) {
  const std::vector<std::string>& paths = options.arguments();
  base::Result<Version> version = open_version(options, paths, {});
  if (!version.ok()) return version.error();
  if (options.has("--parts")) return parts_text(version->image);
  if (options.has("--code")) {
    std::string out;
    for (const ir::LinkedPou& pou : version->image.pous) {
      if (pou.unit_count != 0) out += ir::disassemble(version->image, pou) + "\n";
    }
    return out;
  }
  if (options.has("--native")) return vm::native::functions_text(version->image);
  if (options.has("--addresses")) return addresses_text(version->image);
  if (options.has("--symbols")) return symbols_text(version->image);
  if (options.has("--sources")) return sources_text(*version);
  return image_text(version->image, ir::digest(version->bytes)) + sources_line(version->bytes);
}

base::Result<std::string> dump_package(const tools::Options& options) {
  if (options.arguments().size() != 1) {
    return base::Error{base::Refusal::kUsage, "dump --package BASE: one change package"};
  }
  base::Result<Version> before = read_image(options.text("--package"));
  if (!before.ok()) return before.error();
  base::Result<base::Bytes> bytes = tools::read_bytes(options.arguments()[0]);
  if (!bytes.ok()) return bytes.error();
  auto package = online_change::decode(*bytes, before->bytes);
  if (!package.ok()) return package.error();
  const base::Digest base = ir::digest(before->bytes);
  if (package->base != base) return online_change::stale_base(package->base, base);
  base::Result<ir::VerifiedImage> next = ir::verify(package->image);
  if (!next.ok()) return next.error();
  base::Status sound = online_change::check_package(*package, before->image, next->image());
  if (!sound.ok()) return sound.error();
  return package_text(*package, before->image, next->image());
}

int run_dump(const tools::Options& options) {
  if (options.has("--package")) {
    base::Result<std::string> out = dump_package(options);
    if (!out.ok()) return tools::refuse("stc", out.error());
    std::fputs(out->c_str(), stdout);
    return tools::kOk;
  }
  if (options.arguments().size() == 1 && is_fleet_file(options.arguments()[0])) {
    base::Result<std::string> out = fleet_file_text(options.arguments()[0]);
    if (!out.ok()) return tools::refuse("stc", out.error());
    std::fputs(out->c_str(), stdout);
    return tools::kOk;
  }
  bool image_given = options.arguments().size() == 1 && is_image(options.arguments()[0]);
  bool wants_source_phase = options.has("--tokens") || options.has("--tree") ||
                            options.has("--ir") || options.has("--object");
  if (image_given && wants_source_phase) {
    return tools::refuse("stc", {base::Refusal::kUsage,
                                 "dump: an image has no tokens, tree, ir or objects any more"});
  }
  bool wants_image = image_given || options.has("--code") || options.has("--native") ||
                     options.has("--image") || options.has("--symbols") ||
                     options.has("--sources") || options.has("--parts") ||
                     options.has("--addresses");
  base::Result<std::string> out = wants_image ? dump_image(options) : dump_sources(options);
  if (!out.ok()) return tools::refuse("stc", out.error());
  std::fputs(out->c_str(), stdout);
  return tools::kOk;
}

}  // namespace

const Entry kDump{&kDumpCommand, run_dump};

}  // namespace stc
