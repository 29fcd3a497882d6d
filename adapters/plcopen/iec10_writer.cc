// PLCopen XML -> IEC 61131-10: declarations. Only what is known of the format.
#include "adapters/plcopen/iec10_writer.h"

namespace plcopen {

void Iec10Writer::documentation(Node to, Node from) {
  Node node = from.child("documentation");
  if (node) set(text(to, "Documentation", xml::text_of(node)), "xsi:type", "SimpleText");
}

namespace {

// Is it data of CODESYS? That has elements of its own there, or none.
bool is_codesys(Node data) {
  return xml::attribute(data, "name").starts_with("http://www.3s-software.com/plcopenxml/");
}

}  // namespace

void Iec10Writer::other_data(Node to, Node from) {
  for (Node data : from.child("addData").children("data")) {
    if (is_codesys(data)) continue;
    Node add = to.child("AddData");
    if (!add) add = to.prepend_child("AddData");
    Node out = add.append_child("Data");
    copy(out, "name", data, "name");
    copy(out, "handleUnknown", data, "handleUnknown");
    for (Node below : data.children()) out.append_copy(below);
  }
}

void Iec10Writer::array(Node to, Node from) {
  set(to, "xsi:type", "ArrayTypeSpec");
  type(to.append_child("BaseType"), from.child("baseType"));
  uint32_t number = 0;
  for (Node dimension : from.children("dimension")) {
    Node out = to.append_child("DimensionSpec");
    out.append_attribute("dimensionNumber") = ++number;
    Node range = out.append_child("IndexRange");
    copy(range, "lower", dimension, "lower");
    copy(range, "upper", dimension, "upper");
  }
}

void Iec10Writer::type(Node to, Node from) {
  Node node = xml::first_element(from);
  const std::string_view kind = xml::local_name(node);
  if (kind == "array") return array(to.append_child("InstantlyDefinedType"), node);
  std::string name(kind);
  if (kind == "derived") {
    name = xml::attribute(node, "name");
    if (name.find(' ') != std::string::npos || name.find('(') != std::string::npos) {
      problem(from.parent(), "the type `" + name + "` has no known element in IEC 61131-10");
    }
  } else if (kind == "string" || kind == "wstring") {
    name = kind == "string" ? "STRING" : "WSTRING";
    std::string_view length = xml::attribute(node, "length");
    if (!length.empty()) name += "[" + std::string(length) + "]";
  } else if (xml::first_element(node)) {
    problem(from.parent(), "the type <" + name + "> has no known element in IEC 61131-10");
  }
  text(to, "TypeName", name);
}

void Iec10Writer::enumeration(Node to, Node from) {
  size_t given = 0, count = 0;
  for (Node each : from.child("values").children("value")) {
    ++count;
    given += each.attribute("value") ? 1 : 0;
  }
  if (given != 0 && given != count) {
    problem(to.parent(), "an enumeration has values for all of its names or for none");
  }
  set(to, "xsi:type", given != 0 ? "EnumTypeWithNamedValueSpec" : "EnumTypeSpec");
  for (Node each : from.child("values").children("value")) {
    Node out = to.append_child("Enumerator");
    copy(out, "name", each, "name");
    copy(out, "value", each, "value");
  }
  Node base = xml::first_element(from.child("baseType"));
  if (given != 0) text(to, "BaseType", base ? std::string(xml::local_name(base)) : "INT");
  if (given == 0 && base) problem(to.parent(), "the base of an enumeration needs its values");
}

void Iec10Writer::specification(Node to, Node from) {
  Node node = xml::first_element(from);
  if (node.child("variable") || xml::is(node, "struct")) {
    set(to, "xsi:type", "StructTypeSpec");
    for (Node member : node.children("variable")) variable(to.append_child("Member"), member, 0);
  } else if (xml::is(node, "enum")) {
    enumeration(to, node);
  } else if (xml::is(node, "array")) {
    array(to, node);
  } else {
    problem(from.parent(),
            "types other than structures, enumerations and arrays have no known "
            "element in IEC 61131-10");
  }
}

void Iec10Writer::value(Node to, Node from) {
  Node node = xml::first_element(from);
  if (xml::is(node, "simpleValue")) {
    copy(to.append_child("SimpleValue"), "value", node, "value");
    return;
  }
  const bool array_value = xml::is(node, "arrayValue");
  Node list = to.append_child(array_value ? "ArrayValue" : "StructValue");
  for (Node part : node.children("value")) {
    Node out = list.append_child("Value");
    copy(out, "repetitionValue", part, "repetitionValue");
    copy(out, "member", part, "member");
    value(out, part);
  }
}

// `to` is the element itself; `order` of a parameter, 0: none.
void Iec10Writer::variable(Node to, Node from, uint32_t order) {
  copy(to, "name", from, "name");
  if (order != 0) to.append_attribute("orderWithinParamSet") = order;
  copy(to, "edgeDetection", from, "edge");
  documentation(to, from);
  type(to.append_child("Type"), from.child("type"));
  if (from.child("initialValue")) {
    value(to.append_child("InitialValue"), from.child("initialValue"));
  }
  if (from.attribute("address")) copy(to.append_child("Address"), "address", from, "address");
  if (from.child("addData")) problem(from, "attributes of variables have no element");
}

void Iec10Writer::list(Node to, const char* name, Node from, uint32_t order) {
  Node out = to.append_child(name);
  if (std::string_view(name) == "Vars") set(out, "accessSpecifier", "private");
  for (const char* word : {"name", "constant", "retain", "persistent"}) copy(out, word, from, word);
  copy(out, "non_retain", from, "nonretain");
  for (Node each : from.children("variable")) {
    variable(out.append_child("Variable"), each, order);
    if (order != 0) ++order;
  }
  for (Node data : from.child("addData").children("data")) {
    if (is_codesys(data)) problem(from, "attributes of lists of variables have no element");
  }
  other_data(out, from);
}

void Iec10Writer::bases(Node to, Node interface) {
  for (Node data : interface.child("addData").children("data")) {
    Node inheritance = data.child("Inheritance");
    for (Node base : inheritance.children()) {
      text(to.append_child(base.name()), "TypeName", xml::text_of(base));
    }
    Node access = data.child("AccessModifiers");
    for (pugi::xml_attribute word : access.attributes()) {
      std::string name(word.name());
      name[0] = static_cast<char>(name[0] | 0x20);
      const bool kind = name == "abstract" || name == "final";
      set(to, kind ? name.c_str() : "accessSpecifier", kind ? "true" : name);
    }
    if (data.child("Attributes")) problem(interface.parent(), "attributes have no element");
  }
}

void Iec10Writer::members(Node to, Node from, bool program) {
  struct Form {
    const char* from;
    const char* to;
  };
  static constexpr Form kParameters[] = {
      {"inOutVars", "InoutVars"}, {"inputVars", "InputVars"}, {"outputVars", "OutputVars"}};
  static constexpr Form kLists[] = {
      {"externalVars", "ExternalVars"}, {"localVars", "Vars"}, {"tempVars", "TempVars"}};
  Node interface = from.child("interface");
  bases(to, interface);
  documentation(to, from);
  if (interface.child("returnType"))
    type(to.append_child("ResultType"), interface.child("returnType"));
  Node parameters;
  for (const Form& form : kParameters) {
    // Numbered as they are declared, through all sections.
    uint32_t order = 1;
    for (Node each : interface.children()) {
      const bool own = xml::is(each, form.from);
      if (own && !parameters) parameters = to.append_child("Parameters");
      if (own) list(parameters, form.to, each, order);
      for (const Form& other : kParameters) {
        if (!xml::is(each, other.from)) continue;
        for (Node variable : each.children("variable")) order += variable ? 1 : 0;
      }
    }
  }
  if (program && parameters) problem(from, "parameters of a program have no known element");
  for (const Form& form : kLists) {
    for (Node each : interface.children(form.from)) list(to, form.to, each, 0);
  }
  for (Node data : from.child("addData").children("data")) {
    if (Node method = data.child("Method")) {
      Node out = to.append_child("Method");
      copy(out, "name", method, "name");
      members(out, method, false);
    } else if (is_codesys(data)) {
      problem(from, "what stands in addData `" + std::string(xml::attribute(data, "name")) +
                        "` has no known element");
    }
  }
  for (Node action : from.child("actions").children("action")) {
    Node out = to.append_child("Action");
    copy(out, "name", action, "name");
    body(out, "Body", action.child("body"));
  }
  if (from.child("body")) body(to, "MainBody", from.child("body"));
  other_data(to, from);
}

void Iec10Writer::pou(Node to, Node from, const char* element) {
  Node out = to.append_child(element);
  copy(out, "name", from, "name");
  members(out, from, std::string_view(element) == "Program");
}

void Iec10Writer::resource(Node to, Node from) {
  Node out = to.append_child("Resource");
  copy(out, "name", from, "name");
  set(out, "resourceTypeName", "PLC");
  for (Node each : from.children("globalVars")) list(out, "GlobalVars", each, 0);
  for (Node task : from.children("task")) {
    Node made = out.append_child("Task");
    set(made, "xsi:type", "StandardTask");
    for (const char* name : {"name", "single", "interval", "priority"})
      copy(made, name, task, name);
    if (task.child("addData")) problem(task, "attributes of tasks have no element");
  }
  if (from.child("addData")) problem(from, "attributes of resources have no element");
  auto instance = [&](Node each, std::string_view task) {
    Node made = out.append_child("ProgramInstance");
    copy(made, "name", each, "name");
    copy(made, "typeName", each, "typeName");
    if (!task.empty()) set(made, "associatedTaskName", task);
  };
  for (Node task : from.children("task")) {
    for (Node each : task.children("pouInstance")) instance(each, xml::attribute(task, "name"));
  }
  for (Node each : from.children("pouInstance")) instance(each, {});
}

void Iec10Writer::project(Node from, Node to) {
  Node file = to.append_child("FileHeader");
  for (const char* name : {"companyName", "productName", "productVersion"}) {
    set(file, name, xml::attribute(from.child("fileHeader"), name));
  }
  Node content = to.append_child("ContentHeader");
  copy(content, "name", from.child("contentHeader"), "name");
  copy(content, "creationDateTime", from.child("fileHeader"), "creationDateTime");
  Node space = to.append_child("Types").append_child("GlobalNamespace");
  for (Node type : from.child("types").child("dataTypes").children("dataType")) {
    owner_ = xml::attribute(type, "name");
    Node out = space.append_child("DataTypeDecl");
    copy(out, "name", type, "name");
    documentation(out, type);
    for (Node data : type.child("addData").children("data")) {
      if (is_codesys(data)) problem(type, "this type has no known element");
    }
    if (type.child("initialValue")) problem(type, "initial values of types have no known element");
    specification(out.append_child("UserDefinedTypeSpec"), type.child("baseType"));
    other_data(out, type);
  }
  for (Node each : from.child("types").child("pous").children("pou")) {
    owner_ = xml::attribute(each, "name");
    const std::string_view kind = xml::attribute(each, "pouType");
    pou(space, each,
        kind == "program"    ? "Program"
        : kind == "function" ? "Function"
                             : "FunctionBlock");
  }
  owner_.clear();
  std::vector<Node> lists;
  for (Node data : from.child("addData").children("data")) {
    if (data.child("globalVars")) {
      lists.push_back(data.child("globalVars"));
    } else if (is_codesys(data)) {
      problem(from, "what stands in addData `" + std::string(xml::attribute(data, "name")) +
                        "` has no known element");
    }
  }
  Node instances = to.append_child("Instances");
  for (Node each : from.child("instances").child("configurations").children("configuration")) {
    Node out = instances.append_child("Configuration");
    copy(out, "name", each, "name");
    for (Node node : each.children("globalVars")) list(out, "GlobalVars", node, 0);
    for (Node node : each.children("resource")) resource(out, node);
    for (const char* other : {"accessVars", "configVars"}) {
      if (each.child(other)) problem(each, std::string(other) + " has no known element");
    }
    for (Node data : each.child("addData").children("data")) {
      if (is_codesys(data)) problem(each, "attributes have no known element");
    }
    other_data(out, each);
  }
  other_data(content, from);
  if (lists.empty()) return;
  // The globals stand in a configuration that runs nothing.
  Node configuration = instances.append_child("Configuration");
  set(configuration, "name", "Config");
  Node made = configuration.append_child("Resource");
  set(made, "name", "Resource");
  set(made, "resourceTypeName", "PLC");
  for (Node each : lists) list(made, "GlobalVars", each, 0);
}

Unsaid to_iec10(Node project, pugi::xml_document& out) {
  Node declaration = out.append_child(pugi::node_declaration);
  declaration.append_attribute("version") = "1.0";
  declaration.append_attribute("encoding") = "utf-8";
  Node root = out.append_child("Project");
  root.append_attribute("xmlns") = "www.iec.ch/public/TC65SC65BWG7TF10";
  root.append_attribute("xmlns:xsi") = "http://www.w3.org/2001/XMLSchema-instance";
  root.append_attribute("schemaVersion") = "1.0";
  Iec10Writer writer;
  writer.project(project, root);
  return writer.problems;
}

}  // namespace plcopen
