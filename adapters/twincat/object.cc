// One object -> one source.
#include <algorithm>
#include <vector>

#include "adapters/twincat/chart.h"
#include "adapters/twincat/networks.h"
#include "adapters/twincat/twincat.h"
#include "adapters/xml/diagram_text.h"
#include "base/name_case.h"

namespace twincat {
namespace {

using xml::Code;
using xml::Node;
using xml::Reporter;

constexpr const char* kIndent = "  ";

// {error 'text'}: the text ends where a quote or brace would.
std::string error_pragma(std::string text) {
  for (char& c : text) {
    if (c == '\'' || c == '"' || c == '{' || c == '}' || c == '$') c = ' ';
  }
  return "{error '" + text + "'}\n";
}

// The export of TwinCAT has CFC in a form of its own, too.
std::string way_out(Node form) {
  if (xml::is(form, "Drawing")) {
    return "export the POU as PLCopen XML in CODESYS (Project, Export PLCopenXML), and import that";
  }
  if (xml::is(form, "CFC")) return "write it in ST, ladder or FBD in TwinCAT";
  return "export the POU as PLCopen XML in TwinCAT (Export PLCopenXML), and import that file";
}

class ObjectWriter {
 public:
  ObjectWriter(Node object, Reporter& report) : object_(object), report_(report) {}

  std::string pou();    // also interfaces
  std::string plain();  // types, lists of globals: a declaration is all there is

 private:
  std::string declaration(Node node);
  std::string body(Node owner, const std::string& what);
  std::string networks(Node form, const std::string& what);
  void members(Node parent, std::string& out);
  std::string member(Node node, const char* end);
  std::string property(Node node);
  std::string accessor(Node node, const char* word, const std::string& property);
  std::string end_word(Node node, std::string_view declaration);

  Node object_;
  Reporter& report_;
};

std::string ObjectWriter::declaration(Node node) {
  Node text = xml::child(node, "Declaration");
  std::string out = xml::text_of(text);
  if (!text && !xml::is(node, "Get") && !xml::is(node, "Set")) {
    report_.add(Code::kXmlMissing, node, xml::shown(node) + " has no <Declaration>");
  }
  return out.empty() ? out : out + "\n";
}

// Behind a comment with those inside of it.
size_t behind_comment(std::string_view text, size_t at) {
  size_t depth = 0;
  do {
    const std::string_view mark = text.substr(at, 2);
    depth += mark == "(*" ? 1 : 0;
    depth -= mark == "*)" ? 1 : 0;
    at += mark == "(*" || mark == "*)" ? 2 : 1;
  } while (depth != 0 && at < text.size());
  return at;
}

// Words in front of the first that says what is declared: attributes, comments, FINAL ...
std::string ObjectWriter::end_word(Node node, std::string_view text) {
  for (size_t at = 0; at < text.size();) {
    if (text.substr(at).starts_with("(*")) {
      at = behind_comment(text, at);
    } else if (text.substr(at).starts_with("/*")) {
      at = std::min(text.find("*/", at + 2), text.size() - 1) + 1;
    } else if (text.substr(at).starts_with("//")) {
      at = std::min(text.find('\n', at), text.size());
    } else if (text[at] == '{') {
      at = std::min(text.find('}', at), text.size() - 1) + 1;
    } else if (xml::is_name(text.substr(at, 1))) {
      size_t end = at;
      while (end < text.size() && xml::is_name(text.substr(at, end + 1 - at))) ++end;
      const std::string_view word = text.substr(at, end - at);
      for (const char* known : {"FUNCTION_BLOCK", "FUNCTION", "PROGRAM", "INTERFACE"}) {
        if (base::same_name(word, known)) return "END_" + std::string(known) + "\n";
      }
      at = end;
    } else {
      ++at;
    }
  }
  report_.add(Code::kXmlBadValue, node,
              "the declaration of " + xml::shown(node) +
                  " begins with none of PROGRAM, FUNCTION, FUNCTION_BLOCK, INTERFACE");
  return {};
}

std::string ObjectWriter::networks(Node form, const std::string& what) {
  const auto body = read_networks(form, what, report_);
  if (!body) return error_pragma("the body of " + what + " was not imported");
  if (body->networks.empty()) return {};
  // The variables around it: all words of the object's declarations.
  std::string names;
  for (Node owner = form.parent(); owner && owner != object_.parent(); owner = owner.parent()) {
    names += ' ' + xml::text_of(xml::child(owner, "Declaration"));
  }
  return xml::diagram_text(*body, names, report_.as_fbd(form)).text;
}

std::string ObjectWriter::body(Node owner, const std::string& what) {
  Node implementation = xml::child(owner, "Implementation");
  if (!implementation) return {};
  std::string out;
  const std::vector<Node> all = xml::children(owner, "Implementation");
  if (all.size() > 1 || xml::children(implementation).size() > 1) {
    report_.add(Code::kXmlBody, all.back(), what + " has several bodies");
    out += error_pragma(what + " has several bodies");
  }
  for (Node form : xml::children(implementation)) {
    if (xml::is(form, "ST")) {
      out += xml::text_of(form);
      if (!out.empty()) out += "\n";
      continue;
    }
    if (xml::is(form, "NWL")) {
      out += networks(form, what);
      continue;
    }
    if (xml::is(form, "SFC")) {
      const std::string text = chart_text(form, object_, what, report_);
      out += text.empty() ? error_pragma("the body of " + what + " was not imported") : text;
      continue;
    }
    const std::string how = xml::is(form, "Drawing")
                                ? "drawn, and stands here as the inside of the editor"
                                : "in " + std::string(xml::local_name(form));
    const std::string text = "the body of " + what + " is " + how +
                             ", which is documented nowhere and cannot be imported";
    const std::string fix = way_out(form);
    report_.add(Code::kGraphicalBody, form, text, fix);
    out += error_pragma(text + "; " + fix);
  }
  return out;
}

std::string ObjectWriter::accessor(Node node, const char* word, const std::string& property) {
  const std::string name = std::string(word) + " of " + property;
  return word + std::string("\n") + declaration(node) + xml::indented(body(node, name), kIndent) +
         "END_" + word + "\n";
}

std::string ObjectWriter::property(Node node) {
  const std::string name = "property " + std::string(xml::attribute(node, "Name"));
  std::string out = declaration(node);
  for (Node below : xml::children(node)) {
    if (xml::is(below, "Get")) out += xml::indented(accessor(below, "GET", name), kIndent);
    if (xml::is(below, "Set")) out += xml::indented(accessor(below, "SET", name), kIndent);
  }
  return out + "END_PROPERTY\n";
}

std::string ObjectWriter::member(Node node, const char* end) {
  const std::string name = std::string(end + 4) + " " + std::string(xml::attribute(node, "Name"));
  return declaration(node) + xml::indented(body(node, name), kIndent) + end + "\n";
}

void ObjectWriter::members(Node parent, std::string& out) {
  const Node chart = xml::child(xml::child(parent, "Implementation"), "SFC");
  const xml::OwnActions of_steps = own_actions(chart);
  std::vector<Node> nodes = xml::children(parent);
  if (chart) {
    const auto actions = std::stable_partition(nodes.begin(), nodes.end(),
                                               [](Node node) { return !xml::is(node, "Action"); });
    std::stable_sort(actions, nodes.end(), [&](Node a, Node b) {
      return of_steps.before(xml::attribute(a, "Name"), xml::attribute(b, "Name"));
    });
  }
  for (Node node : nodes) {
    std::string text;
    if (xml::is(node, "Method")) {
      text = member(node, "END_METHOD");
    } else if (xml::is(node, "Property")) {
      text = property(node);
    } else if (xml::is(node, "Action")) {
      std::string name(report_.required_name(node, "Name"));
      if (name.empty()) continue;
      text = of_steps.head(name) + "ACTION " + name + ":\n" +
             xml::indented(body(node, "action " + name), kIndent) + "END_ACTION\n";
    } else if (xml::is(node, "Transition")) {
      if (xml::child(xml::child(parent, "Implementation"), "SFC")) continue;  // where it is named
      report_.add(Code::kXmlNotUnderstood, node,
                  xml::shown(node) + " belongs to a chart, and is left out like that");
    } else if (xml::is(node, "Folder")) {
      report_.add(Code::kXmlLeftOut, node, "a folder of the editor: what is in it comes in");
    } else if (xml::is(node, "LineIds") || xml::is(node, "ObjectProperties")) {
      report_.add(Code::kXmlLeftOut, node, xml::shown(node) + " is of the editor only");
    } else if (!xml::is(node, "Declaration") && !xml::is(node, "Implementation")) {
      report_.add(Code::kXmlNotUnderstood, node, xml::shown(node) + " is not known here");
    }
    if (!text.empty()) out += "\n" + xml::indented(text, kIndent);
  }
}

std::string ObjectWriter::pou() {
  std::string out = declaration(object_);
  const std::string end = end_word(object_, out);
  members(object_, out);
  const std::string statements = body(object_, std::string(xml::attribute(object_, "Name")));
  if (!statements.empty()) out += "\n" + statements;
  return out + end;
}

std::string ObjectWriter::plain() {
  std::string out = declaration(object_);
  std::string ignored;
  members(object_, ignored);
  return out;
}

// Digits only.
std::string number_below(Node node, const char* name, Reporter& report) {
  Node found = xml::child(node, name);
  std::string text(xml::trimmed(xml::text_of(found)));
  const bool digits = !text.empty() && text.size() <= 12 &&
                      text.find_first_not_of("0123456789") == std::string::npos;
  if (found && !digits) {
    report.add(Code::kXmlBadValue, found, "`" + text + "` is no number", "write digits only");
  }
  return digits ? text : std::string();
}

}  // namespace

bool is_object(const xml::Document& document) { return xml::is(document.root(), "TcPlcObject"); }

void Importer::add_task(Node node, Reporter& report) {
  Task task;
  task.name = report.required_name(node, "Name");
  const std::string cycle = number_below(node, "CycleTime", report);
  if (cycle.empty()) {
    report.add(Code::kXmlMissing, node, xml::shown(node) + " has no <CycleTime> in microseconds");
  }
  if (task.name.empty() || cycle.empty()) return;
  task.interval = "T#" + cycle + "us";
  task.priority = number_below(node, "Priority", report);
  for (Node call : xml::children(node, "PouCall")) {
    std::string name(xml::trimmed(xml::text_of(xml::child(call, "Name"))));
    if (xml::is_name(name)) {
      task.programs.push_back(std::move(name));
    } else {
      report.add(Code::kXmlBadValue, call, "the task calls `" + name + "`, which is no name");
    }
  }
  tasks_.push_back(std::move(task));
}

void Importer::add_object(const xml::Document& document) {
  Reporter report(document, out_);
  add_objects(document.root(), report);
}

void Importer::add_objects(Node root, Reporter& report) {
  bool found = false;
  for (Node object : xml::children(root)) {
    const std::string_view kind = xml::local_name(object);
    report.set_pou(std::string(xml::attribute(object, "Name")));
    if (kind == "Task") {
      found = true;
      add_task(object, report);
      continue;
    }
    const bool pou = kind == "POU" || kind == "Itf";
    if (!pou && kind != "DUT" && kind != "GVL") {
      report.add(Code::kXmlNotUnderstood, object, xml::shown(object) + " is not known here");
      continue;
    }
    found = true;
    std::string name(report.required_name(object, "Name"));
    if (name.empty()) continue;
    ObjectWriter writer(object, report);
    std::string text = pou ? writer.pou() : writer.plain();
    const std::string file = out_.add_source(name, text);
    // The file's name is that of the list; another needs to be said.
    if (kind == "GVL" && file != name) {
      out_.sources.back().text = "{attribute 'list' := '" + name + "'}\n" + text;
    }
  }
  if (!found && !out_.failed()) {
    report.add(Code::kUnknownXml, root, "there is no POU, type or list of variables in this file");
  }
}

void Importer::add_tasks() {
  if (tasks_.empty()) return;
  std::string text = "CONFIGURATION Tasks\n  RESOURCE Plc ON PLC\n";
  for (const Task& task : tasks_) {
    text += "    TASK " + task.name + "(INTERVAL := " + task.interval;
    if (!task.priority.empty()) text += ", PRIORITY := " + task.priority;
    text += ");\n";
  }
  for (const Task& task : tasks_) {
    for (const std::string& program : task.programs) {
      text += "    PROGRAM " + program + " WITH " + task.name + " : " + program + ";\n";
    }
  }
  out_.add_source("Tasks", text + "  END_RESOURCE\nEND_CONFIGURATION\n");
  tasks_.clear();
}

}  // namespace twincat
