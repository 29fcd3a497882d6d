#include "base/result.h"

#include <string_view>

namespace base {
namespace {

struct Row {
  const char* code;
  const char* title;
  const char* help;
};

constexpr Row kRows[] = {
#define REFUSAL(id, code, title, help) {code, title, help},
#include "base/refusals.def"
#undef REFUSAL
};

}  // namespace

const char* refusal_code(Refusal refusal) { return kRows[static_cast<size_t>(refusal)].code; }
const char* refusal_title(Refusal refusal) { return kRows[static_cast<size_t>(refusal)].title; }
const char* refusal_help(Refusal refusal) { return kRows[static_cast<size_t>(refusal)].help; }

std::optional<Refusal> refusal_from_code(std::string_view code) {
  for (size_t i = 0; i < std::size(kRows); ++i) {
    if (code == kRows[i].code) return static_cast<Refusal>(i);
  }
  return std::nullopt;
}

std::string to_string(const Error& error) {
  return std::string(refusal_code(error.refusal)) + ": " + error.text;
}

}  // namespace base
