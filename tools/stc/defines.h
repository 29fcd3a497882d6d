// NAME and NAME=VALUE of --define and of `defines` in stc.toml.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace stc {

struct DefineMistake {
  size_t number;  // of the element
  std::string what;
};
// The first that has no name, or another value than an earlier one of its name.
std::optional<DefineMistake> mistake_in(const std::vector<std::string>& defines);

}  // namespace stc
