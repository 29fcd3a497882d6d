// The import of PLCopen XML and IEC 61131-10 over arbitrary bytes: no crash, no hang; what is made
// has names that stay in their folder, and nothing is made of a document that is no XML.
#include <cstddef>
#include <cstdint>
#include <string>

#include "adapters/plcopen/plcopen.h"
#include "tests/fuzz/imported.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  base::SourceMap sources;
  xml::Imported out;
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  const xml::Document document("fuzz.xml", bytes, sources, out);
  if (document.root()) plcopen::import(document, out);
  check_imported(document, out, sources);
  return 0;
}
