// The project as a whole: types, POUs, configurations, lists of globals.
#include "adapters/plcopen/export.h"

#include <algorithm>
#include <ctime>
#include <sstream>

#include "adapters/plcopen/geometry.h"
#include "adapters/plcopen/iec10.h"
#include "adapters/plcopen/writer.h"
#include "base/name_case.h"
#include "frontend/parse/global_lists.h"

namespace plcopen {

using frontend::ConfigDecl;
using frontend::ResourceDecl;
using frontend::VarBlock;
using frontend::VarSection;

std::optional<Edition> form_of_name(std::string_view name) {
  if (name == "tc6-2.0") return Edition::kTc6v200;
  if (name == "tc6-2.01") return Edition::kTc6v201;
  if (name == "61131-10") return Edition::kIec10;
  return std::nullopt;
}

std::vector<Writer::Globals> Writer::global_lists() {
  std::vector<Globals> out;
  const std::vector<const VarBlock*> heads = frontend::list_heads(tree_, in_.sources);
  for (size_t i = 0; i < heads.size(); ++i) {
    const VarBlock& block = tree_.globals[i];
    if (block.section != VarSection::kGlobal) {
      fail(block.span, "VAR_CONFIG outside of a CONFIGURATION has no element in PLCopen XML");
      continue;
    }
    if (tree_.in_namespace(block.scope)) {
      fail(block.span, "a NAMESPACE has no element in PLCopen XML");
      continue;
    }
    const std::string name(frontend::list_name(tree_, in_.sources, *heads[i]));
    const frontend::Attribute* named = tree_.find_attribute(heads[i]->attributes, "list");
    const bool own = named != nullptr && !named->value.empty();
    out.push_back({own ? name : xml::as_name(name), &block, heads[i]->attributes});
  }
  return out;
}

void Writer::put_global_list(Node parent, const Globals& list) {
  const Node last = parent.last_child();
  const bool whole = put_list(parent, *list.block, list.name, list.attributes);
  if (parent.last_child() != last) tag(parent.last_child(), list.block->span.begin);
  if (whole) return;
  fail(list.block->span,
       "this list of global variables has something that PLCopen XML has no element for");
}

void Writer::resource(Node parent, const ResourceDecl& resource,
                      const std::vector<Globals>& lists) {
  Node node = parent.append_child("resource");
  node.append_attribute("name") =
      resource.name.empty() ? "Resource" : std::string(resource.name.text).c_str();
  std::vector<Node> tasks;
  for (const frontend::TaskDecl& task : resource.tasks) {
    Node each = node.append_child("task");
    each.append_attribute("name") = std::string(task.name.text).c_str();
    auto put = [&](ExprId value, const char* name) {
      if (value.valid()) each.append_attribute(name) = flat(tree_[value].span).c_str();
    };
    put(task.single, "single");
    put(task.interval, "interval");
    put(task.priority, "priority");
    if (!task.priority.valid()) each.append_attribute("priority") = "0";
    put_attributes(each, task.attributes);
    tasks.push_back(each);
  }
  for (const VarBlock& block : resource.globals) put_list(node, block, {}, block.attributes);
  for (const Globals& list : lists) put_global_list(node, list);
  for (const frontend::ProgramDecl& program : resource.programs) {
    if (program.args.count != 0 || !program.block_tasks.empty()) {
      fail(program.span, "connections of a program instance have no element in PLCopen XML");
    }
    if (program.retain || program.non_retain) {
      fail(program.span, "RETAIN of a program instance has no element in PLCopen XML");
    }
    Node owner = node;
    for (size_t i = 0; i < resource.tasks.size(); ++i) {
      if (base::same_name(resource.tasks[i].name.text, program.task.text)) owner = tasks[i];
    }
    Node each = owner.append_child("pouInstance");
    each.append_attribute("name") = std::string(program.name.text).c_str();
    each.append_attribute("typeName") = std::string(program.type.text).c_str();
    put_attributes(each, program.attributes);
  }
  put_attributes(node, resource.attributes);
}

void Writer::configuration(Node parent, const ConfigDecl& config,
                           const std::vector<Globals>& lists) {
  Node node = parent.append_child("configuration");
  node.append_attribute("name") = std::string(config.name.text).c_str();
  bool first = true;
  for (const ResourceDecl& each : config.resources) {
    resource(node, each, first ? lists : std::vector<Globals>());
    first = false;
  }
  if (config.resources.empty() && !lists.empty()) {
    fail(config.span, "a configuration without a resource cannot hold lists of global variables");
  }
  for (VarSection section : {VarSection::kGlobal, VarSection::kAccess, VarSection::kConfig}) {
    for (const VarBlock& block : config.globals) {
      if (block.section == section) put_list(node, block, {}, block.attributes);
    }
  }
  put_attributes(node, config.attributes);
  tag(node, config.span.begin);
}

void Writer::project(Node project) {
  if (!tree_.tests.empty() && !parts_) {
    diagnostics_.add(base::DiagnosticCode::kXmlLeftOut, tree_.tests.front().name.span,
                     "tests are left out: XML has no element for them");
  }
  Node types = project.append_child("types");
  Node data_types = types.append_child("dataTypes");
  for (const frontend::TypeDecl& type : tree_.types) data_type(data_types, type);
  Node pous = types.append_child("pous");
  for (const Pou& each : tree_.pous) {
    if (each.kind != frontend::PouKind::kInterface) pou(pous, each);
  }
  Node configurations = project.append_child("instances").append_child("configurations");
  std::vector<Globals> lists = global_lists();
  bool first = true;
  for (const ConfigDecl& config : tree_.configs) {
    configuration(configurations, config, first ? lists : std::vector<Globals>());
    first = false;
  }
  if (tree_.configs.empty()) {
    for (const Globals& list : lists) put_global_list(data(project, "globalvars"), list);
  }
  for (const Pou& each : tree_.pous) {
    if (each.kind != frontend::PouKind::kInterface) continue;
    Node node = data(project, "interface").append_child("Interface");
    node.append_attribute("name") = std::string(each.name.text).c_str();
    interface(node, each, "INTERFACE");
    members(node, each);
    tag(node, each.span.begin);
    put_documentation(node, comment_before(each.span.begin));
  }
  put_kept(project);
  if (parts_) parts_->put(project);
}

namespace {

const char* name_space(Edition form) {
  return form == Edition::kTc6v200 ? "http://www.plcopen.org/xml/tc6_0200"
                                   : "http://www.plcopen.org/xml/tc6_0201";
}

// The lists of pins, of which drawings that others wrote leave out empty ones.
void put_pin_lists(Node block) {
  Node before;
  for (const char* const list : {"inputVariables", "inOutVariables", "outputVariables"}) {
    Node there = block.child(list);
    if (!there) {
      const Node place = before ? before : block.child("position");
      there = place ? block.insert_child_after(list, place) : block.prepend_child(list);
    }
    before = there;
  }
}

// Of an action in its block.
void put_relative_position(Node action) {
  if (action.child("relPosition")) return;
  Node position = action.prepend_child("relPosition");
  position.append_attribute("x") = 0;
  position.append_attribute("y") = 0;
}

// A paragraph of a drawing that is written as it was read. Editors know it by its prefix, and CDATA
// directly behind that.
void put_paragraph(Node node) {
  if (std::any_of(node.begin(), node.end(),
                  [](Node child) { return child.type() == pugi::node_element; })) {
    return;
  }
  const std::string text = xml::text_of(node);
  node.set_name("xhtml:p");
  node.remove_attribute("xmlns");
  while (node.first_child()) node.remove_child(node.first_child());
  Writer::put_characters(node, text);
}

// What the schema of TC6 demands and means nothing, also in drawings that are written as they were
// read: what vendors add stands behind everything else of its element but documentation; no list of
// pins is missing, nor the place of an action.
void follow_schema(Node node) {
  const std::string_view name = node.name();
  if (name == "block") put_pin_lists(node);
  if (name == "p" && std::string_view(node.attribute("xmlns").value()) == kXhtml) {
    put_paragraph(node);
  }
  if (name == "action" && std::string_view(node.parent().name()) == "actionBlock") {
    put_relative_position(node);
  }
  const Node add = node.child("addData");
  const Node documentation = node.child("documentation");
  if (add && documentation) {
    node.insert_move_before(add, documentation);
  } else if (add) {
    node.append_move(add);
  }
  for (Node child : node.children()) follow_schema(child);
}

// One message for each POU or type; for nobody's, what is said of configurations.
void report_unsaid(const ExportInput& input, const std::string& owner,
                   const std::vector<std::string>& texts, SourceParts* parts,
                   base::Diagnostics& diagnostics) {
  const frontend::Tree& tree = input.tree;
  base::SourceSpan at;
  for (const frontend::PouDecl& pou : tree.pous) {
    if (base::same_name(pou.name.text, owner)) at = pou.name.span;
  }
  for (const frontend::TypeDecl& type : tree.types) {
    if (base::same_name(type.name.text, owner)) at = type.name.span;
  }
  if (parts != nullptr && !owner.empty()) parts->mark_partial(at.begin);
  for (const ConfigDecl& config : tree.configs) {
    if (parts != nullptr && owner.empty()) parts->mark_partial(config.span.begin);
  }
  std::string text = owner.empty() ? std::string() : "`" + owner + "`: ";
  for (size_t i = 0; i < texts.size() && i < 5; ++i) text += (i == 0 ? "" : "; ") + texts[i];
  if (texts.size() > 5) text += "; and " + std::to_string(texts.size() - 5) + " more";
  diagnostics.add(
      input.with_sources ? base::DiagnosticCode::kXmlTextOnly : base::DiagnosticCode::kCannotExport,
      at, text, "export as tc6-2.01");
}

}  // namespace

// XML reads a carriage return as the end of a line, where a line comment would end. To sources it
// is a blank like others.
static std::string without_lone_returns(std::string text) {
  for (size_t at = text.find('\r'); at != std::string::npos; at = text.find('\r', at + 1)) {
    if (at + 1 == text.size() || text[at + 1] != '\n') text[at] = ' ';
  }
  return text;
}

std::optional<std::string> export_document(const ExportInput& input,
                                           base::Diagnostics& diagnostics) {
  pugi::xml_document document;
  Node declaration = document.append_child(pugi::node_declaration);
  declaration.append_attribute("version") = "1.0";
  declaration.append_attribute("encoding") = "utf-8";
  Node project = document.append_child("project");
  project.append_attribute("xmlns") = name_space(input.form);
  if (input.form != Edition::kIec10) {
    project.append_attribute("xmlns:xhtml") = kXhtml;
  }
  put_headers(project, input);
  const uint32_t before = diagnostics.error_count();
  Writer writer(input, diagnostics);
  writer.project(project);
  follow_schema(project);
  if (input.form != Edition::kIec10) put_geometry(project);
  pugi::xml_document other;
  if (input.form == Edition::kIec10) {
    for (const auto& [owner, texts] : to_iec10(project, other)) {
      report_unsaid(input, owner, texts, writer.parts(), diagnostics);
    }
  }
  if (diagnostics.error_count() != before) return std::nullopt;
  const Node whole = input.form == Edition::kIec10 ? other.document_element() : project;
  if (writer.parts() != nullptr) {
    writer.parts()->seal(whole);
  } else {
    report_lost_comments(input, whole, diagnostics);
  }
  std::ostringstream out;
  (input.form == Edition::kIec10 ? other : document)
      .save(out, "  ", pugi::format_default, pugi::encoding_utf8);
  return without_lone_returns(xml::as_utf8(out.str()));
}

}  // namespace plcopen
