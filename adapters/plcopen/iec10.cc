// IEC 61131-10 -> PLCopen XML: declarations.
#include "adapters/plcopen/iec10.h"

#include <algorithm>

#include "adapters/plcopen/iec10_reader.h"
#include "base/name_case.h"

namespace plcopen {

bool is_iec10(const xml::Document& document) {
  return xml::is(document.root(), "Project") && xml::find(document.root(), {"Types"});
}

std::string_view Iec10Reader::kind_of(Node node) {
  return xml::local_name(xml::attribute(node, "type"));
}

Node Iec10Reader::made(Node parent, const char* name, Node from) {
  Node out = parent.append_child(name);
  out_.origins.emplace(out.internal_object(), from);
  return out;
}

void Iec10Reader::copy(Node to, const char* name, Node from, const char* attribute) {
  std::string_view value = xml::attribute(from, attribute);
  if (!value.empty()) to.append_attribute(name) = std::string(value).c_str();
}

void Iec10Reader::unknown(Node node, const std::string& what) {
  report_.add(Code::kXmlNotUnderstood, node, what + " is not known here");
}

// Documentation and AddData.
void Iec10Reader::common(Node to, Node from) {
  if (Node text = xml::child(from, "Documentation")) {
    made(to, "documentation", text)
        .append_child(pugi::node_pcdata)
        .set_value(xml::text_of(text).c_str());
  }
  for (Node data : xml::children(xml::child(from, "AddData"), "Data")) {
    Node declaration = xml::find(data, {"textDeclaration", "content"});
    if (declaration) {
      std::string text(xml::trimmed(xml::text_of(declaration)));
      for (const char* end : {"END_PROGRAM", "END_FUNCTION_BLOCK", "END_FUNCTION"}) {
        if (text.ends_with(end)) text.resize(text.size() - std::string_view(end).size());
      }
      made(to, "InterfaceAsPlainText", data)
          .append_child(pugi::node_pcdata)
          .set_value(text.c_str());
      continue;
    }
    Node add = to.child("addData");
    if (!add) add = made(to, "addData", data);
    Node part = made(add, "data", data);
    copy(part, "name", data, "name");
    copy(part, "handleUnknown", data, "handleUnknown");
    for (Node below : xml::children(data)) part.append_copy(below);
  }
}

// TypeName, or a type that stands here.
void Iec10Reader::type(Node to, Node from) {
  Node defined = xml::child(from, "InstantlyDefinedType");
  if (defined) return specification(to, defined);
  std::string name(xml::trimmed(xml::text_of(xml::child(from, "TypeName"))));
  std::replace(name.begin(), name.end(), '\\', '.');
  if (name.empty()) {
    return report_.add(Code::kXmlMissing, from, xml::shown(from) + " has no <TypeName>");
  }
  made(to, "derived", from).append_attribute("name") = name.c_str();
}

void Iec10Reader::specification(Node to, Node from) {
  const std::string_view kind = kind_of(from);
  if (kind == "StructTypeSpec") {
    Node out = made(to, "struct", from);
    if (xml::boolean(xml::attribute(from, "overlap")).value_or(false)) {
      report_.add(Code::kXmlBadValue, from, "a structure whose members overlap cannot be imported");
    }
    for (Node member : xml::children(from, "Member")) variable(out, member);
  } else if (kind == "EnumTypeSpec" || kind == "EnumTypeWithNamedValueSpec") {
    Node out = made(to, "enum", from);
    Node values = made(out, "values", from);
    for (Node each : xml::children(from, "Enumerator")) {
      Node value = made(values, "value", each);
      copy(value, "name", each, "name");
      copy(value, "value", each, "value");
    }
    Node base = xml::child(from, "BaseType");
    std::string name(xml::trimmed(xml::text_of(base)));
    if (!name.empty()) {
      made(made(out, "baseType", base), "derived", base).append_attribute("name") = name.c_str();
    }
  } else if (kind == "ArrayTypeSpec") {
    Node out = made(to, "array", from);
    std::vector<Node> dimensions = xml::children(from, "DimensionSpec");
    std::stable_sort(dimensions.begin(), dimensions.end(), [](Node a, Node b) {
      return a.attribute("dimensionNumber").as_int() < b.attribute("dimensionNumber").as_int();
    });
    for (Node each : dimensions) {
      Node range = xml::child(each, "IndexRange");
      Node dimension = made(out, "dimension", each);
      if (range) {
        copy(dimension, "lower", range, "lower");
        copy(dimension, "upper", range, "upper");
      } else {
        dimension.append_attribute("lower") = "*";
      }
    }
    type(made(out, "baseType", from), xml::child(from, "BaseType"));
  } else if (Node base = xml::child(from, "BaseType");
             base && xml::children(from).size() == 1 && from.attribute("lower").empty()) {
    type(to, base);
  } else {
    report_.add(Code::kXmlBadValue, from,
                "the type specification `" + std::string(kind) + "` is not known here");
  }
}

void Iec10Reader::value(Node to, Node from) {
  for (Node node : xml::children(from)) {
    if (xml::is(node, "SimpleValue")) {
      copy(made(to, "simpleValue", node), "value", node, "value");
    } else if (xml::is(node, "ArrayValue") || xml::is(node, "StructValue")) {
      const bool array = xml::is(node, "ArrayValue");
      Node list = made(to, array ? "arrayValue" : "structValue", node);
      for (Node part : xml::children(node, "Value")) {
        Node out = made(list, "value", part);
        copy(out, array ? "repetitionValue" : "member", part, array ? "repetitionValue" : "member");
        value(out, part);
      }
    }
  }
}

void Iec10Reader::variable(Node list, Node from) {
  Node out = made(list, "variable", from);
  copy(out, "name", from, "name");
  copy(out, "address", xml::child(from, "Address"), "address");
  copy(out, "edge", from, "edgeDetection");
  type(made(out, "type", from), xml::child(from, "Type"));
  if (Node initial = xml::child(from, "InitialValue")) {
    value(made(out, "initialValue", initial), initial);
  }
  common(out, from);
}

void Iec10Reader::list(Node to, const char* name, Node from, const std::vector<Node>& variables) {
  Node out = made(to, name, from);
  copy(out, "name", from, "name");
  copy(out, "constant", from, "constant");
  copy(out, "retain", from, "retain");
  copy(out, "persistent", from, "persistent");
  for (const char* word : {"nonRetain", "non_retain", "nonretain"}) {
    copy(out, "nonretain", from, word);
  }
  for (Node each : variables) variable(out, each);
  common(out, from);
}

// Their order goes through all sections, and calls without names depend on it.
void Iec10Reader::parameters(Node to, Node from) {
  static constexpr std::pair<const char*, const char*> kForms[] = {{"InputVars", "inputVars"},
                                                                   {"OutputVars", "outputVars"},
                                                                   {"InoutVars", "inOutVars"},
                                                                   {"InOutVars", "inOutVars"}};
  struct Parameter {
    int order;
    const char* name;
    Node section;
    Node variable;
  };
  std::vector<Parameter> all;
  for (Node section : xml::children(from)) {
    for (auto [element, name] : kForms) {
      if (!xml::is(section, element)) continue;
      for (Node each : xml::children(section, "Variable")) {
        all.push_back({each.attribute("orderWithinParamSet").as_int(), name, section, each});
      }
    }
  }
  std::stable_sort(all.begin(), all.end(),
                   [](const Parameter& a, const Parameter& b) { return a.order < b.order; });
  for (size_t i = 0; i < all.size();) {
    std::vector<Node> run;
    const size_t first = i;
    for (; i < all.size() && all[i].section == all[first].section; ++i) {
      run.push_back(all[i].variable);
    }
    list(to, all[first].name, all[first].section, run);
  }
}

// Variables, result, bases: <interface>.
void Iec10Reader::interface(Node to, Node from) {
  struct Form {
    const char* from;
    const char* to;
  };
  static constexpr Form kForms[] = {{"ExternalVars", "externalVars"},
                                    {"Vars", "localVars"},
                                    {"TempVars", "tempVars"},
                                    {"GlobalVars", "globalVars"}};
  Node out = made(to, "interface", from);
  if (Node result = xml::child(from, "ResultType")) {
    type(made(out, "returnType", result), result);
  }
  parameters(out, xml::child(from, "Parameters"));
  for (Node node : xml::children(from)) {
    for (const Form& form : kForms) {
      if (xml::is(node, form.from)) list(out, form.to, node, xml::children(node, "Variable"));
    }
  }
  for (auto [element, name] :
       {std::pair("Extends", "Extends"), std::pair("Implements", "Implements")}) {
    for (Node base : xml::children(from, element)) {
      Node target = data(out, "pouinheritance", "Inheritance", base);
      std::string text(xml::trimmed(xml::text_of(xml::child(base, "TypeName"))));
      std::replace(text.begin(), text.end(), '\\', '.');
      made(target, name, base).append_child(pugi::node_pcdata).set_value(text.c_str());
    }
  }
  std::string access(xml::attribute(from, "accessSpecifier"));
  if (!access.empty()) access[0] = static_cast<char>(access[0] & ~0x20);
  for (const char* word : {"Private", "Protected", "Internal"}) {
    if (access == word) {
      data(out, "accessmodifiers", "AccessModifiers", from).append_attribute(word) = "true";
    }
  }
  for (auto [attribute, word] : {std::pair("abstract", "Abstract"), std::pair("final", "Final")}) {
    if (!xml::boolean(xml::attribute(from, attribute)).value_or(false)) continue;
    data(out, "accessmodifiers", "AccessModifiers", from).append_attribute(word) = "true";
  }
}

// The element that CODESYS keeps something in; one per owner.
Node Iec10Reader::data(Node owner, const char* name, const char* element, Node from) {
  Node add = owner.child("addData");
  if (!add) add = made(owner, "addData", from);
  const std::string whole = "http://www.3s-software.com/plcopenxml/" + std::string(name);
  const bool several = std::string_view(name) == "method";
  for (Node each : add.children("data")) {
    if (!several && each.attribute("name").value() == whole) return each.child(element);
  }
  Node out = made(add, "data", from);
  out.append_attribute("name") = whole.c_str();
  return made(out, element, from);
}

void Iec10Reader::pou(Node to, Node from, const char* type) {
  Node out = made(to, "pou", from);
  copy(out, "name", from, "name");
  out.append_attribute("pouType") = type;
  members(out, from);
}

void Iec10Reader::members(Node out, Node from) {
  interface(out, from);
  common(out, from);
  Node actions;
  for (Node node : xml::children(from)) {
    if (xml::is(node, "MainBody") || xml::is(node, "Body")) {
      body(out, node);
    } else if (xml::is(node, "Action")) {
      if (!actions) actions = made(out, "actions", node);
      Node action = made(actions, "action", node);
      copy(action, "name", node, "name");
      common(action, node);
      for (const char* name : {"Body", "MainBody"}) {
        for (Node each : xml::children(node, name)) body(action, each);
      }
    } else if (xml::is(node, "Method")) {
      Node method = data(out, "method", "Method", node);
      copy(method, "name", node, "name");
      members(method, node);
    } else if (xml::is(node, "Transition") || xml::is(node, "Property")) {
      unknown(node, xml::shown(node));
    }
  }
}

// Everything of one namespace. `types`, `pous` and `others` are those of PLCopen XML.
void Iec10Reader::contents(Node from, Node types, Node pous, Node others) {
  struct Form {
    const char* element;
    const char* type;
  };
  static constexpr Form kForms[] = {{"Program", "program"},
                                    {"FunctionBlock", "functionBlock"},
                                    {"Function", "function"},
                                    {"Class", "class"}};
  for (Node node : xml::children(from)) {
    const Form* form = std::find_if(std::begin(kForms), std::end(kForms),
                                    [&](const Form& each) { return xml::is(node, each.element); });
    if (form != std::end(kForms)) {
      pou(pous, node, form->type);
    } else if (xml::is(node, "DataTypeDecl")) {
      Node out = made(types, "dataType", node);
      copy(out, "name", node, "name");
      common(out, node);
      Node specified = xml::child(node, "UserDefinedTypeSpec");
      specification(made(out, "baseType", node), specified ? specified : node);
      if (Node initial = xml::child(node, "InitialValue")) {
        value(made(out, "initialValue", initial), initial);
      }
    } else if (xml::is(node, "Interface")) {
      Node add = others.child("addData");
      if (!add) add = made(others, "addData", node);
      Node part = made(add, "data", node);
      part.append_attribute("name") = "http://www.3s-software.com/plcopenxml/interface";
      Node out = made(part, "Interface", node);
      copy(out, "name", node, "name");
      members(out, node);
    } else if (xml::is(node, "NamespaceDecl")) {
      Node out = made(others, "namespace", node);
      copy(out, "name", node, "name");
      Node inner = made(out, "types", node);
      contents(node, made(inner, "dataTypes", node), made(inner, "pous", node), out);
    } else if (!xml::is(node, "AddData") && !xml::is(node, "Documentation")) {
      unknown(node, xml::shown(node));
    }
  }
}

void Iec10Reader::resource(Node to, Node from) {
  Node out = made(to, "resource", from);
  copy(out, "name", from, "name");
  common(out, from);
  for (Node node : xml::children(from)) {
    if (xml::is(node, "GlobalVars")) {
      list(out, "globalVars", node, xml::children(node, "Variable"));
    } else if (xml::is(node, "Task")) {
      Node task = made(out, "task", node);
      for (const char* name : {"name", "interval", "priority", "single"}) {
        copy(task, name, node, name);
      }
      common(task, node);
    } else if (xml::is(node, "ProgramInstance")) {
      std::string_view name = xml::attribute(node, "associatedTaskName");
      Node owner = out;
      for (Node task : out.children("task")) {
        if (!name.empty() && base::same_name(task.attribute("name").value(), name)) owner = task;
      }
      if (!name.empty() && owner == out) {
        report_.add(Code::kXmlBadValue, node, "there is no task `" + std::string(name) + "` above");
      }
      Node instance = made(owner, "pouInstance", node);
      copy(instance, "name", node, "name");
      copy(instance, "typeName", node, "typeName");
    } else if (!xml::is(node, "AddData") && !xml::is(node, "Documentation")) {
      unknown(node, xml::shown(node));
    }
  }
}

void Iec10Reader::project(Node from) {
  Node out = made(out_.project, "project", from);
  Node types = made(out, "types", from);
  Node data_types = made(types, "dataTypes", from);
  Node pous = made(types, "pous", from);
  common(made(out, "contentHeader", from), xml::child(from, "ContentHeader"));
  contents(xml::find(from, {"Types", "GlobalNamespace"}), data_types, pous, out);
  Node configurations = made(made(out, "instances", from), "configurations", from);
  for (Node each : xml::children(xml::child(from, "Instances"), "Configuration")) {
    Node configuration = made(configurations, "configuration", each);
    copy(configuration, "name", each, "name");
    common(configuration, each);
    for (Node node : xml::children(each)) {
      if (xml::is(node, "Resource")) {
        resource(configuration, node);
      } else if (xml::is(node, "GlobalVars")) {
        list(configuration, "globalVars", node, xml::children(node, "Variable"));
      } else if (!xml::is(node, "AddData") && !xml::is(node, "Documentation")) {
        unknown(node, xml::shown(node));
      }
    }
  }
}

void from_iec10(Node project, Converted& out, xml::Reporter& report) {
  Iec10Reader(out, report).project(project);
}

}  // namespace plcopen
