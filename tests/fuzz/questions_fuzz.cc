// Questions about arbitrary sources: every name has a symbol with a signature, and is found again
// at its place. The corpus are the golden files.
#include <chrono>
#include <string>

#include "base/check.h"
#include "frontend/questions/compilation.h"
#include "frontend/questions/questions.h"

namespace {

using namespace frontend::questions;

constexpr double kMaxSeconds = 10;
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
  const auto begin = std::chrono::steady_clock::now();
  base::SourceMap sources;
  sources.add("fuzz.st", std::string(reinterpret_cast<const char*>(data), size));
  for (const bool tests : {false, true}) {
    frontend::CompileOptions options;
    options.tests = tests;
    Compilation compilation(sources, options);
    if (compilation.sema() != nullptr) ask(*compilation.sema(), sources);
  }
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
  base::check(took.count() < kMaxSeconds, "bounded time");
  return 0;
}
