// PLCopen XML (TC6, 1.0 to 2.01) -> sources: one text per POU, type and list of global variables,
// and one per configuration. Elements are taken by local name, so every version's namespace will
// do. What a body does is never changed: what is not understood inside of one is an error (E1083);
// elsewhere it is a warning (W0070).
#pragma once

#include "adapters/xml/document.h"

namespace plcopen {

bool is_document(const xml::Document& document);
void import(const xml::Document& document, xml::Imported& out);
// The headers of a project, for an export; those of stc itself are written anew.
void keep_headers(xml::Node project, xml::Imported& out);
// The ids that editors give to objects below `node`, where they are attributes.
void keep_object_ids(xml::Node node, xml::Imported& out);

// addData of a block: what FBD as text calls the result of its function (WIRE name := ...).
inline constexpr const char* kWireData = "stc-wire";
// A comment that is a disabled network, and its text as <network language="LADDER">.
inline constexpr const char* kDisabledData = "stc-disabled";

}  // namespace plcopen
