// Text inside of XML and HTML.
#pragma once

#include <string>
#include <string_view>

namespace stc {

// Characters that XML 1.0 cannot hold become `?`.
std::string markup_text(std::string_view text);

}  // namespace stc
