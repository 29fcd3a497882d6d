// What an import of arbitrary bytes may make, for the targets of all formats: names that stay in
// their folder, and nothing of a document that is no XML.
#pragma once

#include <string_view>

#include "adapters/xml/document.h"
#include "base/check.h"

inline void check_imported(const xml::Imported& out, const base::SourceMap& sources) {
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
}

inline void check_imported(const xml::Document& document, const xml::Imported& out,
                           const base::SourceMap& sources) {
  base::check(document.root() || out.failed(), "a document that is not read has an error");
  check_imported(out, sources);
}
