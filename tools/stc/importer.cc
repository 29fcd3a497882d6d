#include "tools/stc/importer.h"

#include <algorithm>
#include <filesystem>
#include <set>

#include "base/limits.h"
#include "base/name_case.h"
#include "tools/common/files.h"
#ifdef STC_HAS_XML
#include "adapters/codesys/export_file.h"
#include "adapters/plcopen/plcopen.h"
#include "adapters/text_export/text_export.h"
#include "adapters/twincat/twincat.h"
#endif

namespace stc {
namespace {

namespace fs = std::filesystem;

bool has_extension(const std::string& path, std::initializer_list<const char*> extensions) {
  const std::string own = fs::path(path).extension().string();
  return std::any_of(extensions.begin(), extensions.end(),
                     [&](const char* extension) { return base::same_name(own, extension); });
}

bool is_twincat(const std::string& path) {
  return has_extension(path, {".TcPOU", ".TcDUT", ".TcGVL", ".TcIO", ".TcTTO", ".plcproj"});
}

#ifdef STC_HAS_XML
// `listed` from `folder` on. Projects come from machines that do not tell letters of different
// case apart. Empty: there is no such file.
std::string find_listed(const fs::path& folder, const std::string& listed) {
  std::error_code error;
  if (fs::is_regular_file(folder / listed, error)) return (folder / listed).string();
  fs::path at = folder;
  for (const fs::path& part : fs::path(listed)) {
    if (part == "." || part == ".." || fs::exists(at / part, error)) {
      at /= part;
      continue;
    }
    fs::path found;
    for (const auto& entry : fs::directory_iterator(at, error)) {
      if (base::same_name(entry.path().filename().string(), part.string())) found = entry.path();
    }
    if (found.empty()) return {};
    at = found;
  }
  return fs::is_regular_file(at, error) ? at.string() : std::string();
}
#endif

}  // namespace

bool is_foreign(const std::string& path) {
  return is_twincat(path) || has_extension(path, {".export"});
}

bool is_importable(const std::string& path) {
  return is_foreign(path) || has_extension(path, {".xml", ".exp"});
}

bool needs_import(const std::string& path) {
  if (!has_extension(path, {".exp"})) return is_importable(path);
#ifdef STC_HAS_XML
  const base::Result<std::string> bytes = tools::read_text(path, base::kMaxXmlBytes);
  if (!bytes.ok()) return false;
  const std::string text = xml::text_as_utf8(*bytes);
  return text_export::is_more_than_text(text_export::split(text, {0}));
#else
  // What is drawn is refused by add().
  const base::Result<std::string> bytes = tools::read_text(path);
  return bytes.ok() && (bytes->find("\n_LD_BODY") != std::string::npos ||
                        bytes->find("\n_FBD_BODY") != std::string::npos);
#endif
}

std::vector<std::string> without_listed(const std::vector<std::string>& paths) {
  std::set<fs::path> projects;
  for (const std::string& path : paths) {
    if (has_extension(path, {".plcproj"})) projects.insert(fs::path(path).parent_path());
  }
  std::vector<std::string> out;
  for (const std::string& path : paths) {
    bool in_project = false;
    if (is_twincat(path) && !has_extension(path, {".plcproj"})) {
      for (fs::path folder = fs::path(path).parent_path();; folder = folder.parent_path()) {
        in_project = in_project || projects.count(folder) != 0;
        if (in_project || folder.empty() || folder == folder.parent_path()) break;
      }
    }
    if (!in_project) out.push_back(path);
  }
  return out;
}

std::string located_text(const xml::Finding& finding) {
  std::string out;
  if (!finding.pou.empty()) out += "POU " + finding.pou;
  if (finding.network != 0) {
    out += (out.empty() ? "network " : ", network ") + std::to_string(finding.network);
  }
  return out.empty() ? finding.text : out + ": " + finding.text;
}

void add_findings(base::Diagnostics& diagnostics, const std::vector<xml::Finding>& findings,
                  bool notes) {
  std::set<std::pair<uint32_t, std::string>> said;
  for (const xml::Finding& finding : findings) {
    const base::Severity severity = base::diagnostic_row(finding.code).severity;
    if (severity == base::Severity::kNote && !notes) continue;
    const bool again = severity != base::Severity::kError &&
                       !said.emplace(static_cast<uint32_t>(finding.code), finding.text).second;
    if (!again) diagnostics.add(finding.code, finding.span, located_text(finding), finding.fix);
  }
}

struct Importer::Readers {
  std::set<std::string> seen;  // canonical paths
#ifdef STC_HAS_XML
  xml::Imported current;
  twincat::Importer twincat{current};
  // Read when all are there: one declares what the boxes of another call.
  std::vector<std::pair<std::string, text_export::Export>> exports;  // by path
#endif
};

Importer::Importer(base::SourceMap& sources)
    : sources_(sources), readers_(std::make_unique<Readers>()) {}
Importer::~Importer() = default;

base::Status Importer::add(const std::string& path) {
  std::error_code error;
  const fs::path canonical = fs::canonical(path, error);
  if (!readers_->seen.insert(error ? path : canonical.string()).second) return base::Ok{};
#ifdef STC_HAS_XML
  // A byte more than allowed, so that the limit has its own message.
  base::Result<std::string> bytes = tools::read_text(path, 2ull * base::kMaxXmlBytes);
  if (!bytes.ok()) return bytes.error();
  read(path, *bytes);
  read_files.push_back({path, std::move(*bytes)});
  return base::Ok{};
#else
  return base::Error{base::Refusal::kFileUnreadable,
                     path +
                         ": import is not part of this stc: it was built without pugixml (package "
                         "libpugixml-dev)"};
#endif
}

#ifdef STC_HAS_XML

void Importer::take(const std::string& origin, xml::Imported& out) {
  for (xml::MadeSource& source : out.sources) made.push_back({origin, std::move(source)});
  findings.insert(findings.end(), std::make_move_iterator(out.findings.begin()),
                  std::make_move_iterator(out.findings.end()));
  kept.drawings.merge(out.kept.drawings);
  kept.data.merge(out.kept.data);
  kept.editor_data.merge(out.kept.editor_data);
  kept.object_ids.merge(out.kept.object_ids);
  kept.headers.insert(kept.headers.end(), out.kept.headers.begin(), out.kept.headers.end());
  kept.charts.merge(out.kept.charts);
  kept.declares_xhtml = kept.declares_xhtml || out.kept.declares_xhtml;
  kept.has_declarations = kept.has_declarations || out.kept.has_declarations;
  // A name is taken in all documents that are imported together.
  xml::Names names = std::move(out.names);
  out = {};
  out.names = std::move(names);
}

void Importer::read(const std::string& path, const std::string& bytes) {
  if (has_extension(path, {".exp"})) return read_export(path, bytes);
  xml::Imported& out = readers_->current;
  const xml::Document document(path, bytes, sources_, out);
  if (!document.root()) return take(path, out);
  if (twincat::is_object(document)) {
    readers_->twincat.add_object(document);
  } else if (twincat::is_project(document)) {
    std::vector<twincat::ListedFile> files = twincat::listed_files(document, out);
    const fs::path folder = fs::path(path).parent_path();
    for (const twincat::ListedFile& file : files) {
      const std::string found = find_listed(folder, file.path);
      base::Status status = base::Ok{};
      if (!found.empty()) {
        xml::Imported own;
        std::swap(own, out);
        out.names = std::move(own.names);
        status = add(found);
        own.names = std::move(out.names);
        std::swap(own, out);
      }
      if (found.empty() || !status.ok()) {
        xml::Reporter(document, out)
            .add(xml::Code::kProjectFileMissing, file.node,
                 "`" + file.path + "` is listed, but " +
                     (found.empty() ? "there is no such file" : "it cannot be read"));
      }
    }
  } else if (codesys::is_export(document)) {
    xml::Reporter report(document, out);
    codesys::Objects objects;
    codesys::read_objects(document, report, objects);
    report.set_origins(&objects.origins);
    readers_->twincat.add_objects(objects.document.first_child(), report);
  } else if (plcopen::is_document(document)) {
    plcopen::import(document, out);
  } else {
    xml::Reporter(document, out)
        .add(xml::Code::kUnknownXml, document.root(),
             "<" + std::string(xml::local_name(document.root())) +
                 "> begins nothing that can be imported");
  }
  take(path, out);
}

void Importer::read_export(const std::string& path, const std::string& bytes) {
  const bool fits = bytes.size() <= base::kMaxXmlBytes;
  const base::SourcePos begin =
      sources_.add(path, fits ? xml::text_as_utf8(bytes) : std::string(), base::TextUse::kQuoted);
  if (!fits) {
    readers_->current.add_finding({xml::Code::kXmlLimit,
                                   {begin, begin},
                                   {},
                                   0,
                                   "larger than " + std::to_string(base::kMaxXmlBytes) + " bytes",
                                   {}});
    return take(path, readers_->current);
  }
  const std::string_view text = sources_.text(sources_.file_count() - 1);
  readers_->exports.emplace_back(path, text_export::split(text, begin));
}

void Importer::finish() {
  readers_->twincat.add_tasks();
  take("tasks", readers_->current);
  if (readers_->exports.empty()) return;
  text_export::PinNames pins;
  for (const auto& [path, one] : readers_->exports) text_export::add_pins(one, pins);
  for (uint32_t file = 0; file < sources_.file_count(); ++file) {
    if (sources_.is_source(file)) pins.add(sources_.text(file));
  }
  for (const Made& one : made) pins.add(one.source.text);
  pins.add_library();
  for (const auto& [path, one] : readers_->exports) {
    text_export::import(one, pins, readers_->current);
    take(path, readers_->current);
  }
  readers_->exports.clear();
}

#else

void Importer::finish() {}

#endif

}  // namespace stc
