// Lists of variables as elements.
#include "adapters/plcopen/writer.h"

namespace plcopen {

using frontend::VarBlock;
using frontend::VarDecl;
using frontend::VarSection;

namespace {

// Null: the standard's XML has none.
const char* list_name(VarSection section) {
  switch (section) {
    case VarSection::kLocal:
      return "localVars";
    case VarSection::kInput:
      return "inputVars";
    case VarSection::kOutput:
      return "outputVars";
    case VarSection::kInOut:
      return "inOutVars";
    case VarSection::kTemp:
      return "tempVars";
    case VarSection::kExternal:
      return "externalVars";
    case VarSection::kGlobal:
      return "globalVars";
    case VarSection::kAccess:
      return "accessVars";
    case VarSection::kConfig:
      return "configVars";
    default:
      return nullptr;
  }
}

// Made for diagrams and charts, not declared by anybody.
bool is_made(const VarDecl& decl) {
  return decl.implied ||
         (!decl.names.empty() && decl.names[0].text.find('#') != std::string_view::npos);
}

}  // namespace

bool Writer::put_variable(Node list, const VarBlock& block, const VarDecl& decl) {
  auto common = [&](Node node) {
    put_type(node.append_child("type"), decl.spec);
    if (decl.init.valid()) put_value(node.append_child("initialValue"), decl.init);
    put_attributes(node, decl.attributes);
    put_documentation(node, comment_behind(decl.span.end));
  };
  const std::string address = address_of(decl);
  if (block.section == VarSection::kConfig) {
    Node node = list.append_child("configVariable");
    node.append_attribute("instancePathAndName") = flat(tree_[decl.path].span).c_str();
    if (!address.empty()) node.append_attribute("address") = address.c_str();
    common(node);
    return true;
  }
  for (const frontend::Name& name : decl.names) {
    const bool access = block.section == VarSection::kAccess;
    Node node = list.append_child(access ? "accessVariable" : "variable");
    node.append_attribute(access ? "alias" : "name") = std::string(name.text).c_str();
    if (access) {
      node.append_attribute("instancePathAndName") = flat(tree_[decl.path].span).c_str();
      node.append_attribute("direction") = decl.writable ? "readWrite" : "readOnly";
    } else if (!address.empty()) {
      node.append_attribute("address") = address.c_str();
    }
    if (in_.form == Edition::kIec10 && decl.edge != frontend::Edge::kNone) {
      node.append_attribute("edge") = decl.edge == frontend::Edge::kRising ? "rising" : "falling";
    }
    common(node);
  }
  const bool unnamed = !decl.names.empty() && decl.names[0].text.starts_with("%");
  const bool edge = decl.edge != frontend::Edge::kNone && in_.form != Edition::kIec10;
  if (edge) {
    diagnostics_.add(
        base::DiagnosticCode::kXmlTextOnly, decl.span,
        "PLCopen XML has no word for R_EDGE and F_EDGE: it stands in the declaration as "
        "text, which CODESYS reads and others leave out",
        "declare a BOOL, and call R_TRIG or F_TRIG in the body");
  }
  return !edge && !decl.binds && !unnamed;
}

bool Writer::put_list(Node parent, const VarBlock& block, const std::string& name,
                      frontend::Range32 attributes) {
  bool declared = block.vars.empty();
  for (const VarDecl& decl : block.vars) declared = declared || !is_made(decl);
  if (!declared) return true;
  const char* element = list_name(block.section);
  if (element == nullptr) return false;
  // In a POU, TC6 has elements for variables there, and none for what they lead to.
  const bool in_pou = std::string_view(parent.name()) == "interface";
  if (in_pou && block.section == VarSection::kAccess && in_.form != Edition::kIec10) return false;
  Node list = parent.append_child(element);
  if (!name.empty()) list.append_attribute("name") = name.c_str();
  const std::string head = flat(block.span);
  auto flag = [&](bool value, const char* word) {
    if (value) list.append_attribute(word) = "true";
  };
  const bool persistent = head.find("PERSISTENT") != std::string::npos;
  flag(block.constant, "constant");
  flag(block.retain && (!persistent || head.find("RETAIN") != std::string::npos), "retain");
  flag(persistent, "persistent");
  flag(block.non_retain, "nonretain");
  bool whole = block.access == frontend::Access::kDefault;
  for (const VarDecl& decl : block.vars) {
    if (!is_made(decl)) whole = put_variable(list, block, decl) && whole;
  }
  put_attributes(list, attributes);
  // A list with a name is tagged after this, and its comment is that of the source.
  if (name.empty()) put_documentation(list, comment_before(block.span.begin));
  return whole;
}

bool Writer::put_lists(Node parent, const std::vector<VarBlock>& blocks) {
  bool whole = true;
  for (const VarBlock& block : blocks)
    whole = put_list(parent, block, {}, block.attributes) && whole;
  return whole;
}

}  // namespace plcopen
