#include "tools/common/source_edits.h"

#include <map>

#include "ir/bytecode/embedded_sources.h"

namespace tools {
namespace {

constexpr size_t kMostRows = 12;

using Files = std::map<std::string, const ir::SourceFile*>;

Files files_of(const ir::EmbeddedSources& sources) {
  Files out;
  for (const ir::SourceFile& file : sources.files) out[file.path] = &file;
  return out;
}

std::string count(size_t files) {
  return std::to_string(files) + (files == 1 ? " file" : " files");
}

SystemEdits file_edits(const Files& before, const Files& after) {
  SystemEdits rows;
  for (const auto& [path, file] : before) {
    const auto now = after.find(path);
    if (now == after.end()) {
      rows.push_back({"source", path, "removed"});
    } else if (now->second->digest != file->digest) {
      rows.push_back({"source", path, "edited"});
    }
  }
  for (const auto& [path, file] : after) {
    if (!before.contains(path)) rows.push_back({"source", path, "new"});
  }
  return rows;
}

SystemEdits edits(const ir::EmbeddedSources& before, const ir::EmbeddedSources& after) {
  if (before.none() && after.none()) return {};
  if (before.none()) {
    return {{"source", count(after.files.size()), "travel with the program from now on"}};
  }
  if (after.none()) {
    return {{"source", count(before.files.size()), "travel with the program no longer"}};
  }
  SystemEdits rows = file_edits(files_of(before), files_of(after));
  if (rows.size() > kMostRows) {
    const size_t left = rows.size() - (kMostRows - 1);
    rows.resize(kMostRows - 1);
    rows.push_back({"source", count(left) + " more", "`stc diff --text` shows all"});
  }
  if (before.build != after.build) rows.push_back({"source", "options", "of the build differ"});
  return rows;
}

}  // namespace

SystemEdits source_edits(base::ByteSpan old_image, base::ByteSpan new_image) {
  const base::Result<ir::EmbeddedSources> before = ir::sources_of(old_image);
  const base::Result<ir::EmbeddedSources> after = ir::sources_of(new_image);
  return before.ok() && after.ok() ? edits(*before, *after) : SystemEdits();
}

}  // namespace tools
