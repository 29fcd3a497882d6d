// Values that a controller answers with, which may be hostile, as JSON: `stvm get --format json`.
// The input is a type, a line end and a literal. Whatever it is, the JSON is whole: as many
// brackets close as open outside of its strings.
#include <algorithm>
#include <string>
#include <string_view>

#include "base/check.h"
#include "tools/common/json.h"
#include "tools/stvm/json_value.h"

namespace {

int open_brackets(std::string_view json) {
  int depth = 0;
  bool text = false;
  for (size_t i = 0; i < json.size(); ++i) {
    if (text && json[i] == '\\') {
      ++i;
    } else if (json[i] == '"') {
      text = !text;
    } else if (!text) {
      depth += json[i] == '{' || json[i] == '[' ? 1 : json[i] == '}' || json[i] == ']' ? -1 : 0;
    }
  }
  return text ? 1000 : depth;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const size_t end = std::min(text.find('\n'), text.size());
  const std::string_view literal = text.substr(std::min(end + 1, text.size()));
  tools::JsonWriter json;
  stvm::typed_value(json, text.substr(0, end), literal);
  base::check(open_brackets(json.finish()) == 0, "whole JSON");
  return 0;
}
