#include "tools/stc/defines.h"

#include <cctype>
#include <map>
#include <string_view>

#include "base/name_case.h"

namespace stc {
namespace {

bool is_name(std::string_view text) {
  if (text.empty() || std::isdigit(static_cast<unsigned char>(text[0])) != 0) return false;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x80 && std::isalnum(byte) == 0 && c != '_') return false;
  }
  return true;
}

}  // namespace

std::optional<DefineMistake> mistake_in(const std::vector<std::string>& defines) {
  std::map<std::string, const std::string*> known;
  for (size_t i = 0; i < defines.size(); ++i) {
    const std::string& text = defines[i];
    const std::string name = text.substr(0, text.find('='));
    if (!is_name(name)) {
      return DefineMistake{i,
                           "`" + text + "` does not begin with a name; write NAME or NAME=VALUE"};
    }
    const auto [at, added] = known.emplace(base::fold_name(name), &text);
    const std::string& before = *at->second;
    if (added || text.substr(name.size()) == before.substr(name.size())) continue;
    return DefineMistake{
        i, "`" + before + "` and `" + text + "` contradict each other; leave one out"};
  }
  return std::nullopt;
}

}  // namespace stc
