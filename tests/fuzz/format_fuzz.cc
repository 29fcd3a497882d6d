// The formatter over arbitrary bytes: either an error and no text, or the same program (checked
// inside), whose second formatting changes nothing. Also without the parser, so that texts that are
// no programs get past the first step (they come to an end, twice), and with narrow lines, so that
// everything is broken.
#include <cstddef>
#include <cstdint>
#include <string>

#include "base/check.h"
#include "frontend/format/format.h"
#include "frontend/parse/parse.h"

namespace {

using frontend::FormatOptions;

bool is_no_program(const base::SourceMap& sources) {
  base::Diagnostics diagnostics;
  frontend::Tree tree;
  frontend::parse(sources, 0, tree, diagnostics);
  return diagnostics.has_errors();
}

void check_format(std::string text, const FormatOptions& options, bool parsed) {
  auto run = parsed ? frontend::format : frontend::format_tokens;
  base::SourceMap sources;
  sources.add("fuzz.st", std::move(text));
  base::Diagnostics diagnostics;
  base::Result<std::string> once = run(sources, 0, options, diagnostics);
  // Of text that is no program the check inside may say no: `a` and `S=1` in two rows is `a S= 1`
  // in one. Its rows may mean other things once it is laid out, so the second result may differ.
  const bool no_program = !parsed && is_no_program(sources);
  if (!once.ok()) {
    if (no_program) return;
    base::check(once.error().refusal == base::Refusal::kSourceErrors, once.error().text.c_str());
    return;
  }
  sources.add("formatted.st", *once);
  base::Result<std::string> twice = run(sources, 1, options, diagnostics);
  if (no_program) return;
  base::check(twice.ok(), "what was formatted can be formatted");
  base::check(*twice == *once, "formatting the result again changes nothing");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  std::string text(reinterpret_cast<const char*>(data), size);
  FormatOptions usual;
  FormatOptions narrow;
  narrow.width = 40;
  narrow.indent = 4;
  narrow.align_assignments = true;
  for (const FormatOptions& options : {usual, narrow}) {
    check_format(text, options, true);
    check_format(text, options, false);
  }
  return 0;
}
