// The import of text exports over arbitrary bytes: no crash, no hang; what is made has names that
// stay in their folder, and a body that is not read is never taken for an empty one.
#include <cstddef>
#include <cstdint>
#include <string>

#include "adapters/text_export/text_export.h"
#include "tests/fuzz/imported.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  base::SourceMap sources;
  xml::Imported out;
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  const base::SourcePos begin =
      sources.add("fuzz.exp", xml::text_as_utf8(bytes), base::TextUse::kQuoted);
  const text_export::Export one = text_export::split(sources.text(0), begin);
  text_export::PinNames pins;
  text_export::add_pins(one, pins);
  // Of the library as few as a corpus calls: it is large.
  pins.add(
      "FUNCTION_BLOCK TON VAR_INPUT IN : BOOL; PT : TIME; END_VAR "
      "VAR_OUTPUT Q : BOOL; ET : TIME; END_VAR END_FUNCTION_BLOCK");
  text_export::import(one, pins, out);
  text_export::is_more_than_text(one);
  check_imported(out, sources);
  for (const xml::MadeSource& made : out.sources) {
    base::check(made.text.find("{error '") == std::string::npos || out.failed(),
                "what is not imported has an error");
  }
  return 0;
}
