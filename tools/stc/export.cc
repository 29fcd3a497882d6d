// stc export: sources -> XML for other tools.
#include <cstdio>

#include "frontend/compile.h"
#include "tools/common/exit.h"
#include "tools/common/files.h"
#include "tools/common/outputs.h"
#include "tools/stc/commands.h"
#include "tools/stc/importer.h"
#include "tools/stc/session.h"
#ifdef STC_HAS_XML
#include "adapters/plcopen/export.h"
#include "adapters/xml/document.h"
#endif

namespace stc {
namespace {

constexpr tools::OptionRow kExportOptions[] = {
    STC_SOURCE_OPTIONS,
    {"--output|-o", "FILE", "document to write (needed)"},
    {"--force", nullptr, "overwrite a file that is no XML"},
    {"--as", "FORM", "tc6-2.01 (default, but for documents in 2.0), tc6-2.0 or 61131-10",
     "tc6-2.01|tc6-2.0|61131-10"},
    {"--without-sources", nullptr, "only what XML has elements for, not the text of the sources"},
};
constexpr tools::Command kExportCommand{
    "export", "PATHS...", "Writes PLCopen XML or IEC 61131-10 of the sources.", kExportOptions, 1};

#ifdef STC_HAS_XML

// A source is never the document; what else is there has to look like one.
base::Status refuse_to_overwrite(const tools::Options& options, const Project& project) {
  const std::string output = options.text("--output");
  if (!tools::is_file(output)) return base::Ok{};
  base::Status free = tools::check_output(output, project.read_files(), false);
  if (!free.ok()) return free;
  if (options.has("--force")) return base::Ok{};
  base::Result<std::string> old = tools::read_text(output);
  if (!old.ok()) return old.error();
  xml::Decoded text = xml::to_utf8(*old);
  if (text.error.empty() && (old->empty() || xml::trimmed(text.text).starts_with("<"))) {
    return base::Ok{};
  }
  return base::Error{base::Refusal::kFileUnwritable,
                     output + ": is there and no XML; nothing was written. --force overwrites"};
}

// No form: that of what was read.
base::Status write_document(const tools::Options& options, std::optional<plcopen::Edition> form) {
  base::Result<base::DiagnosticFormat> format = diagnostic_format(options);
  if (!format.ok()) return format.error();
  base::Result<Project> project = open_project(options, options.arguments());
  if (!project.ok()) return project.error();
  base::Status free = refuse_to_overwrite(options, *project);
  if (!free.ok()) return free;
  base::Diagnostics diagnostics = diagnostics_of(*project);
  add_findings(diagnostics, project->imported, false);
  frontend::Tree tree;
  std::optional<std::string> text;
  if (!diagnostics.has_errors()) {
    frontend::parse_all(project->sources, project->compile, tree, diagnostics);
  }
  if (!diagnostics.has_errors()) {
    plcopen::ExportInput input{
        project->sources,        tree,
        project->name,           form ? *form : plcopen::usual_form(project->kept),
        &project->kept,          !options.has("--without-sources"),
        project->compile.defines};
    text = plcopen::export_document(input, diagnostics);
  }
  report(*project, diagnostics, *format);
  if (!text) {
    return base::Error{base::Refusal::kSourceErrors,
                       std::to_string(diagnostics.error_count()) + " error(s)"};
  }
  return tools::write_file(options.text("--output"), base::as_bytes(*text));
}

base::Status export_sources(const tools::Options& options) {
  const std::string name = options.text("--as");
  std::optional<plcopen::Edition> form = plcopen::form_of_name(name);
  if (!form && options.has("--as")) {
    return base::Error{base::Refusal::kUsage,
                       "unknown form `" + name + "`; known are tc6-2.01, tc6-2.0, 61131-10"};
  }
  return write_document(options, form);
}

#else

base::Status export_sources(const tools::Options&) {
  return base::Error{base::Refusal::kFileUnwritable,
                     "XML is not part of this stc: it was built without pugixml (package "
                     "libpugixml-dev)"};
}

#endif

int run_export(const tools::Options& options) {
  if (!options.has("--output")) {
    return tools::refuse("stc", {base::Refusal::kUsage, "export: needs -o FILE"});
  }
  base::Status status = export_sources(options);
  return status.ok() ? tools::kOk : tools::refuse("stc", status.error());
}

}  // namespace

const Entry kExport{&kExportCommand, run_export};

}  // namespace stc
