// IEC 61131-10 -> PLCopen XML: bodies. Networks have numbers there and none here, so they are put
// below each other; connections lead to pins there and to elements here.
#include <algorithm>
#include <cmath>

#include "adapters/plcopen/iec10_reader.h"

namespace plcopen {

namespace {

constexpr double kNetworkHeight = 100'000;
constexpr double kBodyHeight = 1'000'000'000;  // more is no place in a drawing

double y_of(Node object) {
  return std::clamp(xml::child(object, "RelPosition").attribute("y").as_double(), 0.0, kBodyHeight);
}

// 0: none
uint64_t order_of(Node object) { return object.attribute("evaluationOrder").as_ullong(); }

}  // namespace

// Room for each network, and how much smaller they are drawn where there are too many.
void Iec10Reader::measure(Node from) {
  double count = 1;
  double highest = 0;
  for (Node content : xml::children(from)) {
    for (Node network : xml::children(content)) {
      ++count;
      for (Node object : xml::children(network)) highest = std::max(highest, y_of(object));
    }
  }
  height_ = std::max(1.0, std::floor(std::min(kNetworkHeight, kBodyHeight / count)));
  scale_ = highest < height_ ? 1 : (height_ - 1) / highest;
}

void Iec10Reader::body(Node to, Node from) {
  ids_ = network_ = order_ = 0;
  measure(from);
  Node last;  // <body>
  for (Node content : xml::children(from)) {
    if (!xml::is(content, "BodyContent")) {
      if (!xml::is(content, "AddData") && !xml::is(content, "Documentation")) {
        unknown(content, xml::shown(content));
      }
      continue;
    }
    const bool ladder = static_cast<bool>(xml::child(content, "Rung"));
    const bool blocks = static_cast<bool>(xml::child(content, "Network"));
    std::string language(kind_of(content));
    if (ladder) language = "LD";  // sections of vendors, too
    if (blocks) language = "FBD";
    if (!last || !last.child(language.c_str())) last = made(to, "body", content);
    Node out = last.child(language.c_str());
    if (!out) out = made(last, language.c_str(), content);
    if (language == "ST" || language == "IL") {
      Node text = xml::child(content, language);
      out.append_child(pugi::node_pcdata).set_value((xml::text_of(text) + "\n").c_str());
    }
    if (language == "SFC") {
      report_.add(Code::kXmlBody, content, "charts of IEC 61131-10 are not read",
                  "export the project as PLCopen XML (TC6)");
    }
    std::vector<Node> networks = xml::children(content, ladder ? "Rung" : "Network");
    std::stable_sort(networks.begin(), networks.end(), [](Node a, Node b) {
      return a.attribute("evaluationOrder").as_int() < b.attribute("evaluationOrder").as_int();
    });
    for (Node network : networks) {
      ++network_;
      find_pins(network);
      find_orders(network);
      if (std::string_view label = xml::attribute(network, "label"); !label.empty()) {
        Node node = made(out, "label", network);
        node.append_attribute("label") = std::string(label).c_str();
        place(node, network);
      }
      for (Node object : xml::children(network)) this->object(out, object);
    }
  }
}

// Each network counts its own elements; here, one counts on from the other.
void Iec10Reader::find_orders(Node network) {
  std::map<uint64_t, uint32_t> ranks;
  for (Node object : xml::children(network)) {
    if (uint64_t order = order_of(object)) ranks[order] = 0;
  }
  for (auto& [order, rank] : ranks) rank = ++order_;
  orders_.clear();
  for (Node object : xml::children(network)) {
    if (uint64_t order = order_of(object)) orders_[object.internal_object()] = ranks[order];
  }
}

// Every object gets its local id before any is connected.
void Iec10Reader::find_pins(Node network) {
  pins_.clear();
  id_of_.clear();
  for (Node object : xml::children(network)) {
    const uint32_t id = ++ids_;
    id_of_[object.internal_object()] = id;
    auto add = [&](Node owner, const std::string& name) {
      for (Node point : xml::children(owner, "ConnectionPointOut")) {
        std::string pin(xml::attribute(point, "connectionPointOutId"));
        if (pin.empty() || pins_.emplace(pin, Pin{id, name}).second) continue;
        report_.add(Code::kXmlDoubleId, point, "connectionPointOutId " + pin + " is there twice");
      }
    };
    add(object, {});
    for (const char* list : {"OutputVariables", "InOutVariables"}) {
      for (Node pin : xml::children(xml::child(object, list))) {
        add(pin, std::string(xml::attribute(pin, "parameterName")));
      }
    }
  }
}

void Iec10Reader::place(Node out, Node from) {
  Node at = xml::child(from, "RelPosition");
  const bool network = xml::is(from, "Rung") || xml::is(from, "Network");
  Node position = made(out, "position", from);
  position.append_attribute("x") = network ? 0 : at.attribute("x").as_double();
  const double y = network ? 0 : std::floor(y_of(from) * scale_);
  position.append_attribute("y") = network_ * height_ + y;
}

void Iec10Reader::connect(Node out, Node from, Node body) {
  Node point = xml::child(from, "ConnectionPointIn");
  if (!point) return;
  Node made_point = made(out, "connectionPointIn", point);
  for (Node connection : xml::children(point)) {
    if (xml::is(connection, "FeedbackConnection")) {
      feedback(made_point, connection, body);
      continue;
    }
    if (!xml::is(connection, "Connection")) continue;
    Node target = made(made_point, "connection", connection);
    std::string ref(xml::attribute(connection, "refConnectionPointOutId"));
    auto found = pins_.find(ref);
    // One that is not there is reported where connections are followed.
    target.append_attribute("refLocalId") =
        found == pins_.end() ? ref.c_str() : std::to_string(found->second.element).c_str();
    if (found == pins_.end()) target.attribute("refLocalId") = ("pin " + ref).c_str();
    if (found != pins_.end() && !found->second.name.empty()) {
      target.append_attribute("formalParameter") = found->second.name.c_str();
    }
  }
}

// The value of the last time is in a variable, which the output writes.
void Iec10Reader::feedback(Node point, Node from, Node body) {
  const std::string variable(report_.required(from, "feedbackVariable"));
  made(point, "expression", from).append_child(pugi::node_pcdata).set_value(variable.c_str());
  Node sink = made(body, "outVariable", from);
  sink.append_attribute("localId") = ++ids_;
  made(sink, "expression", from).append_child(pugi::node_pcdata).set_value(variable.c_str());
  place(sink, from.parent().parent());
  auto found = pins_.find(std::string(xml::attribute(from, "refConnectionPointOutId")));
  Node target = made(made(sink, "connectionPointIn", from), "connection", from);
  target.append_attribute("refLocalId") =
      found == pins_.end() ? "pin" : std::to_string(found->second.element).c_str();
  if (found != pins_.end() && !found->second.name.empty()) {
    target.append_attribute("formalParameter") = found->second.name.c_str();
  }
}

void Iec10Reader::pin(Node list, Node from) {
  Node out = made(list, "variable", from);
  out.append_attribute("formalParameter") =
      std::string(xml::attribute(from, "parameterName")).c_str();
  copy(out, "negated", from, "negated");
  copy(out, "edge", from, "edge");
  copy(out, "storage", from, "latch");
  connect(out, from, list.parent().parent());
}

void Iec10Reader::block(Node out, Node from) {
  copy(out, "typeName", from, "typeName");
  copy(out, "instanceName", from, "instanceName");
  struct Form {
    const char* from;
    const char* to;
  };
  static constexpr Form kForms[] = {{"InputVariables", "inputVariables"},
                                    {"InOutVariables", "inOutVariables"},
                                    {"OutputVariables", "outputVariables"}};
  for (const Form& form : kForms) {
    Node list = xml::child(from, form.from);
    if (!list) continue;
    Node made_list = made(out, form.to, list);
    for (Node each : xml::children(list)) pin(made_list, each);
  }
}

void Iec10Reader::object(Node to, Node from) {
  struct Form {
    const char* from;
    const char* to;
    const char* operand;  // attribute
    const char* element;  // what it becomes: an element; null: an attribute
    const char* attribute;
  };
  static constexpr Form kForms[] = {
      {"LeftPowerRail", "leftPowerRail", nullptr, nullptr, nullptr},
      {"RightPowerRail", "rightPowerRail", nullptr, nullptr, nullptr},
      {"Contact", "contact", "operand", "variable", nullptr},
      {"Coil", "coil", "operand", "variable", nullptr},
      {"DataSource", "inVariable", "identifier", "expression", nullptr},
      {"DataSink", "outVariable", "identifier", "expression", nullptr},
      {"Block", "block", nullptr, nullptr, nullptr},
      {"Return", "return", nullptr, nullptr, nullptr},
      {"Jump", "jump", "targetNetworkLabel", nullptr, "label"},
      {"Connector", "connector", "label", nullptr, "name"},
      {"Continuation", "continuation", "label", nullptr, "name"},
      {"Comment", "comment", nullptr, nullptr, nullptr}};
  if (xml::is(from, "AddData") || xml::is(from, "Documentation") || xml::is(from, "RelPosition") ||
      xml::is(from, "Size")) {
    return;
  }
  const std::string kind(kind_of(from));
  if (kind == "Unconnected") {
    return report_.add(Code::kXmlLeftOut, from, "a pin that is connected to nothing");
  }
  const Form* form = std::find_if(std::begin(kForms), std::end(kForms),
                                  [&](const Form& each) { return kind == each.from; });
  const bool known = form != std::end(kForms);
  Node out = made(to, known ? form->to : (kind.empty() ? "object" : kind.c_str()), from);
  out.append_attribute("localId") = id_of_[from.internal_object()];
  if (!known) return;  // reported where elements are read
  for (const char* name : {"negated", "edge"}) copy(out, name, from, name);
  copy(out, "storage", from, "latch");
  if (auto order = orders_.find(from.internal_object()); order != orders_.end()) {
    out.append_attribute("executionOrderId") = order->second;
  }
  place(out, from);
  if (kind == "Block") {
    block(out, from);
  } else if (kind == "Comment") {
    made(out, "content", from)
        .append_child(pugi::node_pcdata)
        .set_value(xml::text_of(xml::child(from, "Content")).c_str());
  } else {
    connect(out, from, to);
  }
  if (form->operand != nullptr) {
    const std::string text(xml::attribute(from, form->operand));
    if (form->element != nullptr) {
      made(out, form->element, from).append_child(pugi::node_pcdata).set_value(text.c_str());
    } else {
      out.append_attribute(form->attribute) = text.c_str();
    }
  }
  common(out, from);
}

}  // namespace plcopen
