// POUs and interfaces, with their members inside of them.
#include <algorithm>

#include "adapters/plcopen/reader.h"
#include "base/name_case.h"

namespace plcopen {
namespace {

struct PouForm {
  const char* type;
  const char* word;
};
constexpr PouForm kForms[] = {{"program", "PROGRAM"},
                              {"functionBlock", "FUNCTION_BLOCK"},
                              {"function", "FUNCTION"},
                              {"class", "CLASS"}};

// Does a declaration as text have a head, and not only sections of variables?
bool has_head(const std::string& declaration, const char* word) {
  return base::fold_name(declaration).find(base::fold_name(word)) != std::string::npos;
}

// METHOD name : result, variables. `word` may be empty: GET and SET have no head.
std::string head(Node owner, const char* word, const std::string& name, const Vendor& vendor,
                 Reporter& report) {
  if (!vendor.declaration.empty() && (*word == 0 || has_head(vendor.declaration, word))) {
    return vendor.declaration;
  }
  std::string out = vendor.attributes;
  Node interface = xml::child(owner, "interface");
  if (*word != 0) {
    out += word + std::string(" ") + vendor.access + name + vendor.extends + vendor.implements;
    Node result = xml::child(interface, "returnType");
    if (result) out += " : " + type_text(result, report);
    out += "\n";
  }
  return out +
         (vendor.declaration.empty() ? variable_lists(interface, report) : vendor.declaration);
}

std::string method(Node node, Reporter& report) {
  const std::string name(report.required_name(node));
  if (name.empty() || is_excluded(node, report)) return {};
  Vendor vendor = vendor_data(node, report);
  return documentation(node, "") + head(node, "METHOD", name, vendor, report) +
         xml::indented(body_text(node, "method " + name, report), kIndent) + "END_METHOD\n";
}

std::string accessor(Node node, const char* word, const std::string& name, Reporter& report) {
  Vendor vendor = vendor_data(node, report);
  std::string first = word + std::string(" ") + vendor.access;
  first.erase(first.find_last_not_of(' ') + 1);
  return first + "\n" + head(node, "", name, vendor, report) +
         xml::indented(body_text(node, std::string(word) + " of " + name, report), kIndent) +
         "END_" + word + "\n";
}

std::string property(Node node, Reporter& report) {
  const std::string name(report.required_name(node));
  if (name.empty() || is_excluded(node, report)) return {};
  Vendor vendor = vendor_data(node, report);
  std::string out = documentation(node, "");
  if (has_head(vendor.declaration, "PROPERTY")) {
    out += vendor.declaration;
  } else {
    Node result = xml::find(node, {"interface", "returnType"});
    out += vendor.attributes + "PROPERTY " + vendor.access + name + " : " +
           type_text(result, report) + "\n";
  }
  for (auto [element, word] : {std::pair("GetAccessor", "GET"), std::pair("SetAccessor", "SET")}) {
    Node found = xml::child(node, element);
    if (found) out += xml::indented(accessor(found, word, name, report), kIndent);
  }
  return out + "END_PROPERTY\n";
}

std::string action(Node node, const xml::OwnActions& of_steps, Reporter& report) {
  const std::string name(report.required_name(node));
  if (name.empty() || is_excluded(node, report)) return {};
  std::string attributes = vendor_data(node, report).attributes;
  const std::string of_step = of_steps.head(name);
  if (attributes.find(of_step) == std::string::npos) attributes += of_step;
  return documentation(node, "") + attributes + "ACTION " + name + ":\n" +
         xml::indented(body_text(node, "action " + name, report), kIndent) + "END_ACTION\n";
}

std::string members(const Vendor& vendor, Node pou, Reporter& report) {
  std::string out;
  auto add = [&out](const std::string& text) {
    if (!text.empty()) out += "\n" + xml::indented(text, kIndent);
  };
  for (Node node : vendor.methods) add(method(node, report));
  for (Node node : vendor.properties) add(property(node, report));
  const xml::OwnActions of_steps = own_actions(pou);
  std::vector<Node> actions = xml::children(xml::child(pou, "actions"), "action");
  if (is_chart_of_codesys(pou)) {
    std::stable_sort(actions.begin(), actions.end(), [&](Node a, Node b) {
      return of_steps.before(xml::attribute(a, "name"), xml::attribute(b, "name"));
    });
  }
  for (Node node : actions) add(action(node, of_steps, report));
  return out;
}

void report_unknown(Node pou, Reporter& report) {
  static constexpr const char* kKnown[] = {
      "interface",     "actions", "transitions",         "body",
      "documentation", "addData", "InterfaceAsPlainText"};
  for (Node below : xml::children(pou)) {
    bool known = false;
    for (const char* name : kKnown) known = known || xml::is(below, name);
    if (!known) {
      report.add(Code::kXmlNotUnderstood, below, xml::shown(below) + " is not known here");
    }
  }
}

const PouForm* form_of(Node pou, Reporter& report) {
  std::string_view type = report.required(pou, "pouType");
  for (const PouForm& form : kForms) {
    if (base::same_name(type, form.type)) return &form;
  }
  if (!type.empty()) {
    report.add(Code::kXmlBadValue, pou, "pouType `" + std::string(type) + "` is unknown",
               "known are program, functionBlock and function");
  }
  return nullptr;
}

}  // namespace

void import_pou(Node pou, Reporter& report) {
  if (is_excluded(pou, report)) return;
  const std::string name(report.required_name(pou));
  report.set_pou(name);
  const PouForm* form = name.empty() ? nullptr : form_of(pou, report);
  if (form != nullptr) {
    report_unknown(pou, report);
    Vendor vendor = vendor_data(pou, report);
    std::string out = documentation(pou, "");
    out += head(pou, form->word, name, vendor, report);
    out += members(vendor, pou, report);
    std::string body = body_text(pou, name, report);
    if (!body.empty()) out += "\n" + body;
    add_declaration(pou, name, out + "END_" + form->word + "\n", report);
  }
  report.set_pou({});
}

void import_interface(Node interface, Reporter& report) {
  if (is_excluded(interface, report)) return;
  const std::string name(report.required_name(interface));
  report.set_pou(name);
  if (!name.empty()) {
    Vendor vendor = vendor_data(interface, report);
    add_declaration(interface, name,
                    documentation(interface, "") +
                        head(interface, "INTERFACE", name, vendor, report) +
                        members(vendor, interface, report) + "END_INTERFACE\n",
                    report);
  }
  report.set_pou({});
}

}  // namespace plcopen
