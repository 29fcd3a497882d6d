#include "base/result.h"

#include <string_view>

namespace base {
namespace {

struct Row {
  const char* code;
  const char* title;
  const char* help;
};

constexpr Row kRefusals[] = {
#define REFUSAL(id, code, title, help) {code, title, help},
#include "base/refusals.def"
#undef REFUSAL
};

// The enumeration is made of the table by another way (scripts/enumerations.cmake).
constexpr Refusal kRefusalsInOrder[] = {
#define REFUSAL(id, code, title, help) Refusal::id,
#include "base/refusals.def"
#undef REFUSAL
};
static_assert([] {
  for (size_t i = 0; i < std::size(kRefusalsInOrder); ++i) {
    if (static_cast<size_t>(kRefusalsInOrder[i]) != i) return false;
  }
  return true;
}());

}  // namespace

const char* refusal_code(Refusal refusal) { return kRefusals[static_cast<size_t>(refusal)].code; }
const char* refusal_title(Refusal refusal) { return kRefusals[static_cast<size_t>(refusal)].title; }
const char* refusal_help(Refusal refusal) { return kRefusals[static_cast<size_t>(refusal)].help; }

std::optional<Refusal> refusal_from_code(std::string_view code) {
  for (size_t i = 0; i < std::size(kRefusals); ++i) {
    if (code == kRefusals[i].code) return static_cast<Refusal>(i);
  }
  return std::nullopt;
}

std::string to_string(const Error& error) {
  return std::string(refusal_code(error.refusal)) + ": " + error.text;
}

}  // namespace base
