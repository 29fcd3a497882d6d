// Which files are sources: by their names, in folders, and as `sources` of stc.toml lists them.
#pragma once

#include <string>
#include <vector>

#include "tools/common/outputs.h"
#include "tools/common/project_file.h"

namespace stc {

using tools::is_source_name;
// `path` itself, or the sources in that folder and below it, sorted. Errors: kFileNotFound,
// kFileUnreadable.
base::Result<std::vector<std::string>> source_files(const std::string& path);
// The same list for files of other tools (importer.h); of `.xml` only with `any_xml`.
base::Result<std::vector<std::string>> importable_files(const std::string& path, bool any_xml);

// What `sources = [...]` names, each file once: files, folders with all below them, and patterns of
// paths, in which `*` and `?` stay inside of a name and `**` is any number of folders. The order is
// that of the list, and sorted inside of an element. An element that names nothing is an error with
// its place.
base::Result<std::vector<std::string>> listed_sources(const tools::ProjectFile& file,
                                                      const tools::TomlValue& list);

}  // namespace stc
