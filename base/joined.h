// A text of many parts in one piece. Messages are made so where code should be small: a chain of
// `+` takes several times as much.
#pragma once

#include <initializer_list>
#include <string>
#include <string_view>

namespace base {

std::string joined(std::initializer_list<std::string_view> parts);

}  // namespace base
