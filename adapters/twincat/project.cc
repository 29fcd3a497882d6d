// .plcproj: MSBuild's XML, of which the items count.
#include <map>
#include <optional>

#include "adapters/twincat/twincat.h"
#include "base/name_case.h"

namespace twincat {
namespace {

using xml::Code;
using xml::Node;

bool has_extension(std::string_view path, std::string_view extension) {
  return path.size() >= extension.size() &&
         base::same_name(path.substr(path.size() - extension.size()), extension);
}

bool is_known(std::string_view path) {
  for (const char* extension : {".TcPOU", ".TcDUT", ".TcGVL", ".TcIO", ".TcTTO"}) {
    if (has_extension(path, extension)) return true;
  }
  return false;
}

bool is_item(std::string_view name) {
  return name == "PlaceholderReference" || name == "LibraryReference" ||
         name == "PlaceholderResolution" || name == "None" || name == "Content";
}

int hex_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  const char lower = static_cast<char>(c | 0x20);
  return lower >= 'a' && lower <= 'f' ? lower - 'a' + 10 : -1;
}

// Of an item, with `/`; MSBuild escapes what has a meaning for it: `%28` is `(`.
std::string path_of(std::string_view include) {
  std::string out;
  for (size_t i = 0; i < include.size(); ++i) {
    const bool escape = include[i] == '%' && i + 2 < include.size() &&
                        hex_digit(include[i + 1]) >= 0 && hex_digit(include[i + 2]) >= 0;
    if (escape) {
      out += static_cast<char>(hex_digit(include[i + 1]) * 16 + hex_digit(include[i + 2]));
      i += 2;
    } else {
      out += include[i] == '\\' ? '/' : include[i];
    }
  }
  return out;
}

std::optional<bool> own_exclusion(Node item) {
  const Node excluded = xml::child(item, "ExcludeFromBuild");
  if (!excluded) return std::nullopt;
  return xml::boolean(xml::trimmed(xml::text_of(excluded)));
}

// By folder, `/` behind it; names of files on Windows have no case.
std::map<std::string, bool> folder_exclusions(Node project) {
  std::map<std::string, bool> out;
  for (Node group : xml::children(project, "ItemGroup")) {
    for (Node folder : xml::children(group, "Folder")) {
      std::string path = base::fold_name(path_of(xml::attribute(folder, "Include")));
      while (path.ends_with('/')) path.pop_back();
      const std::optional<bool> excluded = own_exclusion(folder);
      if (!path.empty() && excluded) out[path] = *excluded;
    }
  }
  return out;
}

// The innermost one that says something counts, and before it the file itself.
bool is_excluded(Node item, std::string_view path, const std::map<std::string, bool>& folders) {
  if (const std::optional<bool> own = own_exclusion(item)) return *own;
  std::string folder = base::fold_name(path);
  for (size_t slash; (slash = folder.rfind('/')) != std::string::npos;) {
    folder.resize(slash);
    if (auto found = folders.find(folder); found != folders.end()) return found->second;
  }
  return false;
}

}  // namespace

// IEC 61131-10 has a <Project>, too, in a namespace of its own.
bool is_project(const xml::Document& document) {
  return xml::is(document.root(), "Project") &&
         (xml::child(document.root(), "ItemGroup") || xml::child(document.root(), "PropertyGroup"));
}

std::vector<ListedFile> listed_files(const xml::Document& document, xml::Imported& out) {
  std::vector<ListedFile> files;
  xml::Reporter report(document, out);
  const std::map<std::string, bool> folders = folder_exclusions(document.root());
  for (Node group : xml::children(document.root(), "ItemGroup")) {
    for (Node item : xml::children(group)) {
      const std::string_view kind = xml::local_name(item);
      if (kind != "Compile") {
        if (!is_item(kind)) continue;
        report.add(Code::kXmlLeftOut, item,
                   "<" + std::string(kind) + "> `" + std::string(xml::attribute(item, "Include")) +
                       "`: libraries and other files of the project are not imported");
        continue;
      }
      std::string path = path_of(report.required(item, "Include"));
      if (path.empty()) continue;
      if (is_excluded(item, path, folders)) {
        report.add(Code::kXmlLeftOut, item, "`" + path + "` is excluded from the build");
      } else if (!is_known(path)) {
        report.add(Code::kXmlNotUnderstood, item, "`" + path + "` is of a kind not known here");
      } else {
        files.push_back({std::move(path), item});
      }
    }
  }
  return files;
}

}  // namespace twincat
