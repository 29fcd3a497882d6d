// The row in front of a network that gives it a title or disables it, the same in both text forms:
//
//   {network 'Start the motor'}      {network disabled}      {network 'Test lamp' disabled}
//
// In FBD as text it also begins the next network; `{network}` does only that. A title stands in '
// or ", has no such mark inside and no braces: the first `}` ends the row's text.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace frontend::network {

struct Head {
  std::string title;
  bool disabled = false;
};

// `pragma` with its braces; nullopt when it says anything else.
std::optional<Head> read_head(std::string_view pragma);
inline constexpr std::string_view kHeadForm =
    "write {network 'title'}, {network disabled} or {network 'title' disabled} in a row of its own";

// Empty when there is nothing to say.
std::string head_text(std::string_view title, bool disabled);

// Any text as a title: one line without what a head cannot say.
std::string title_of(std::string_view text);

}  // namespace frontend::network
