// IEC 61131-10 <-> PLCopen XML: the same data under other names, so each is made of the other.
// What is known of the format here comes from public descriptions of its schema by several of its
// users: types, POUs with parameters, ST, IL, LD and FBD, configurations. How it writes charts and
// properties is not known; documents that have them get an error (E1083, E1084).
#pragma once

#include <map>
#include <string>
#include <unordered_map>
#include <vector>

#include "adapters/xml/document.h"

namespace plcopen {

// Statements for other tools in the place of a body that no element says: an error, not nothing.
inline constexpr const char* kTextOnlyBody = "{error 'this body stands in the addData of stc'}";

bool is_iec10(const xml::Document& document);

// The document as PLCopen XML. Nodes of the result come from nodes of the document.
struct Converted {
  pugi::xml_document project;
  std::unordered_map<const void*, xml::Node> origins;
};
void from_iec10(xml::Node project, Converted& out, xml::Reporter& report);

// `project` in the namespace of 61131-10, appended to `out`. What it cannot say, by the POU or type
// that it stands in; empty: in none.
using Unsaid = std::map<std::string, std::vector<std::string>>;
Unsaid to_iec10(xml::Node project, pugi::xml_document& out);

}  // namespace plcopen
