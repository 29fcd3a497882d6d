// What an import makes of a document: sources as text, and findings about everything that is
// wrong in it or was left out. Nothing of pugixml here, so tools can hold results of an import
// whose library is missing.
#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "base/diagnostics.h"
#include "base/source.h"
#include "frontend/network/network.h"

namespace xml {

struct Finding {
  base::DiagnosticCode code;
  base::SourceSpan span;  // in the text of the document
  std::string pou;        // empty: outside of any
  uint32_t network = 0;   // of its body, from 1; 0: of none
  std::string text;
  std::string fix;
};

// `name` is that of a file, without folders: a POU, type or list of global variables and `.st`.
struct MadeSource {
  std::string name;
  std::string text;
};

// A body as it was drawn.
struct KeptDrawing {
  frontend::network::Body body;
  // What the text of a ladder that became FBD says, as network::canonical() has it.
  std::string text;
  std::string xml;  // <LD> or <FBD>, without prefixes; of IEC 61131-10 empty
};

// A chart as it was drawn: elements without prefixes.
struct KeptChart {
  std::string chart;        // <SFC>
  std::string transitions;  // <transitions> of its POU; may be empty
  std::string text;         // what was made of it
  // Actions that stood in steps and methods of conditions, by the names that they got, folded.
  std::set<std::string> members;
};

// <fileHeader> and <contentHeader> of a document, without prefixes and addData; either may be
// empty.
struct KeptHeader {
  std::string file;
  std::string content;
  std::string space;  // the namespace of the document
};

// What an export of the same writes again as it was.
struct Kept {
  std::vector<KeptHeader> headers;              // of each document
  std::map<std::string, KeptChart> charts;      // by POU
  std::map<std::string, KeptDrawing> drawings;  // by POU or POU.Member
  // <data> that nobody understood, and that of editors, by where it stands (plcopen/kept.cc).
  std::map<std::string, std::vector<std::string>> data;
  std::map<std::string, std::vector<std::string>> editor_data;
  std::map<std::string, std::string> object_ids;  // attributes ObjectId, likewise
  bool declares_xhtml = false;    // texts stand in <xhtml xmlns=...>, as CODESYS writes them
  bool has_declarations = false;  // as text beside their elements, likewise
};

// Names that are taken, in any case of letters.
class Names {
 public:
  // `name`, or `name_2` and so on when that is taken. Costs no more when many are alike.
  std::string take(std::string_view name);
  bool has(std::string_view name) const;

 private:
  std::unordered_map<std::string, uint32_t> taken_;  // folded; the next number to try
};

struct Imported {
  std::vector<MadeSource> sources;
  std::vector<Finding> findings;
  Kept kept;

  // `name.st`, or `name_2.st` when there is such a file already, in any case of letters.
  // The same name as returned, for sources that say it (lists of global variables).
  std::string add_source(std::string_view name, std::string text);

  // The finding, unless there are very many already. Errors are not lost among notes.
  void add_finding(Finding finding);

  bool failed() const;  // is one of the findings an error?

  Names names;  // of `sources`
};

}  // namespace xml
