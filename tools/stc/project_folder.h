// The folder of a project: the one that was named, else what all that was named lies in. Files of
// the project are known by their path from there, whatever was typed.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/result.h"

namespace stc {

class ProjectFolder {
 public:
  // `paths`: as typed, at least one.
  explicit ProjectFolder(const std::vector<std::string>& paths);

  // By its name alone; as typed when it is outside.
  std::string path_of(const std::string& file) const;
  // A path that leads below the folder and nowhere else, also by links. Errors: kBadProject.
  base::Result<std::string> true_path_of(const std::string& file) const;

 private:
  std::filesystem::path folder_;
  std::filesystem::path real_;
};

}  // namespace stc
