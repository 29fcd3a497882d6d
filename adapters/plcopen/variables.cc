// Lists of variables: <localVars>, <inputVars> ... -> VAR ... END_VAR.
#include "adapters/plcopen/reader.h"

namespace plcopen {
namespace {

struct ListForm {
  const char* element;
  const char* word;
};
constexpr ListForm kLists[] = {
    {"localVars", "VAR"},         {"tempVars", "VAR_TEMP"},     {"inputVars", "VAR_INPUT"},
    {"outputVars", "VAR_OUTPUT"}, {"inOutVars", "VAR_IN_OUT"},  {"externalVars", "VAR_EXTERNAL"},
    {"globalVars", "VAR_GLOBAL"}, {"accessVars", "VAR_ACCESS"}, {"configVars", "VAR_CONFIG"}};

const ListForm* form_of(Node list) {
  for (const ListForm& form : kLists) {
    if (xml::is(list, form.element)) return &form;
  }
  return nullptr;
}

bool flag(Node node, const char* name, Reporter& report) {
  std::string_view text = xml::attribute(node, name);
  if (text.empty()) return false;
  std::optional<bool> value = xml::boolean(text);
  if (!value) {
    report.add(Code::kXmlBadValue, node,
               std::string(name) + "=\"" + std::string(text) + "\" is neither true nor false");
  }
  return value.value_or(false);
}

std::string qualifiers(Node list, Reporter& report) {
  std::string out;
  if (flag(list, "constant", report)) out += " CONSTANT";
  if (flag(list, "retain", report)) out += " RETAIN";
  if (flag(list, "persistent", report)) out += " PERSISTENT";
  if (flag(list, "nonretain", report)) out += " NON_RETAIN";
  return out;
}

// `path` of an access or configuration variable: names, dots, indices.
std::string path_of(Node node, const char* attribute, Reporter& report) {
  std::string text(xml::trimmed(report.required(node, attribute)));
  if (text.find_first_of(";:(){}") == std::string::npos) return text;
  report.add(Code::kXmlBadValue, node, "`" + text + "` is no path of a variable");
  return {};
}

std::string access_variable(Node node, Reporter& report) {
  const bool writes = xml::attribute(node, "direction") == "readWrite";
  return std::string(report.required_name(node, "alias")) + " : " +
         path_of(node, "instancePathAndName", report) + " : " +
         type_text(xml::child(node, "type"), report) + (writes ? " READ_WRITE" : " READ_ONLY");
}

std::string location(Node node, Reporter& report) {
  std::string address(xml::trimmed(xml::attribute(node, "address")));
  if (address.empty()) return {};
  if (address.find_first_of("; \t\n:") == std::string::npos && address[0] == '%') {
    return " AT " + address;
  }
  report.add(Code::kXmlBadValue, node, "`" + address + "` is no address");
  return {};
}

std::string variable(Node node, Reporter& report) {
  std::string out;
  if (xml::is(node, "accessVariable")) {
    out = access_variable(node, report);
  } else {
    out = xml::is(node, "configVariable") ? path_of(node, "instancePathAndName", report)
                                          : std::string(report.required_name(node));
    if (out.empty()) return {};
    out += location(node, report) + " : " + type_text(xml::child(node, "type"), report);
    const std::string_view edge = xml::attribute(node, "edge");  // IEC 61131-10
    if (edge == "rising") out += " R_EDGE";
    if (edge == "falling") out += " F_EDGE";
    std::string value = value_text(xml::child(node, "initialValue"), report);
    if (!value.empty()) out += " := " + value;
  }
  const std::string attributes = vendor_data(node, report).attributes;
  std::string note = documentation(node, " ");
  return attributes + out + ";" + (note.empty() ? "\n" : note);
}

}  // namespace

bool is_named_list(Node list) {
  return xml::is(list, "globalVars") && !xml::attribute(list, "name").empty();
}

std::string documentation(Node owner, std::string_view indent) {
  Node node = xml::child(owner, "documentation");
  return node ? xml::comment(xml::text_of(node), indent) : std::string();
}

std::string variable_list(Node list, Reporter& report) {
  Vendor vendor = vendor_data(list, report);
  if (!vendor.declaration.empty()) return vendor.declaration;
  if (vendor.mixed) {
    std::string out;
    for (Node each : xml::children(vendor.mixed)) {
      if (form_of(each) != nullptr) out += vendor.attributes + variable_list(each, report);
    }
    return documentation(list, "") + out;
  }
  std::string lines;
  for (Node below : xml::children(list)) {
    if (xml::is(below, "variable") || xml::is(below, "accessVariable") ||
        xml::is(below, "configVariable")) {
      lines += xml::indented(variable(below, report), kIndent);
    } else if (!xml::is(below, "addData") && !xml::is(below, "documentation")) {
      report.add(Code::kXmlNotUnderstood, below, xml::shown(below) + " is not known here");
    }
  }
  const ListForm* form = form_of(list);
  if (lines.empty() || form == nullptr) return {};
  return documentation(list, "") + vendor.attributes + form->word + qualifiers(list, report) +
         "\n" + lines + "END_VAR\n";
}

std::string variable_lists(Node parent, Reporter& report) {
  std::string out;
  for (Node list : xml::children(parent)) {
    if (form_of(list) != nullptr && !is_named_list(list)) out += variable_list(list, report);
  }
  return out;
}

}  // namespace plcopen
