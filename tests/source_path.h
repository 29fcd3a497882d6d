// Where the sources are, for tests that read examples and golden files.
#pragma once

#include <string>
#include <string_view>

namespace tests {

// `path` begins at the root of the sources.
std::string source_path(std::string_view path);

}  // namespace tests
