// POUs, their members and bodies as elements.
#include "adapters/plcopen/writer.h"
#include "base/name_case.h"
#include "frontend/network/same.h"
#include "stdlib/registry.h"

namespace plcopen {

using frontend::PouKind;

base::SourcePos Writer::head_end(const Pou& pou) const {
  base::SourcePos end = pou.name.span.end;
  auto behind = [&](SpecId spec) {
    if (spec.valid()) end = std::max(end, tree_[spec].span.end);
  };
  if (pou.kind != PouKind::kGetter && pou.kind != PouKind::kSetter) behind(pou.result);
  for (SpecId spec : pou.extends) behind(spec);
  for (SpecId spec : pou.implements) behind(spec);
  return end;
}

namespace {

const char* access_word(frontend::Access access) {
  switch (access) {
    case frontend::Access::kPrivate:
      return "Private";
    case frontend::Access::kProtected:
      return "Protected";
    case frontend::Access::kInternal:
      return "Internal";
    default:
      return nullptr;
  }
}

bool is_property(PouKind kind) { return kind == PouKind::kGetter || kind == PouKind::kSetter; }

}  // namespace

// Result, variables and what CODESYS adds. Where something is lost, the declaration as text, too.
void Writer::interface(Node owner, const Pou& pou, const char* kind) {
  Node node = owner.append_child("interface");
  if (pou.result.valid()) put_type(node.append_child("returnType"), pou.result);
  const bool whole = put_lists(node, pou.blocks);
  if (!pou.extends.empty() || !pou.implements.empty()) {
    Node inheritance = data(node, "pouinheritance").append_child("Inheritance");
    auto add = [&](const char* name, const std::vector<SpecId>& specs) {
      for (SpecId spec : specs) {
        inheritance.append_child(name)
            .append_child(pugi::node_pcdata)
            .set_value(flat(tree_[spec].span).c_str());
      }
    };
    add("Extends", pou.extends);
    add("Implements", pou.implements);
  }
  const char* access = access_word(pou.access);
  if (access != nullptr || pou.is_abstract || pou.is_final) {
    Node words = data(node, "accessmodifiers").append_child("AccessModifiers");
    if (access != nullptr) words.append_attribute(access) = "true";
    if (pou.is_abstract) words.append_attribute("Abstract") = "true";
    if (pou.is_final) words.append_attribute("Final") = "true";
  }
  put_attributes(node, pou.attributes);
  // OVERRIDE and PUBLIC have no element either.
  const bool all_said = in_.kept == nullptr || !in_.kept->has_declarations;
  const bool said =
      all_said && whole && !pou.is_override && pou.access != frontend::Access::kPublic;
  if (said || is_property(pou.kind)) return;
  // Sections that no element has: the text goes first when this is read.
  std::string head = attribute_text(pou.attributes);
  head += undented(blanks_before(pou.span) + pieces(pou.span, head_end(pou)).head);
  if (*kind != 0) put_declaration(owner, head);
}

bool Writer::is_in_out(const std::string& type, const std::string& pin) const {
  for (const Pou& pou : tree_.pous) {
    if (!base::same_name(pou.name.text, type)) continue;
    for (const frontend::VarBlock& block : pou.blocks) {
      if (block.section != frontend::VarSection::kInOut) continue;
      for (const frontend::VarDecl& decl : block.vars) {
        for (const frontend::Name& name : decl.names) {
          if (base::same_name(name.text, pin)) return true;
        }
      }
    }
  }
  return false;
}

std::string Writer::input_name(const std::string& function, uint32_t position) const {
  for (const Pou& pou : tree_.pous) {
    if (!base::same_name(pou.name.text, function)) continue;
    uint32_t at = 0;
    for (const frontend::VarBlock& block : pou.blocks) {
      const bool given = block.section == frontend::VarSection::kInput ||
                         block.section == frontend::VarSection::kInOut;
      if (!given) continue;
      for (const frontend::VarDecl& decl : block.vars) {
        for (const frontend::Name& name : decl.names) {
          if (at++ == position) return std::string(name.text);
        }
      }
    }
  }
  return stdlib::parameter_at(function, position);
}

void Writer::put_body(Node body, const std::string& text, bool list, uint32_t drawn,
                      const std::string& path) {
  if (drawn != frontend::kNoDiagram) return diagram(body, tree_.diagrams[drawn], path);
  put_text(body, list ? "IL" : "ST", text);
}

void Writer::body(Node owner, const Pou& pou, const std::string& path) {
  Node node = owner.append_child("body");
  if (const xml::KeptChart* kept = kept_chart(pou)) {
    node.append_buffer(kept->chart.data(), kept->chart.size(), xml::kAsRead);
    return;
  }
  if (pou.chart != frontend::kNoChart) return chart(node, tree_.charts[pou.chart]);
  bool list = false;
  for (uint32_t i = 0; i < pou.body.count; ++i) {
    list = list || tree_[tree_.stmt_lists[pou.body.first + i]].instruction;
  }
  put_body(node, pieces(pou.span, head_end(pou)).body, list, pou.diagram, path);
}

void Writer::put_access(Node interface, frontend::Access access) {
  if (const char* word = access_word(access)) {
    data(interface, "accessmodifiers").append_child("AccessModifiers").append_attribute(word) =
        "true";
  }
}

void Writer::members(Node owner, const Pou& pou) {
  const std::string path(pou.name.text);
  const xml::KeptChart* kept = kept_chart(pou);
  for (size_t i = 0; i < pou.members.size(); ++i) {
    const Pou& member = pou.members[i];
    const std::string name(member.name.text);
    // The chart as it was drawn has it in a condition.
    if (kept != nullptr && kept->members.count(base::fold_name(name)) != 0) continue;
    if (member.kind == PouKind::kMethod) {
      Node node = data(owner, "method").append_child("Method");
      node.append_attribute("name") = name.c_str();
      interface(node, member, "METHOD");
      if (pou.kind != PouKind::kInterface) body(node, member, path + "." + name);
      put_documentation(node, comment_before(member.span.begin));
    }
    if (!is_property(member.kind)) continue;
    const bool second = i > 0 && is_property(pou.members[i - 1].kind) &&
                        base::same_name(pou.members[i - 1].name.text, name);
    if (second) continue;
    Node node = data(owner, "property").append_child("Property");
    node.append_attribute("name") = name.c_str();
    Node head = node.append_child("interface");
    put_type(head.append_child("returnType"), member.result);
    put_attributes(head, member.attributes);
    const bool both = i + 1 < pou.members.size() && is_property(pou.members[i + 1].kind) &&
                      base::same_name(pou.members[i + 1].name.text, name);
    const bool own = both && pou.members[i + 1].access != member.access;
    if (!own) put_access(head, member.access);
    for (size_t k = i; k < pou.members.size() && k < i + 2; ++k) {
      const Pou& accessor = pou.members[k];
      if (!is_property(accessor.kind) || !base::same_name(accessor.name.text, name)) break;
      const bool get = accessor.kind == PouKind::kGetter;
      Node inner = node.append_child(get ? "GetAccessor" : "SetAccessor");
      Node inside = inner.append_child("interface");
      put_lists(inside, accessor.blocks);
      if (own) put_access(inside, accessor.access);
      if (pou.kind != PouKind::kInterface) body(inner, accessor, path + "." + name);
    }
  }
}

void Writer::pou(Node parent, const Pou& pou) {
  const std::string name(pou.name.text);
  const char* type = pou.kind == PouKind::kFunction        ? "function"
                     : pou.kind == PouKind::kFunctionBlock ? "functionBlock"
                     : pou.kind == PouKind::kProgram       ? "program"
                                                           : nullptr;
  if (tree_.in_namespace(pou.scope) || type == nullptr || !pou.usings.empty()) {
    return fail(pou.name.span,
                "`" + name +
                    "` is a CLASS or belongs to a NAMESPACE, for which PLCopen XML has no "
                    "element");
  }
  Node node = parent.append_child("pou");
  node.append_attribute("name") = name.c_str();
  node.append_attribute("pouType") = type;
  interface(node, pou, type);
  Node actions = node.append_child("actions");
  auto add_action = [&](const frontend::Name& action, base::SourceSpan span,
                        const std::string& text, frontend::Range32 statements, uint32_t drawn,
                        frontend::Range32 attributes) {
    Node each = actions.append_child("action");
    each.append_attribute("name") = std::string(action.text).c_str();
    bool list = false;
    for (uint32_t i = 0; i < statements.count; ++i) {
      list = list || tree_[tree_.stmt_lists[statements.first + i]].instruction;
    }
    put_body(each.append_child("body"), text, list, drawn, name + "." + std::string(action.text));
    put_attributes(each, attributes);
    put_documentation(each, comment_before(span.begin));
  };
  for (const Pou& member : pou.members) {
    if (member.kind != PouKind::kAction) continue;
    add_action(member.name, member.span, pieces(member.span, head_end(member)).body, member.body,
               member.diagram, member.attributes);
  }
  const xml::KeptChart* kept = kept_chart(pou);
  if (pou.chart != frontend::kNoChart) {
    for (const frontend::ChartAction& action : tree_.charts[pou.chart].actions) {
      if (kept != nullptr && kept->members.count(base::fold_name(action.name.text)) != 0) continue;
      add_action(action.name, action.span, pieces(action.span, action.name.span.end).body,
                 action.body, action.diagram, action.attributes);
    }
  }
  if (!actions.first_child()) node.remove_child(actions);
  if (kept != nullptr && !kept->transitions.empty()) {
    node.append_buffer(kept->transitions.data(), kept->transitions.size(), xml::kAsRead);
  }
  body(node, pou, name);
  members(node, pou);
  tag(node, pou.span.begin);
  put_documentation(node, comment_before(pou.span.begin));
}

}  // namespace plcopen
