// The import of PLCopen XML and IEC 61131-10 over arbitrary bytes: no crash, no hang; what is made has names that
// stay in their folder, and nothing is made of a document that is no XML.
#include <cstddef>
#include <cstdint>
#include <string>

#include "adapters/plcopen/plcopen.h"
#include "base/check.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  base::SourceMap sources;
  xml::Imported out;
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  const xml::Document document("fuzz.xml", bytes, sources, out);
  base::check(document.root() || out.failed(), "a document that is not read has an error");
  if (document.root()) plcopen::import(document, out);
  for (const xml::MadeSource& made : out.sources) {
    base::check(made.name.ends_with(".st") &&
                    xml::is_name(std::string_view(made.name).substr(0, made.name.size() - 3)),
                "a source has the name of what is in it");
    base::check(made.text.find('\0') == std::string::npos, "a source is text");
  }
  for (const xml::Finding& finding : out.findings) {
    base::check(finding.span.begin.offset <= sources.text(0).size(), "a finding has a place");
    base::check(!finding.text.empty(), "a finding says something");
  }
  return 0;
}
