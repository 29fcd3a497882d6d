#include "tools/common/option_rows.h"

namespace tools {

std::vector<std::string> given_compile_options(const Options& options) {
  static constexpr OptionRow kRows[] = {TOOLS_COMPILE_OPTIONS};
  std::vector<std::string> out;
  for (const OptionRow& row : kRows) {
    const std::string name(long_name(row));
    for (const std::string& value : options.all(name)) out.push_back(name + "=" + value);
  }
  return out;
}

}  // namespace tools
