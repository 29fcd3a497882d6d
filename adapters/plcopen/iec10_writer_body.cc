// PLCopen XML -> IEC 61131-10: bodies. Networks have numbers there, and connections lead to pins.
#include "adapters/plcopen/iec10_writer.h"

namespace plcopen {

void Iec10Writer::body(Node to, const char* name, Node from) {
  Node language = xml::first_element(from);
  const std::string kind(xml::local_name(language));
  Node content = to.append_child(name).append_child("BodyContent");
  set(content, "xsi:type", kind);
  const uint32_t before = count_;
  if (kind == "SFC") problem(from.parent(), "charts have no known elements");
  if (kind == "ST" || kind == "IL") {
    text(content, kind.c_str(), xml::text_of(language));
  } else if (kind != "SFC") {
    diagram(content, language, kind == "LD");
  }
  if (count_ == before) return;
  to.child(name).remove_child(content);
  content = to.child(name).append_child("BodyContent");
  set(content, "xsi:type", "ST");
  text(content, "ST", kTextOnlyBody);
}

void Iec10Writer::diagram(Node to, Node from, bool ladder) {
  uint32_t number = 0;
  for (Node network : from.children("network")) {
    Node out = to.append_child(ladder ? "Rung" : "Network");
    if (!ladder) set(out, "xsi:type", "FbdNetwork");
    out.append_attribute("evaluationOrder") = ++number;
    pins_.clear();
    uint32_t id = 0;
    for (Node each : network.children()) {
      const std::string local(xml::attribute(each, "localId"));
      if (each.child("connectionPointOut")) pins_[local + "|"] = ++id;
      for (Node pin : each.child("outputVariables").children("variable")) {
        pins_[local + "|" + pin.attribute("formalParameter").value()] = ++id;
      }
    }
    for (Node each : network.children()) {
      if (xml::is(each, "label")) copy(out, "label", each, "label");
    }
    for (Node each : network.children()) object(out, each);
  }
}

void Iec10Writer::connection_in(Node to, Node from) {
  for (Node point : from.children("connectionPointIn")) {
    Node out = to.append_child("ConnectionPointIn");
    for (Node connection : point.children("connection")) {
      const std::string key = std::string(xml::attribute(connection, "refLocalId")) + "|" +
                              connection.attribute("formalParameter").value();
      out.append_child("Connection").append_attribute("refConnectionPointOutId") = pins_[key];
    }
  }
}

void Iec10Writer::connection_out(Node to, Node from, const std::string& pin) {
  Node owner = from;
  while (owner && !owner.attribute("localId")) owner = owner.parent();
  const std::string key = std::string(xml::attribute(owner, "localId")) + "|" + pin;
  to.append_child("ConnectionPointOut").append_attribute("connectionPointOutId") = pins_[key];
}

void Iec10Writer::block(Node to, Node from) {
  struct Form {
    const char* from;
    const char* list;
    const char* element;
  };
  static constexpr Form kForms[] = {{"inOutVariables", "InOutVariables", "InOutVariable"},
                                    {"inputVariables", "InputVariables", "InputVariable"},
                                    {"outputVariables", "OutputVariables", "OutputVariable"}};
  for (const Form& form : kForms) {
    Node list = from.child(form.from);
    if (!list.child("variable")) continue;
    Node made = to.append_child(form.list);
    for (Node pin : list.children("variable")) {
      Node out = made.append_child(form.element);
      set(out, "parameterName", pin.attribute("formalParameter").value());
      copy(out, "negated", pin, "negated");
      copy(out, "edge", pin, "edge");
      connection_in(out, pin);
      if (pin.child("connectionPointOut")) {
        connection_out(out, pin, pin.attribute("formalParameter").value());
      }
    }
  }
}

void Iec10Writer::object(Node to, Node from) {
  struct Form {
    const char* from;
    const char* element;
    const char* type;
    const char* operand;  // child that is an attribute there
    const char* attribute;
  };
  static constexpr Form kForms[] = {
      {"leftPowerRail", "LdObject", "LeftPowerRail", nullptr, nullptr},
      {"rightPowerRail", "LdObject", "RightPowerRail", nullptr, nullptr},
      {"contact", "LdObject", "Contact", "variable", "operand"},
      {"coil", "LdObject", "Coil", "variable", "operand"},
      {"block", "FbdObject", "Block", nullptr, nullptr},
      {"inVariable", "FbdObject", "DataSource", "expression", "identifier"},
      {"outVariable", "FbdObject", "DataSink", "expression", "identifier"},
      {"jump", "FbdObject", "Jump", nullptr, nullptr},
      {"return", "FbdObject", "Return", nullptr, nullptr},
      {"comment", "CommonObject", "Comment", nullptr, nullptr}};
  for (const Form& form : kForms) {
    if (!xml::is(from, form.from)) continue;
    Node out = to.append_child(form.element);
    set(out, "xsi:type", form.type);
    if (form.operand != nullptr) set(out, form.attribute, xml::text_of(from.child(form.operand)));
    const bool sink = xml::is(from, "outVariable");
    for (const char* name : {"negated", "edge"}) {
      if (sink && from.attribute(name)) problem(from, "a DataSink has no modifiers");
      copy(out, name, from, name);
    }
    copy(out, sink ? "storage" : "latch", from, "storage");
    if (sink && from.attribute("storage")) problem(from, "a DataSink has no modifiers");
    copy(out, "targetNetworkLabel", from, "label");
    copy(out, "typeName", from, "typeName");
    copy(out, "instanceName", from, "instanceName");
    documentation(out, from);
    Node position = out.append_child("RelPosition");
    copy(position, "x", from.child("position"), "x");
    copy(position, "y", from.child("position"), "y");
    if (xml::is(from, "comment")) {
      set(text(out, "Content", xml::text_of(from.child("content"))), "xsi:type", "SimpleText");
    }
    if (xml::is(from, "block")) return block(out, from);
    connection_in(out, from);
    if (from.child("connectionPointOut")) connection_out(out, from, {});
    return;
  }
}

}  // namespace plcopen
