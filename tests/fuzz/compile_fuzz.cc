// The whole compiler over arbitrary sources: either it says why not, or what it makes passes every
// check behind it, up to a verified image. The corpus are the golden files.
#include <cstdio>
#include <ctime>
#include <string>

#include "base/check.h"
#include "frontend/compile.h"
#include "frontend/warning_pragmas.h"
#include "ir/bytecode/verify.h"
#include "ir/lower/lower.h"
#include "ir/opt/optimise.h"
#include "ir/program/verify.h"
#include "linker/link.h"

namespace {

// Of processor time: far above what 8 KB of any source need, also under sanitizers.
constexpr std::clock_t kMaxTime = 10 * CLOCKS_PER_SEC;

void check(bool good, const char* what, const std::string& text) {
  if (!good) std::fprintf(stderr, "%s: %s\n", what, text.c_str());
  base::check(good, what);
}

bool compile_further(ir::Program program) {
  base::Status sound = ir::verify(program);
  check(sound.ok(), "the IR of a program without errors is sound",
        sound.ok() ? "" : base::to_string(sound.error()));
  base::Status optimised = ir::optimise(program, ir::PassSet::all(), true);
  check(optimised.ok(), "the optimiser leaves sound IR",
        optimised.ok() ? "" : base::to_string(optimised.error()));
  std::vector<ir::Object> objects;
  for (uint32_t i = 0; i < program.pous.size(); ++i) {
    base::Result<ir::Object> object = ir::lower(program, ir::PouId(i));
    // A POU may be too large; nothing else is in the way.
    if (!object.ok()) return !object.error().text.empty();
    objects.push_back(std::move(*object));
  }
  base::Result<ir::Image> image = linker::link(program, objects, {});
  if (!image.ok()) return !image.error().text.empty();
  auto verified = ir::verify(ir::encode(*image));
  check(verified.ok(), "what the linker made can be loaded",
        verified.ok() ? "" : base::to_string(verified.error()));
  return true;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const std::clock_t begin = std::clock();
  base::SourceMap sources;
  sources.add("fuzz.st", std::string(reinterpret_cast<const char*>(data), size));
  frontend::CompileOptions options;
  // Half of the inputs in each, by what every mutation may change.
  options.dialect = size % 2 == 0 ? frontend::Dialect::kCodesys : frontend::Dialect::kIec;
  base::WarningPolicy warnings;
  warnings.set_warnings_are_errors();
  const auto mistakes = frontend::silence_warnings(sources, options, warnings);
  base::Diagnostics diagnostics(warnings);
  for (const base::Diagnostic& mistake : mistakes) {
    base::check(!mistake.text.empty(), "a mistake in a pragma has a text");
  }
  auto program = frontend::compile(sources, options, diagnostics);
  base::check(program.has_value() != diagnostics.has_errors(),
              "a program, or an error that says why there is none");
  diagnostics.sort();
  base::check(!diagnostics.has_errors() ||
                  !base::render(diagnostics, sources, base::DiagnosticFormat::kText, false).empty(),
              "errors have a text");
  if (program) base::check(compile_further(*program), "a refusal has a text");
  base::check(std::clock() - begin < kMaxTime, "bounded time");
  return 0;
}
