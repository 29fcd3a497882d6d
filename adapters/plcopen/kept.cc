// Bodies as they were drawn: an export writes the elements of the document again, with places, ids,
// divergences and what vendors add, where the text still says what they said.
#include <algorithm>
#include <sstream>

#include "adapters/plcopen/reader.h"
#include "adapters/plcopen/writer.h"
#include "base/name_case.h"

namespace plcopen {
namespace {

std::string prefix_of(Node node) {
  const std::string_view name = node.name();
  const size_t colon = name.rfind(':');
  return std::string(colon == std::string_view::npos ? std::string_view() : name.substr(0, colon));
}

// What the prefix of an element stands for, declared around it.
std::string space_of(Node node) {
  const std::string prefix = prefix_of(node);
  const std::string declared = prefix.empty() ? "xmlns" : "xmlns:" + prefix;
  for (Node at = node; at; at = at.parent()) {
    if (pugi::xml_attribute found = at.attribute(declared.c_str())) return found.value();
  }
  return {};
}

// A copy that needs no declarations around it: no prefixes, each change of namespace where it is.
void copy_plain(Node to, Node from, const std::string& around) {
  Node out = to.append_child(std::string(xml::local_name(from)).c_str());
  const std::string space = space_of(from);
  if (space != around) out.append_attribute("xmlns") = space.c_str();
  for (pugi::xml_attribute each : from.attributes()) {
    const std::string_view name = each.name();
    const std::string own(xml::local_name(name));
    if (name == "xmlns" || name.starts_with("xmlns:") || out.attribute(own.c_str())) continue;
    out.append_attribute(own.c_str()) = each.value();
  }
  for (Node below : from) {
    if (below.type() == pugi::node_element) {
      copy_plain(out, below, space);
    } else {
      out.append_copy(below);
    }
  }
}

}  // namespace

std::string plain_xml(Node node) {
  pugi::xml_document copy;
  copy_plain(copy, node, space_of(node));
  std::ostringstream text;
  copy.document_element().print(text, "", pugi::format_raw, pugi::encoding_utf8);
  return text.str();
}

void keep_chart(Node sfc, Node pou, const std::string& text, std::set<std::string> members,
                Reporter& report) {
  if (!xml::is(pou, "pou") || xml::children(pou, "body").size() != 1) return;
  xml::KeptChart& kept = report.out().kept.charts[base::fold_name(report.pou())];
  kept.chart = plain_xml(sfc);
  if (Node named = xml::child(pou, "transitions")) kept.transitions = plain_xml(named);
  kept.text = text;
  kept.members = std::move(members);
}

const xml::KeptChart* Writer::kept_chart(const Pou& pou) const {
  if (in_.kept == nullptr || in_.form == Edition::kIec10 || pou.chart == frontend::kNoChart) {
    return nullptr;
  }
  auto found = in_.kept->charts.find(base::fold_name(pou.name.text));
  if (found == in_.kept->charts.end()) return nullptr;
  const bool same = slice(pou.span).find(found->second.text) != std::string_view::npos;
  return same ? &found->second : nullptr;
}

}  // namespace plcopen
