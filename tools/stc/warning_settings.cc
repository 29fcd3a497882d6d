#include "tools/stc/warning_settings.h"

#include <set>

#include "base/joined.h"

namespace stc {
namespace {

base::Error bad_warning(std::initializer_list<std::string_view> parts) {
  return {base::Refusal::kUsage, base::joined(parts)};
}

}  // namespace

void apply_warning_table(const tools::ProjectFile& file, base::WarningPolicy& policy) {
  for (const auto& [name, value] : file.table) {
    if (!name.starts_with(tools::kWarningTable)) continue;
    const auto code = base::diagnostic_code(name.substr(tools::kWarningTable.size()));
    const std::string* const level = std::get_if<std::string>(&value.data);
    if (code && level != nullptr) policy.set(*code, *base::warning_level(*level));
  }
  bool as_errors = false;
  if (file.take<bool>("warnings.as_errors", as_errors) && as_errors) {
    policy.set_warnings_are_errors();
  }
}

base::Status apply_warning_options(const tools::Options& options, base::WarningPolicy& policy) {
  std::set<base::DiagnosticCode> given;
  for (const std::string& text : options.all("--warn")) {
    if (text == "error") {
      policy.set_warnings_are_errors();
      continue;
    }
    const size_t equals = text.find('=');
    if (equals == std::string::npos) {
      return bad_warning({"--warn ", text, ": neither `error` nor CODE=LEVEL, such as W0003=off"});
    }
    const std::string name = text.substr(0, equals);
    const std::string wrong = tools::warning_code_fault(name);
    if (!wrong.empty()) return bad_warning({"--warn ", text, ": ", wrong});
    const auto level = base::warning_level(text.substr(equals + 1));
    if (!level) {
      return bad_warning({"--warn ", text, ": the level is error, warning, note or off"});
    }
    const base::DiagnosticCode code = *base::diagnostic_code(name);
    if (!given.insert(code).second)
      return bad_warning({"--warn ", text, ": ", name, " is given twice"});
    policy.set(code, *level);
  }
  return base::Ok{};
}

}  // namespace stc
