// What vendors keep in addData. Understood is what CODESYS and its kin write of objects: methods,
// properties, inheritance, access, attributes, and declarations as text.
#include <algorithm>

#include "adapters/plcopen/reader.h"
#include "adapters/plcopen/source_text.h"
#include "base/name_case.h"

namespace plcopen {
namespace {

// Data of the editor or the project's tree; without them the program is the same.
constexpr const char* kEditor[] = {
    "objectid",       "projectstructure", "projectinformation", "buildproperties",  "tasksettings",
    "fbdelementtype", "fbdcalltype",      "inputparamtypes",    "outputparamtypes", "pou",
    "datatype",       "globalvars",       "application",        "interface",        "method",
    "property",       "action",           "libraries"};

// The names below `node` in elements `kind`, and whether all of them are names.
std::string names(Node node, const char* kind, const char* word, Reporter& report) {
  std::string out;
  for (Node each : xml::children(node, kind)) {
    std::string name(xml::trimmed(xml::text_of(each)));
    const bool good = !name.empty() && std::all_of(name.begin(), name.end(), [](char c) {
      return c == '.' || (c >= '0' && c <= '9') || xml::is_name(std::string_view(&c, 1));
    });
    if (good) {
      out += (out.empty() ? std::string(" ") + word + " " : ", ") + name;
    } else {
      report.add(Code::kXmlBadValue, each, "`" + name + "` is no name of a block or interface");
    }
  }
  return out;
}

std::string access_words(Node data) {
  static constexpr const char* kWords[] = {"Private", "Protected", "Internal", "Abstract", "Final"};
  std::string out;
  for (const char* word : kWords) {
    if (!xml::boolean(xml::attribute(xml::child(data, "AccessModifiers"), word)).value_or(false)) {
      continue;
    }
    for (const char* c = word; *c != 0; ++c) {
      out += *c >= 'a' && *c <= 'z' ? static_cast<char>(*c - 32) : *c;
    }
    out += ' ';
  }
  return out;
}

std::string declaration_of(Node node) {
  Node text = xml::child(node, "InterfaceAsPlainText");
  std::string out = text ? xml::text_of(text) : std::string();
  return out.empty() ? out : out + "\n";
}

}  // namespace

// What export makes of rules; "" for every other attribute.
static std::string rule_line(std::string_view name, std::string_view value) {
  const auto quoted = [](std::string_view text) { return "'" + std::string(text) + "'"; };
  const bool renamed = name.starts_with("renamed ") && name.ends_with(" from");
  if (!renamed && name != "renamed from" && name != "migration of") return {};
  std::string out = renamed && name.size() > 13
                        ? "renamed '" + std::string(name.substr(8, name.size() - 13)) + "' from"
                        : std::string(name);
  std::string between = " := ";
  while (!value.empty()) {
    const size_t end = std::min(value.find(", "), value.size());
    const std::string_view piece = value.substr(0, end);
    const bool rule = name == "migration of";
    if (rule && piece == "inverse") {
      out += ", inverse";
    } else if (rule && piece.starts_with("from ")) {
      out += ", from := " + quoted(piece.substr(5));
    } else {
      out += between + quoted(piece);
    }
    between = ", ";
    value.remove_prefix(std::min(end + 2, value.size()));
  }
  return "{" + out + "}\n";
}

std::string attribute_lines(Node data) {
  std::string out;
  for (Node each : xml::children(xml::child(data, "Attributes"), "Attribute")) {
    std::string name(xml::attribute(each, "Name"));
    std::string value(xml::attribute(each, "Value"));
    for (char& c : name) c = c == '\'' || c == '}' || c == '{' ? '_' : c;
    for (char& c : value) c = c == '\'' || c == '}' || c == '{' ? '_' : c;
    if (const std::string rule = rule_line(name, value); !rule.empty()) {
      out += rule;
      continue;
    }
    out += "{attribute '" + name + "'" + (value.empty() ? "" : " := '" + value + "'") + "}\n";
  }
  return out;
}

bool is_vendor(Node data, std::string_view name) {
  std::string_view own = xml::attribute(data, "name");
  const size_t slash = own.rfind('/');
  return base::same_name(slash == std::string_view::npos ? own : own.substr(slash + 1), name);
}

std::vector<Node> vendor_parts(Node owner) {
  std::vector<Node> out;
  for (Node part : {owner, xml::child(owner, "interface")}) {
    for (Node add : xml::children(part, "addData")) {
      std::vector<Node> found = xml::children(add, "data");
      out.insert(out.end(), found.begin(), found.end());
    }
  }
  return out;
}

bool is_excluded(Node owner, Reporter& report) {
  for (Node data : vendor_parts(owner)) {
    if (!is_vendor(data, "buildproperties")) continue;
    const Node said = data.find_node([](Node node) { return xml::is(node, "ExcludeFromBuild"); });
    if (!xml::boolean(xml::trimmed(xml::text_of(said))).value_or(false)) continue;
    report.add(Code::kXmlLeftOut, owner,
               "`" + std::string(xml::attribute(owner, "name")) + "` is excluded from the build");
    return true;
  }
  return false;
}

void report_data(Node data, Reporter& report) {
  if (is_source_data(data) || is_chart_data(data)) return;
  const std::string name(xml::attribute(data, "name"));
  for (const char* known : kEditor) {
    if (!is_vendor(data, known)) continue;
    keep_editor_data(data, report);
    return report.add(Code::kXmlLeftOut, data, "addData `" + name + "` is of the editor only");
  }
  if (xml::attribute(data, "handleUnknown") == "discard") {
    keep_editor_data(data, report);
    return report.add(Code::kXmlLeftOut, data,
                      "addData `" + name + "` is not needed by others, as it says itself");
  }
  report.add(Code::kXmlNotUnderstood, data, "addData `" + name + "` is not understood");
  report.out().kept.data[place_of(data)].push_back(plain_xml(data));
}

Vendor vendor_data(Node owner, Reporter& report) {
  Vendor out;
  out.declaration = declaration_of(owner);  // some stand beside addData
  for (Node data : vendor_parts(owner)) {
    if (is_vendor(data, "attributes")) {
      out.attributes += attribute_lines(data);
    } else if (is_vendor(data, "interfaceasplaintext")) {
      out.declaration = declaration_of(data);
      report.out().kept.has_declarations = true;
    } else if (is_vendor(data, "mixedattrsvarlist")) {
      out.mixed = xml::child(data, "MixedAttrsVarList");
    } else if (is_vendor(data, "accessmodifiers")) {
      out.access += access_words(data);
    } else if (is_vendor(data, "pouinheritance")) {
      Node inheritance = xml::child(data, "Inheritance");
      out.extends += names(inheritance, "Extends", "EXTENDS", report);
      out.implements += names(inheritance, "Implements", "IMPLEMENTS", report);
    } else if (is_vendor(data, "method") && xml::child(data, "Method")) {
      out.methods.push_back(xml::child(data, "Method"));
    } else if (is_vendor(data, "property") && xml::child(data, "Property")) {
      out.properties.push_back(xml::child(data, "Property"));
    } else {
      report_data(data, report);
    }
  }
  return out;
}

}  // namespace plcopen
