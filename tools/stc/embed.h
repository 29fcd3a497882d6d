// Sources that travel with the image (X9, `embed_sources` of stc.toml): every file that the project
// was read from, by its path from the folder of the project, and what `stc build` was told beside
// them, so that the same image can be built from what a controller has.
#pragma once

#include <map>
#include <string>

#include "base/result.h"
#include "ir/bytecode/embedded_sources.h"
#include "ir/bytecode/image_beside.h"
#include "tools/stc/project.h"

namespace stc {

class Embedding {
 public:
  // Nothing is embedded where the project does not want it. Errors: kBadProject of a file outside
  // of the folder, by a link or as typed; kTooMany.
  static base::Result<Embedding> of(const Project& project);

  // Where sources travel, names of files in the image are paths from the folder of the project,
  // too: those as typed are others at the next place.
  void name_files(ir::Image& image) const;
  // The image with named files, made in `copy`; the image itself where nothing travels.
  const ir::Image& named(const ir::Image& image, ir::Image& copy) const;
  // An image whose files are named so, with its sources.
  ir::WrittenImage encode(const ir::Image& image, const ir::KnownImage* known) const {
    return ir::encode(image, known, section_);
  }

 private:
  std::string path_of(const std::string& file) const;

  base::Bytes section_;                       // ir::encode_sources()
  std::map<std::string, std::string> paths_;  // by name as typed
};

}  // namespace stc
