// Configurations, resources, tasks and instances; the project as a whole.
#include <algorithm>
#include <initializer_list>
#include <set>
#include <string>

#include "adapters/plcopen/iec10.h"
#include "adapters/plcopen/plcopen.h"
#include "adapters/plcopen/reader.h"
#include "adapters/plcopen/source_text.h"
#include "base/name_case.h"

namespace plcopen {

std::string add_declaration(Node element, std::string_view name, std::string text,
                            Reporter& report) {
  if (report.take(element, std::string(name), text)) return std::string(name);
  return report.out().add_source(name, std::move(text));
}

namespace {

// `01:30:00.25`, hours first, as in TC6 1.0. Empty: it is none.
std::string clock_text(std::string_view text) {
  constexpr std::string_view kDigits = "0123456789";
  std::string out = "T#";
  for (const char unit : {'h', 'm', 's'}) {
    const size_t end = unit == 's' ? text.size() : std::min(text.find(':'), text.size());
    const std::string_view number = text.substr(0, end);
    const size_t point = std::min(number.find('.'), number.size());
    const bool whole = number.substr(0, point).find_first_not_of(kDigits) == std::string_view::npos;
    const size_t behind = number.find_first_not_of(kDigits, std::min(point + 1, number.size()));
    if (point == 0 || !whole || behind != std::string_view::npos) return {};
    if (unit != 's' && (point != end || end == text.size())) return {};
    out += std::string(number) + unit;
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return out;
}

// xsd:duration (PT0.02S), a time of a clock or a literal of the standard (T#20ms, t#1s, 20ms).
// Empty: none of them.
std::string interval_text(std::string_view text) {
  text = xml::trimmed(text);
  if (const std::string clock = clock_text(text); !clock.empty()) return clock;
  const size_t mark = text.find('#');
  const std::string_view allowed = "0123456789._dhmsunDHMSUN";
  std::string_view amount = mark == std::string_view::npos ? text : text.substr(mark + 1);
  if (!amount.empty() && amount.find_first_not_of(allowed) == std::string_view::npos &&
      amount.find_first_of("smhdSMHD") != std::string_view::npos) {
    return "T#" + std::string(amount);
  }
  if (!text.starts_with("P")) return {};
  std::string out = "T#";
  bool time = false;
  std::string number;
  for (char c : text.substr(1)) {
    if (c == 'T') {
      time = true;
    } else if ((c >= '0' && c <= '9') || c == '.') {
      number += c;
    } else {
      const bool known = time ? c == 'H' || c == 'M' || c == 'S' : c == 'D';
      // Years and months have no length of their own, but may be none: P0Y0M0DT0.1S.
      const bool none = !time && (c == 'Y' || c == 'M') && !number.empty() &&
                        number.find_first_not_of('0') == std::string::npos;
      if ((!known && !none) || number.empty()) return {};
      if (!none) out += number + static_cast<char>(c + ('a' - 'A'));
      number.clear();
    }
  }
  return out.size() > 2 && number.empty() ? out : std::string();
}

// CODESYS has tasks that wait for something. Others run by their interval, or in every scan.
void check_kind(Node task, bool has_single, Reporter& report) {
  for (Node data : vendor_parts(task)) {
    if (!is_vendor(data, "tasksettings") || has_single) continue;
    const std::string kind(xml::attribute(xml::child(data, "TaskSettings"), "KindOfTask"));
    if (kind.empty() || kind == "Cyclic" || kind == "Freewheeling") continue;
    report.add(Code::kXmlBadValue, task,
               "the task `" + std::string(xml::attribute(task, "name")) + "` is of kind " + kind +
                   ": when it runs does not come in",
               "write it as TASK name(SINGLE := variable, PRIORITY := ...) in a CONFIGURATION");
  }
}

std::string task_text(Node task, Reporter& report) {
  const std::string name(report.required_name(task));
  if (name.empty()) return {};
  std::string parameters;
  auto add = [&](const std::string& text) {
    parameters += (parameters.empty() ? "" : ", ") + text;
  };
  std::string_view interval = xml::attribute(task, "interval");
  if (!interval.empty()) {
    const std::string text = interval_text(interval);
    if (text.empty()) {
      report.add(Code::kXmlBadValue, task, "interval `" + std::string(interval) + "` is no time",
                 "write it like T#20ms or PT0.02S");
    } else {
      add("INTERVAL := " + text);
    }
  }
  std::string_view single = xml::trimmed(xml::attribute(task, "single"));
  if (!single.empty() && !xml::boolean(single)) add("SINGLE := " + std::string(single));
  check_kind(task, !single.empty(), report);
  std::string_view priority = xml::trimmed(xml::attribute(task, "priority"));
  if (!priority.empty()) {
    if (priority.find_first_not_of("0123456789") != std::string_view::npos) {
      report.add(Code::kXmlBadValue, task, "priority `" + std::string(priority) + "` is no number");
    } else {
      add("PRIORITY := " + std::string(priority));
    }
  }
  return documentation(task, "") + vendor_data(task, report).attributes + "TASK " + name + "(" +
         parameters + ");\n";
}

std::string instance_text(Node node, const std::string& task, Reporter& report) {
  const std::string name(report.required_name(node));
  if (name.empty()) return {};
  std::string type(xml::trimmed(xml::attribute(node, "typeName")));
  if (type.empty()) type = xml::trimmed(xml::attribute(node, "type"));  // TC6 1.0
  if (type.empty()) type = name;  // CODESYS: the program itself
  return vendor_data(node, report).attributes + "PROGRAM " + name +
         (task.empty() ? "" : " WITH " + task) + " : " + type + ";\n";
}

void add_named_lists(Node parent, Reporter& report) {
  for (Node list : xml::children(parent, "globalVars")) {
    if (!is_named_list(list) || is_excluded(list, report)) continue;
    const std::string name(report.required_name(list));
    if (name.empty()) continue;
    std::string text = variable_list(list, report);
    const std::string file = add_declaration(list, name, text, report);
    // The file's name is that of the list; another needs to be said.
    if (file != name) {
      report.out().sources.back().text = "{attribute 'list' := '" + name + "'}\n" + text;
    }
  }
}

std::string import_attributes_and_parts(Node owner, Reporter& report);

std::string resource_text(Node resource, Reporter& report) {
  const std::string name(report.required_name(resource));
  add_named_lists(resource, report);
  std::string tasks, programs;
  for (Node node : xml::children(resource)) {
    if (xml::is(node, "task")) {
      tasks += task_text(node, report);
      const std::string task(xml::attribute(node, "name"));
      for (Node each : xml::children(node, "pouInstance")) {
        programs += instance_text(each, task, report);
      }
    } else if (xml::is(node, "pouInstance")) {
      programs += instance_text(node, {}, report);
    }
  }
  const std::string attributes = import_attributes_and_parts(resource, report);
  std::string text = xml::indented(variable_lists(resource, report) + tasks + programs, kIndent);
  if (text.empty() || name.empty()) return {};
  return documentation(resource, "") + attributes + "RESOURCE " + name + " ON PLC\n" + text +
         "END_RESOURCE\n";
}

void import_type(Node type, Reporter& report) {
  if (is_excluded(type, report)) return;
  std::string text = xml::is(type, "union") ? union_type(type, report) : data_type(type, report);
  if (!text.empty()) add_declaration(type, xml::attribute(type, "name"), text, report);
}

// What CODESYS keeps in addData: POUs, types, lists and whole applications.
void import_part(Node data, Reporter& report) {
  bool taken = false;
  for (Node node : xml::children(data)) {
    taken = true;
    if (xml::is(node, "pou")) {
      import_pou(node, report);
    } else if (xml::is(node, "dataType") || xml::is(node, "union")) {
      import_type(node, report);
    } else if (xml::is(node, "Interface") || xml::is(node, "interface")) {
      import_interface(node, report);
    } else if (xml::is(node, "resource")) {
      import_resource(node, report);
    } else if (!xml::is(node, "globalVars")) {
      taken = false;
    }
  }
  add_named_lists(data, report);
  if (!taken) report_data(data, report);
}

void import_parts(Node owner, Reporter& report) {
  for (Node data : vendor_parts(owner)) import_part(data, report);
}

// The lines of the owner's attributes; its parts become declarations of their own.
std::string import_attributes_and_parts(Node owner, Reporter& report) {
  std::string attributes;
  for (Node data : vendor_parts(owner)) {
    if (is_vendor(data, "attributes")) {
      attributes += attribute_lines(data);
    } else {
      import_part(data, report);
    }
  }
  return attributes;
}

}  // namespace

void import_configuration(Node configuration, Reporter& report) {
  const std::string name(report.required_name(configuration));
  add_named_lists(configuration, report);
  std::string text = variable_lists(configuration, report);
  for (Node resource : xml::children(configuration, "resource")) {
    text += resource_text(resource, report);
  }
  const std::string attributes = import_attributes_and_parts(configuration, report);
  if (name.empty() || text.empty()) return;
  add_declaration(configuration, name,
                  documentation(configuration, "") + attributes + "CONFIGURATION " + name + "\n" +
                      xml::indented(text, kIndent) + "END_CONFIGURATION\n",
                  report);
}

void import_resource(Node resource, Reporter& report) {
  std::string text = resource_text(resource, report);
  if (text.empty()) return;
  report.out().add_source(
      "Config", "CONFIGURATION Config\n" + xml::indented(text, kIndent) + "END_CONFIGURATION\n");
}

bool is_document(const xml::Document& document) {
  return xml::is(document.root(), "project") || xml::is(document.root(), "pou") ||
         is_iec10(document);
}

namespace {

// <types>, and what vendors add beside it.
void import_types(Node owner, Reporter& report) {
  for (Node type : xml::children(xml::find(owner, {"types", "dataTypes"}), "dataType")) {
    import_type(type, report);
  }
  for (Node pou : xml::children(xml::find(owner, {"types", "pous"}), "pou")) {
    import_pou(pou, report);
  }
}

// A namespace of IEC 61131-10 contains everything that is made inside of it.
void import_namespaces(Node owner, Reporter& report) {
  for (Node space : xml::children(owner, "namespace")) {
    const std::string name(report.required_name(space));
    const size_t first = report.out().sources.size();
    import_types(space, report);
    import_parts(space, report);
    import_namespaces(space, report);
    for (size_t i = first; i < report.out().sources.size(); ++i) {
      std::string& text = report.out().sources[i].text;
      text = "NAMESPACE " + name + "\n" + xml::indented(text, kIndent) + "END_NAMESPACE\n";
    }
  }
}

// What stands where no part of TC6 does would be lost without a word.
void report_misplaced(Node owner, std::initializer_list<const char*> parts, Reporter& report) {
  for (Node child : xml::children(owner)) {
    const bool known =
        std::ranges::any_of(parts, [&](const char* part) { return xml::is(child, part); });
    if (known || xml::is(child, "addData") || xml::is(child, "documentation")) continue;
    report.add(Code::kXmlNotUnderstood, child,
               xml::shown(child) + " does not belong into " + xml::shown(owner) +
                   ", and nothing of it comes in");
  }
}

void report_misplaced(Node project, Reporter& report) {
  report_misplaced(project, {"fileHeader", "contentHeader", "types", "instances"}, report);
  const Node types = xml::child(project, "types");
  report_misplaced(types, {"dataTypes", "pous"}, report);
  report_misplaced(xml::child(types, "dataTypes"), {"dataType"}, report);
  report_misplaced(xml::child(types, "pous"), {"pou"}, report);
  const Node instances = xml::child(project, "instances");
  report_misplaced(instances, {"configurations"}, report);
  report_misplaced(xml::child(instances, "configurations"), {"configuration"}, report);
}

std::set<std::string> in_outs_of(Node project) {
  std::set<std::string> out;
  for (Node pou : xml::children(xml::find(project, {"types", "pous"}), "pou")) {
    const std::string name = base::fold_name(xml::attribute(pou, "name"));
    for (Node list : xml::children(xml::child(pou, "interface"), "inOutVars")) {
      for (Node each : xml::children(list, "variable")) {
        out.insert(name + "." + base::fold_name(xml::attribute(each, "name")));
      }
    }
  }
  return out;
}

void import_project(Node project, Reporter& report) {
  if (xml::is(project, "pou")) return import_pou(project, report);
  const std::set<std::string> in_outs = in_outs_of(project);
  report.set_in_outs(&in_outs);
  import_types(project, report);
  import_namespaces(project, report);
  Node configurations = xml::find(project, {"instances", "configurations"});
  for (Node node : xml::children(configurations, "configuration")) {
    import_configuration(node, report);
  }
  for (Node part : {project, xml::child(project, "contentHeader"), xml::child(project, "types"),
                    xml::child(project, "instances")}) {
    import_parts(part, report);
  }
  report.set_in_outs(nullptr);
}

}  // namespace

void import(const xml::Document& document, xml::Imported& out) {
  Reporter report(document, out);
  SourceTexts texts(document.root(), out);
  const Reporter::Taker taker = [&](Node element, const std::string& name, std::string& text) {
    return texts.take(document, report.origin(element), name, text);
  };
  report.set_taker(&taker);
  Converted converted;
  if (is_iec10(document)) {
    report.set_origins(&converted.origins);
    from_iec10(document.root(), converted, report);
    import_project(converted.project.document_element(), report);
  } else {
    import_project(document.root(), report);
    keep_headers(document.root(), out);
    keep_object_ids(document.root(), out);
    if (xml::is(document.root(), "project")) report_misplaced(document.root(), report);
  }
  report.set_taker(nullptr);
  texts.finish(report);
  if (out.sources.empty() && !out.failed() && !xml::is(document.root(), "pou")) {
    report.add(Code::kUnknownXml, document.root(), "the project has no POU, type or variable");
  }
}

}  // namespace plcopen
