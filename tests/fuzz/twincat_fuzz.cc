// The import of objects and projects of TwinCAT over arbitrary bytes: no crash, no hang; what is
// made has names that stay in their folder, and nothing is made of a document that is no XML.
#include <cstddef>
#include <cstdint>
#include <string>

#include "adapters/twincat/twincat.h"
#include "tests/fuzz/imported.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  base::SourceMap sources;
  xml::Imported out;
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  const xml::Document document("fuzz.TcPOU", bytes, sources, out);
  if (document.root()) {
    twincat::Importer importer(out);
    importer.add_object(document);
    importer.add_tasks();
    twincat::listed_files(document, out);
  }
  check_imported(document, out, sources);
  return 0;
}
