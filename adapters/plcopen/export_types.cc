// Types and initial values as elements.
#include <algorithm>

#include "adapters/plcopen/writer.h"
#include "base/name_case.h"
#include "ir/types/types.h"

namespace plcopen {

using frontend::Expr;
using frontend::ExprKind;
using frontend::Spec;
using frontend::SpecKind;

namespace {

constexpr const char* kElementary[] = {"BOOL",  "BYTE", "WORD",  "DWORD", "LWORD", "SINT",  "INT",
                                       "DINT",  "LINT", "USINT", "UINT",  "UDINT", "ULINT", "REAL",
                                       "LREAL", "TIME", "DATE",  "TOD",   "DT"};
// The schema of TC6 is older than these: they are names there.
constexpr const char* kOfEdition3[] = {"LTIME", "LDATE", "LTOD", "LDT", "CHAR", "WCHAR"};

const char* element_of(std::string_view name, Edition form) {
  const auto same = [&](const char* known) { return base::same_name(name, known); };
  const auto found = std::find_if(std::begin(kElementary), std::end(kElementary), same);
  if (found != std::end(kElementary)) return *found;
  if (form != Edition::kIec10) return nullptr;
  const auto newer = std::find_if(std::begin(kOfEdition3), std::end(kOfEdition3), same);
  return newer != std::end(kOfEdition3) ? *newer : nullptr;
}

}  // namespace

// No element says these.
bool Writer::needs_text(const Spec& spec) const {
  switch (spec.kind) {
    case SpecKind::kUnion:
      return true;
    case SpecKind::kStruct:
      if (spec.overlap || spec.element.valid()) return true;
      for (const frontend::VarDecl& field : spec.fields) {
        if (field.has_address || needs_text(tree_[field.spec])) return true;
      }
      return false;
    case SpecKind::kArray:
      return needs_text(tree_[spec.element]);
    case SpecKind::kEnum:
      return std::any_of(
          spec.enumerators.begin(), spec.enumerators.end(),
          [](const frontend::Enumerator& each) { return each.attributes.count != 0; });
    default:
      return false;
  }
}

bool Writer::put_plain_type(Node parent, const Spec& spec) {
  switch (spec.kind) {
    case SpecKind::kNamed: {
      if (spec.has_args) return false;
      const char* const element =
          spec.qualifiers.count == 0 ? element_of(spec.name.text, in_.form) : nullptr;
      if (element != nullptr) {
        parent.append_child(element);
        return true;
      }
      parent.append_child("derived").append_attribute("name") = flat(spec.span).c_str();
      return true;
    }
    case SpecKind::kString: {
      Node node = parent.append_child(spec.wide ? "wstring" : "string");
      if (spec.length.valid()) {
        node.append_attribute("length") = flat(tree_[spec.length].span).c_str();
      }
      return true;
    }
    case SpecKind::kArray: {
      if (spec.open_bounds || spec.element_args.count != 0) return false;
      Node node = parent.append_child("array");
      for (const frontend::DimSpec& dim : spec.dims) {
        Node dimension = node.append_child("dimension");
        dimension.append_attribute("lower") = flat(tree_[dim.low].span).c_str();
        dimension.append_attribute("upper") = flat(tree_[dim.high].span).c_str();
      }
      put_type(node.append_child("baseType"), spec.element);
      return true;
    }
    case SpecKind::kSubrange: {
      const std::string base = flat(tree_[spec.element].span);
      const bool plain = !base.empty() && (base[0] == 'U' || base[0] == 'u');
      Node node = parent.append_child(plain ? "subrangeUnsigned" : "subrangeSigned");
      Node range = node.append_child("range");
      range.append_attribute("lower") = flat(tree_[spec.low].span).c_str();
      range.append_attribute("upper") = flat(tree_[spec.high].span).c_str();
      put_type(node.append_child("baseType"), spec.element);
      return true;
    }
    case SpecKind::kPointer:
      put_type(parent.append_child("pointer").append_child("baseType"), spec.element);
      return true;
    case SpecKind::kEnum: {
      Node node = parent.append_child("enum");
      Node values = node.append_child("values");
      for (const frontend::Enumerator& each : spec.enumerators) {
        Node value = values.append_child("value");
        value.append_attribute("name") = std::string(each.name.text).c_str();
        if (each.value.valid()) {
          value.append_attribute("value") = flat(tree_[each.value].span).c_str();
        }
      }
      if (spec.element.valid()) put_type(node.append_child("baseType"), spec.element);
      return true;
    }
    case SpecKind::kStruct: {
      Node node = parent.append_child("struct");
      for (const frontend::VarDecl& field : spec.fields) {
        put_variable(node, {}, field);
      }
      return true;
    }
    default:
      return false;
  }
}

void Writer::put_type(Node parent, SpecId id) {
  if (!id.valid()) return;
  const Spec& spec = tree_[id];
  if (needs_text(spec)) {
    return fail(spec.span, "`" + flat(spec.span).substr(0, 40) + "` has no element in PLCopen XML");
  }
  // References and the like go by their text; import() takes it so.
  if (!put_plain_type(parent, spec)) {
    parent.append_child("derived").append_attribute("name") = flat(spec.span).c_str();
  }
}

// Elements repeat one value a number of times; other repetitions go by their text.
bool Writer::has_elements(const Expr& value) const {
  if (value.kind != ExprKind::kArrayInit) return false;
  for (uint32_t i = 0; i < value.list.count; ++i) {
    const Expr& each = tree_[tree_.expr_lists[value.list.first + i]];
    if (each.kind != ExprKind::kRepeat) continue;
    const Expr& times = tree_[each.operand];
    if (times.kind != ExprKind::kLiteral || each.list.count != 1) return false;
    if (flat(times.span).find_first_not_of("0123456789") != std::string::npos) return false;
  }
  return true;
}

void Writer::put_value(Node parent, ExprId id) {
  const Expr& value = tree_[id];
  auto simple = [&](const std::string& text) {
    parent.append_child("simpleValue").append_attribute("value") = text.c_str();
  };
  if (has_elements(value)) {
    Node list = parent.append_child("arrayValue");
    for (uint32_t i = 0; i < value.list.count; ++i) {
      const ExprId part = tree_.expr_lists[value.list.first + i];
      const Expr& each = tree_[part];
      Node node = list.append_child("value");
      if (each.kind != ExprKind::kRepeat) {
        put_value(node, part);
        continue;
      }
      node.append_attribute("repetitionValue") = flat(tree_[each.operand].span).c_str();
      put_value(node, tree_.expr_lists[each.list.first]);
    }
    return;
  }
  if (value.kind != ExprKind::kStructInit) return simple(flat(value.span));
  for (uint32_t i = 0; i < value.list.count; ++i) {
    if (tree_.args[value.list.first + i].name.empty()) return simple(flat(value.span));
  }
  Node list = parent.append_child("structValue");
  for (uint32_t i = 0; i < value.list.count; ++i) {
    const frontend::Arg& arg = tree_.args[value.list.first + i];
    Node node = list.append_child("value");
    node.append_attribute("member") = std::string(arg.name.text).c_str();
    if (arg.value.valid()) put_value(node, arg.value);
  }
}

void Writer::data_type(Node parent, const frontend::TypeDecl& type) {
  if (tree_.in_namespace(type.scope)) {
    return fail(type.name.span, "a NAMESPACE has no element in PLCopen XML");
  }
  Node node = parent.append_child("dataType");
  node.append_attribute("name") = std::string(type.name.text).c_str();
  const Spec& spec = tree_[type.spec];
  Node base = node.append_child("baseType");
  const std::string text(slice(spec.span));
  if (needs_text(spec)) {
    base.append_child("struct");
    std::string declaration = "TYPE " + std::string(type.name.text) + " :";
    if (spec.kind == SpecKind::kStruct && spec.element.valid()) {
      declaration = "TYPE " + std::string(type.name.text) + " EXTENDS " +
                    flat(tree_[spec.element].span) + " :";
    }
    put_declaration(node,
                    attribute_text(type.attributes) + declaration + " " + text + ";\nEND_TYPE");
  } else {
    put_type(base, type.spec);
    if (type.init.valid()) put_value(node.append_child("initialValue"), type.init);
    put_attributes(node, type.attributes);
  }
  tag(node, type.name.span.begin);
  put_documentation(node, comment_before({type.name.span.begin.offset}));
}

}  // namespace plcopen
