// The sources of a generated project.
#pragma once

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "base/source.h"

namespace bench {

// All .st files of the folder, by name; adds to `lines` how many lines they have.
inline base::SourceMap read_sources(const std::string& folder, uint64_t& lines) {
  std::vector<std::filesystem::path> paths;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() == ".st") paths.push_back(entry.path());
  }
  std::sort(paths.begin(), paths.end());
  base::SourceMap sources;
  for (const std::filesystem::path& path : paths) {
    std::ostringstream text;
    text << std::ifstream(path).rdbuf();
    lines += static_cast<uint64_t>(std::count(text.view().begin(), text.view().end(), '\n'));
    sources.add(path.string(), text.str());
  }
  return sources;
}

}  // namespace bench
