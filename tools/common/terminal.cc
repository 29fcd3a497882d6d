#include "tools/common/terminal.h"

#include <unistd.h>

#include <cstdlib>
#include <string>

namespace tools {
namespace {

enum class When : unsigned char { kAuto, kAlways, kNever };
When chosen = When::kAuto;

std::string_view environment(const char* name) {
  const char* const value = std::getenv(name);
  return value == nullptr ? std::string_view() : value;
}

}  // namespace

void choose_colour(std::string_view when) {
  chosen = when == "always" ? When::kAlways : when == "never" ? When::kNever : When::kAuto;
}

bool has_colour(int descriptor) {
  if (chosen != When::kAuto) return chosen == When::kAlways;
  if (!environment("NO_COLOR").empty()) return false;
  const std::string_view forced = environment("CLICOLOR_FORCE");
  if (!forced.empty() && forced != "0") return true;
  return ::isatty(descriptor) != 0 && environment("TERM") != "dumb";
}

}  // namespace tools
