// CODESYS V3: what "Project, Export" writes (.export) -> objects as those of TwinCAT
// (twincat/twincat.h), which are CODESYS' own. The file is a list of entries, each an object of the
// project with its name, its kind and that of its parent as numbers (GUIDs), and its declaration
// and body as text. No vendor describes it: what is read is what published exports and tools show.
// Drawn bodies are the inside of the editor, and errors (E1080).
#pragma once

#include <pugixml.hpp>
#include <unordered_map>

#include "adapters/xml/document.h"

namespace codesys {

bool is_export(const xml::Document& document);

struct Objects {
  pugi::xml_document document;  // <TcPlcObject> with all objects
  std::unordered_map<const void*, xml::Node> origins;
};

// Entries that are no sources are findings: what is of the editor only a note, else a warning.
void read_objects(const xml::Document& document, xml::Reporter& report, Objects& out);

}  // namespace codesys
