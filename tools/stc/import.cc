// stc import: what other tools wrote -> sources, and a report of everything that did not come in.
#include <cstdio>
#include <filesystem>

#include "base/diagnostics_render.h"
#include "base/limits.h"
#include "tools/common/exit.h"
#include "tools/common/files.h"
#include "tools/common/json.h"
#include "tools/stc/commands.h"
#include "tools/stc/importer.h"
#include "tools/stc/project.h"

namespace stc {
namespace {

namespace fs = std::filesystem;

constexpr tools::OptionRow kImportOptions[] = {
    {"--output|-o", "DIR", "folder for the sources (needed)"},
    {"--format", "FORM", "text (default) or json: the report on standard output", "text|json"},
    {"--force", nullptr, "overwrite sources that are there and differ"},
};
constexpr tools::Command kImportCommand{
    "import", "PATHS...",
    "Makes sources of PLCopen XML, IEC 61131-10 and TwinCAT files, and reports the rest.",
    kImportOptions, 1};

class Import {
 public:
  explicit Import(const tools::Options& options)
      : folder_(options.text("--output")), force_(options.has("--force")) {}

  base::Status read(const std::vector<std::string>& paths);
  base::Status write();
  std::string text_report() const;
  std::string json_report() const;
  bool failed() const { return errors_ != 0; }

 private:
  struct Row {
    const xml::Finding* finding;
    base::Severity severity;
    base::SourceLocation place;
  };
  std::vector<Row> rows() const;
  base::Status look_beside(const std::string& path);
  base::Status refuse_to_overwrite() const;
  std::string target(const Importer::Made& made) const {
    return (folder_ / made.source.name).string();
  }

  fs::path folder_;
  bool force_;
  uint32_t errors_ = 0;
  base::SourceMap sources_;
  Importer importer_{sources_};
};

base::Status Import::read(const std::vector<std::string>& paths) {
  bool found = false;
  for (const std::string& path : paths) {
    base::Result<std::vector<std::string>> files(std::vector<std::string>{path});
    if (tools::is_folder(path)) files = importable_files(path, true);
    if (!files.ok()) return files.error();
    if (files->empty()) {
      return base::Error{base::Refusal::kFileNotFound,
                         path + ": nothing in this folder or below it can be imported"};
    }
    base::Status beside = look_beside(path);
    if (!beside.ok()) return beside;
    for (const std::string& file : *files) {
      if (is_source_name(file) && !is_importable(file)) continue;
      if (!is_importable(file)) {
        return base::Error{base::Refusal::kUsage, file + ": imported are " + kImportable};
      }
      found = true;
      base::Status status = importer_.add(file);
      if (!status.ok()) return status;
    }
  }
  if (!found) {
    return base::Error{base::Refusal::kUsage, paths.front() + ": imported are " + kImportable};
  }
  importer_.finish();
  for (const Row& row : rows()) errors_ += row.severity == base::Severity::kError ? 1 : 0;
  return base::Ok{};
}

// Sources say what the pins of their function blocks are called, which exports do not.
base::Status Import::look_beside(const std::string& path) {
  base::Result<std::vector<std::string>> files = source_files(path);
  if (!files.ok()) return files.error();
  for (const std::string& file : *files) {
    if (!is_source_name(file) || is_importable(file)) continue;
    base::Result<std::string> text = tools::read_text(file, base::kMaxSourceBytes);
    if (!text.ok()) return text.error();
    sources_.add(file, std::move(*text));
  }
  return base::Ok{};
}

base::Status Import::refuse_to_overwrite() const {
  for (const Importer::Made& made : importer_.made) {
    const std::string path = target(made);
    if (!tools::is_there(path)) continue;
    base::Result<std::string> old = tools::read_text(path, base::kMaxSourceBytes);
    if (!old.ok()) return old.error();
    if (*old == made.source.text) continue;
    return base::Error{base::Refusal::kFileUnwritable,
                       path + ": is there and differs; nothing was written. --force overwrites"};
  }
  return base::Ok{};
}

base::Status Import::write() {
  base::Status free = force_ ? base::Status(base::Ok{}) : refuse_to_overwrite();
  if (!free.ok()) return free;
  std::error_code error;
  fs::create_directories(folder_, error);
  if (error) {
    return base::Error{base::Refusal::kFileUnwritable, folder_.string() + ": " + error.message()};
  }
  for (const Importer::Made& made : importer_.made) {
    base::Status status = tools::write_file(target(made), base::as_bytes(made.source.text));
    if (!status.ok()) return status;
  }
  return base::Ok{};
}

std::vector<Import::Row> Import::rows() const {
  std::vector<Row> out;
  for (const xml::Finding& finding : importer_.findings) {
    out.push_back({&finding, base::diagnostic_row(finding.code).severity,
                   sources_.locate(finding.span.begin)});
  }
  return out;
}

std::string Import::text_report() const {
  std::string out;
  for (const Importer::Made& made : importer_.made) {
    out += made.origin + " -> " + target(made) + "\n";
  }
  uint32_t counts[3] = {};
  for (const Row& row : rows()) {
    ++counts[static_cast<uint32_t>(row.severity)];
    out += std::string(row.place.file) + ":" + std::to_string(row.place.line) + ":" +
           std::to_string(row.place.column) + ": " +
           std::string(base::severity_name(row.severity)) + "[" +
           std::string(base::diagnostic_row(row.finding->code).code) +
           "]: " + located_text(*row.finding);
    if (!row.finding->fix.empty()) out += "; " + row.finding->fix;
    out += "\n";
  }
  return out + std::to_string(importer_.made.size()) + " source(s), " + std::to_string(counts[0]) +
         " error(s), " + std::to_string(counts[1]) + " warning(s), " + std::to_string(counts[2]) +
         " note(s)\n";
}

std::string Import::json_report() const {
  tools::JsonWriter out;
  out.begin_object().key("sources").begin_array();
  for (const Importer::Made& made : importer_.made) {
    out.begin_object().field("from", made.origin).field("file", target(made)).end_object();
  }
  out.end_array().key("findings").begin_array();
  for (const Row& row : rows()) {
    out.begin_object()
        .field("severity", base::severity_name(row.severity))
        .field("code", base::diagnostic_row(row.finding->code).code)
        .field("file", row.place.file)
        .field("line", row.place.line)
        .field("column", row.place.column)
        .field("pou", std::string_view(row.finding->pou))
        .field("network", row.finding->network)
        .field("text", std::string_view(row.finding->text))
        .field("fix", std::string_view(row.finding->fix))
        .end_object();
  }
  out.end_array().field("errors", errors_).end_object();
  return out.finish();
}

int run_import(const tools::Options& options) {
  const std::string form = options.text("--format", "text");
  if (form != "text" && form != "json") {
    return tools::refuse(
        "stc", {base::Refusal::kUsage, "unknown format `" + form + "`; known are text, json"});
  }
  if (!options.has("--output")) {
    return tools::refuse("stc", {base::Refusal::kUsage, "import: needs -o DIR for the sources"});
  }
  Import import(options);
  base::Status status = import.read(options.arguments());
  if (status.ok()) status = import.write();
  if (!status.ok()) return tools::refuse("stc", status.error());
  std::fputs((form == "json" ? import.json_report() : import.text_report()).c_str(), stdout);
  return import.failed() ? tools::kFindings : tools::kOk;
}

}  // namespace

const Entry kImport{&kImportCommand, run_import};

}  // namespace stc
