// .plcproj: MSBuild's XML, of which the items count.
#include <algorithm>

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

}  // namespace

// IEC 61131-10 has a <Project>, too, in a namespace of its own.
bool is_project(const xml::Document& document) {
  return xml::is(document.root(), "Project") &&
         (xml::child(document.root(), "ItemGroup") || xml::child(document.root(), "PropertyGroup"));
}

std::vector<ListedFile> listed_files(const xml::Document& document, xml::Imported& out) {
  std::vector<ListedFile> files;
  xml::Reporter report(document, out);
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
      std::string path(report.required(item, "Include"));
      if (path.empty()) continue;
      std::replace(path.begin(), path.end(), '\\', '/');
      const bool excluded =
          xml::boolean(xml::trimmed(xml::text_of(xml::child(item, "ExcludeFromBuild"))))
              .value_or(false);
      if (excluded) {
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
