// Questions about arbitrary sources: every name has a symbol with a signature, and is found again
// at its place. The corpus are the golden files.
#include <ctime>
#include <string>

#include "base/check.h"
#include "frontend/questions/compilation.h"
#include "frontend/questions/questions.h"

namespace {

using namespace frontend::questions;

constexpr std::clock_t kMaxTime = 10 * CLOCKS_PER_SEC;  // of processor time
constexpr size_t kMostPlaces = 64;  // where types are asked: each goes through the code around it

void ask(frontend::Sema& sema, const base::SourceMap& sources) {
  Questions questions(sema);
  const Index& index = questions.index();
  for (const Symbol& symbol : index.symbols) {
    base::check(!questions.signature_of(symbol).text.empty(), "a symbol has a signature");
    for (const Occurrence& use : questions.uses_of(symbol)) {
      base::check(&index.symbols[use.symbol] == &symbol, "a use is one of its symbol");
    }
  }
  for (size_t i = 0; i < index.occurrences.size(); ++i) {
    const base::SourcePos pos = index.occurrences[i].span.begin;
    base::check(questions.symbol_at(pos) != nullptr, "a name is found at its place");
    if (i >= kMostPlaces) continue;
    (void)questions.type_at(pos);
    (void)questions.called_at(pos);
  }
  // Every place of the file, whether something stands there or not.
  const std::string_view text = sources.text(0);
  for (uint32_t line = 0; line < 40; ++line) {
    for (const uint32_t column : {0u, 1u, 7u, static_cast<uint32_t>(text.size()) + 1, ~0u}) {
      (void)questions.symbol_at(questions.place("fuzz.st", line, column));
    }
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const std::clock_t begin = std::clock();
  base::SourceMap sources;
  sources.add("fuzz.st", std::string(reinterpret_cast<const char*>(data), size));
  frontend::CompileOptions options;
  options.tests = size % 2 == 0;  // half of the inputs
  Compilation compilation(sources, options);
  if (compilation.sema() != nullptr) ask(*compilation.sema(), sources);
  base::check(std::clock() - begin < kMaxTime, "bounded time");
  return 0;
}
