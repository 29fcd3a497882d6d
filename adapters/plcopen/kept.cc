// Bodies as they were drawn: an export writes the elements of the document again, with places, ids,
// divergences and what vendors add, where the text still says what they said.
#include <algorithm>
#include <map>
#include <sstream>

#include "adapters/plcopen/reader.h"
#include "adapters/plcopen/writer.h"
#include "base/name_case.h"

namespace plcopen {
namespace {

std::string prefix_of(std::string_view name) {
  const size_t colon = name.rfind(':');
  return std::string(colon == std::string_view::npos ? std::string_view() : name.substr(0, colon));
}

// What a prefix stands for, declared around `node`.
std::string space_of(Node node, const std::string& prefix) {
  const std::string declared = prefix.empty() ? "xmlns" : "xmlns:" + prefix;
  for (Node at = node; at; at = at.parent()) {
    if (pugi::xml_attribute found = at.attribute(declared.c_str())) return found.value();
  }
  return {};
}

std::string space_of(Node node) { return space_of(node, prefix_of(node.name())); }

// Attributes of PLCopen have no prefix, whatever the document gave them; those of vendors keep it.
void copy_attribute(Node to, Node from, pugi::xml_attribute each) {
  const std::string_view name = each.name();
  if (name == "xmlns" || name.starts_with("xmlns:")) return;
  const std::string prefix = prefix_of(name);
  const std::string other = prefix.empty() ? std::string() : space_of(from, prefix);
  const bool ours = other.empty() || other.find("plcopen.org/xml/tc6") != std::string::npos;
  const bool own = prefix != "xml" && ours;
  const std::string copied(own ? xml::local_name(name) : name);
  if (to.attribute(copied.c_str())) return;
  const std::string declared = "xmlns:" + prefix;
  if (!own && prefix != "xml" && !to.attribute(declared.c_str())) {
    to.append_attribute(declared.c_str()) = other.c_str();
  }
  to.append_attribute(copied.c_str()) = each.value();
}

// A copy that needs no declarations around it: no prefixes of elements, each change of namespace
// where it is.
void copy_plain(Node to, Node from, const std::string& around) {
  Node out = to.append_child(std::string(xml::local_name(from)).c_str());
  const std::string space = space_of(from);
  if (space != around) out.append_attribute("xmlns") = space.c_str();
  for (pugi::xml_attribute each : from.attributes()) copy_attribute(out, from, each);
  for (Node below : from) {
    if (below.type() == pugi::node_element) {
      copy_plain(out, below, space);
    } else {
      out.append_copy(below);
    }
  }
}

// What of a project has names of its own, but for what is drawn. Empty: another element.
std::string_view declared(Node node) {
  static constexpr const char* kKinds[] = {
      "pou",       "action",    "Method",        "Property", "dataType", "globalVars",
      "interface", "Interface", "configuration", "resource", "task",     "pouInstance"};
  for (const char* kind : {"GetAccessor", "SetAccessor", "contentHeader"}) {
    if (xml::is(node, kind)) return kind;
  }
  if (xml::attribute(node, "name").empty()) return {};
  if (xml::is(node, "union")) return "dataType";  // it is written as one
  const auto found =
      std::ranges::find_if(kKinds, [&](const char* kind) { return xml::is(node, kind); });
  return found == std::end(kKinds) ? std::string_view() : *found;
}

// Names of these are those of their owner.
bool is_member(std::string_view kind) {
  for (const char* member :
       {"action", "Method", "Property", "GetAccessor", "SetAccessor", "task", "pouInstance"}) {
    if (kind == member) return true;
  }
  return false;
}

constexpr const char* kObjectId = "ObjectId";  // CODESYS

using Places = std::map<std::string, std::vector<std::string>>;

void put_data(Node owner, const std::string& place, Places& data) {
  auto found = data.find(place);
  if (found == data.end()) return;
  Node add = owner.child("addData");
  if (!add) add = owner.append_child("addData");
  for (const std::string& text : found->second) {
    add.append_buffer(text.data(), text.size(), xml::kAsRead);
  }
  data.erase(found);  // at the first of that name
}

using ObjectIds = std::map<std::string, std::string>;

void put_data_below(Node node, Places& data, ObjectIds& ids) {
  if (!declared(node).empty()) {
    const std::string place = place_of(node);
    put_data(node, place, data);
    if (auto found = ids.find(place); found != ids.end()) {
      node.append_attribute(kObjectId) = found->second.c_str();
      ids.erase(found);
    }
  }
  for (Node child : node.children()) {
    if (!xml::is(child, "body")) put_data_below(child, data, ids);
  }
}

}  // namespace

void keep_object_ids(Node node, xml::Imported& out) {
  const std::string id(xml::attribute(node, kObjectId));
  if (!id.empty() && !declared(node).empty()) out.kept.object_ids.emplace(place_of(node), id);
  for (Node child : xml::children(node)) {
    if (!xml::is(child, "body")) keep_object_ids(child, out);
  }
}

std::string place_of(Node node) {
  for (; node; node = node.parent()) {
    const std::string_view kind = declared(node);
    if (kind.empty()) continue;
    std::string out = is_member(kind) ? place_of(node.parent()) + "/" : std::string();
    return out + base::fold_name(kind) + " " + base::fold_name(xml::attribute(node, "name"));
  }
  return {};
}

void keep_editor_data(Node data, Reporter& report) {
  Node owner = data.parent().parent();
  // That of a POU, which is no declaration itself.
  if (xml::is(owner, "interface") && declared(owner).empty()) owner = owner.parent();
  if (declared(owner).empty() && !xml::is(owner, "project")) return;
  report.out().kept.editor_data[place_of(owner)].push_back(plain_xml(data));
}

// IEC 61131-10 has data of POUs and of the project, and none for editors of PLCopen XML.
void Writer::put_kept(Node project) {
  if (in_.kept == nullptr) return;
  const bool other = in_.form == Edition::kIec10;
  Places all = other ? Places() : in_.kept->editor_data;
  for (const auto& [place, texts] : in_.kept->data) {
    const bool pou = place.starts_with("pou ");
    std::string to = !other ? place : pou ? place.substr(0, place.find('/')) : std::string();
    std::vector<std::string>& out = all[std::move(to)];
    out.insert(out.end(), texts.begin(), texts.end());
  }
  put_data(project, {}, all);
  ObjectIds ids = other ? ObjectIds() : in_.kept->object_ids;
  put_data_below(project, all, ids);
}

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
