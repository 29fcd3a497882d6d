// A file that was read beside the sources of a project: settings, a document that was imported.
#pragma once

#include <string>

namespace stc {

struct ReadFile {
  std::string path;  // as typed
  std::string text;  // its bytes
};

}  // namespace stc
