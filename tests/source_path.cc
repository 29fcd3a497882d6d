#include "tests/source_path.h"

namespace tests {

// Here alone: a test that knew the folder would be compiled anew for each checkout.
std::string source_path(std::string_view path) {
  return std::string(STC_SOURCE_DIR "/") + std::string(path);
}

}  // namespace tests
