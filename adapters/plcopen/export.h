// Sources -> PLCopen XML: what the syntax tree says, with bodies as they stand in the sources.
// What elements of the standard cannot say is written as CODESYS writes it, in addData (methods,
// properties, inheritance, attributes), and where that is not enough the declaration stands there
// as text, so that import() of the document gives the same program. The sources themselves stand
// in addData of our own (source_text.h); what only they say is a warning (W0074). Without them it
// is an error (E1084), and there is no document then.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "adapters/xml/imported.h"
#include "frontend/parse/tree.h"

namespace plcopen {

enum class Edition : uint8_t { kTc6v200, kTc6v201, kIec10 };
std::optional<Edition> form_of_name(std::string_view name);  // tc6-2.0, tc6-2.01, 61131-10
// That of the one document that was read, so that the tool that wrote it knows it again.
Edition usual_form(const xml::Kept& kept);

struct ExportInput {
  const base::SourceMap& sources;
  const frontend::Tree& tree;
  std::string name;  // of the project
  Edition form = Edition::kTc6v201;
  // What is kept of documents that were imported and are written again: drawings with their places
  // and ids, by POU or POU.Action, and addData that nobody understood, by POU.
  const xml::Kept* kept = nullptr;
  bool with_sources = true;               // their text, for import() alone
  std::vector<std::string> defines = {};  // what the tree was made with, for {IF ...}
};

// The whole document, in UTF-8.
std::optional<std::string> export_document(const ExportInput& input,
                                           base::Diagnostics& diagnostics);

}  // namespace plcopen
