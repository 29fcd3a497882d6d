// stc explain online-edits (E-21): what can be edited online, so that an editor can grey the rest.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace stc {

// The page for the versions of stvm that are targets, as target_versions() gives them. `width` in
// columns.
std::string online_edits_page(const std::vector<std::string>& targets, uint32_t width);
std::string online_edits_json(const std::vector<std::string>& targets);

}  // namespace stc
