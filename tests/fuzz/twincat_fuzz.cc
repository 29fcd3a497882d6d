// The import of objects and projects of TwinCAT, and of exports of CODESYS, over arbitrary bytes:
// no crash, no hang; what is made has names that stay in their folder, and nothing is made of a
// document that is no XML.
#include <cstddef>
#include <cstdint>
#include <string>

#include "adapters/codesys/export_file.h"
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
    xml::Reporter report(document, out);
    codesys::Objects objects;
    codesys::read_objects(document, report, objects);
    report.set_origins(&objects.origins);
    importer.add_objects(objects.document.first_child(), report);
  }
  check_imported(document, out, sources);
  return 0;
}
