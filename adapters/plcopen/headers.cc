// <fileHeader> and <contentHeader>: who made a document, with what, and how its drawings are
// scaled. An export of one document keeps them, so that the tool that made it takes it for its own.
#include <sstream>

#include "adapters/plcopen/plcopen.h"
#include "adapters/plcopen/reader.h"
#include "adapters/plcopen/writer.h"

namespace plcopen {

namespace {

constexpr const char* kOwnName = "stc";

// As TC6 demands it, where it is missing.
void need(Node node, const char* attribute, const char* value) {
  if (!node.attribute(attribute)) node.append_attribute(attribute) = value;
}

// The child of that name; made in front of `before` where it is missing.
Node need_child(Node node, const char* name, Node before = {}) {
  if (Node there = node.child(name)) return there;
  return before ? node.insert_child_before(name, before) : node.append_child(name);
}

// Writes `text`, one element, or begins an empty one.
Node put_element(Node project, const std::string& text, const char* name) {
  if (!text.empty()) project.append_buffer(text.data(), text.size(), xml::kAsRead);
  return need_child(project, name);
}

void put_scaling(Node content) {
  Node before = content.child("addDataInfo");
  if (!before) before = content.child("documentation");
  Node coordinates = need_child(content, "coordinateInfo", before);
  for (const char* language : {"fbd", "ld", "sfc"}) {
    Node scaling = need_child(need_child(coordinates, language), "scaling");
    need(scaling, "x", "1");
    need(scaling, "y", "1");
  }
}

}  // namespace

void keep_headers(Node project, xml::Imported& out) {
  if (!xml::is(project, "project")) return;
  xml::KeptHeader kept;
  const Node file = xml::child(project, "fileHeader");
  const bool own = xml::attribute(file, "productName") == kOwnName;
  if (file && !own) kept.file = plain_xml(file);
  if (const Node content = xml::child(project, "contentHeader"); content && !own) {
    pugi::xml_document copy;
    copy.load_string(plain_xml(content).c_str(), xml::kAsRead);
    while (copy.first_child().remove_child("addData")) continue;  // put_kept() writes it
    std::ostringstream text;
    copy.first_child().print(text, "", pugi::format_raw, pugi::encoding_utf8);
    kept.content = text.str();
  }
  for (pugi::xml_attribute each : project.attributes()) {
    const std::string_view value = each.value();
    if (value.find("plcopen.org/xml/tc6") != std::string_view::npos) kept.space = value;
  }
  out.kept.headers.push_back(std::move(kept));
}

Edition usual_form(const xml::Kept& kept) {
  const bool old = kept.headers.size() == 1 && kept.headers[0].space.ends_with("/tc6_0200");
  return old ? Edition::kTc6v200 : Edition::kTc6v201;
}

void put_headers(Node project, const ExportInput& input) {
  xml::KeptHeader kept;
  if (input.kept != nullptr && input.kept->headers.size() == 1) kept = input.kept->headers[0];
  Node file = put_element(project, kept.file, "fileHeader");
  need(file, "companyName", "");
  need(file, "productName", kOwnName);
  need(file, "productVersion", STC_VERSION);
  // No clock: the same sources give the same document.
  need(file, "creationDateTime", "1970-01-01T00:00:00");
  Node content = put_element(project, kept.content, "contentHeader");
  need(content, "name", input.name.c_str());
  put_scaling(content);
}

}  // namespace plcopen
