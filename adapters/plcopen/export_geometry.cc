// What editors need to draw a body, in everything that is written: the size of each element, where
// its pins are, and the way of each wire from the pin that reads to the pin that gives. TC6 leaves
// all of it open; Beremiz and OpenPLC Editor open no wire without both ends. What an element says
// of it stays.
#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <string_view>

#include "adapters/plcopen/geometry.h"
#include "adapters/plcopen/reader.h"

namespace plcopen {
namespace {

struct Point {
  int x = 0;
  int y = 0;
};

int whole(pugi::xml_attribute number) {
  const double value = number.as_double();
  return std::abs(value) < 1e8 ? static_cast<int>(std::lround(value)) : 0;
}

Point point_of(Node node) { return {whole(node.attribute("x")), whole(node.attribute("y"))}; }

void set_point(Node node, Point point) {
  node.append_attribute("x") = point.x;
  node.append_attribute("y") = point.y;
}

int characters(std::string_view text) {
  return static_cast<int>(std::min<size_t>(text.size(), 400));
}

// The pins of a block on one side, from the top: those of in-outs are on both.
std::vector<Node> pins(Node block, const char* side) {
  std::vector<Node> out;
  for (const char* list : {side, "inOutVariables"}) {
    for (Node pin : block.child(list).children("variable")) out.push_back(pin);
  }
  return out;
}

Extent block_extent(Node block) {
  int longest[2] = {0, 0};
  size_t rows = 1;
  int side = 0;
  for (const char* list : {"inputVariables", "outputVariables"}) {
    const std::vector<Node> found = pins(block, list);
    rows = std::max(rows, found.size());
    for (Node pin : found) {
      const int length = characters(pin.attribute("formalParameter").value());
      longest[side] = std::max(longest[side], length);
    }
    ++side;
  }
  return extent_of_box(longest[0] + longest[1], characters(block.attribute("typeName").value()),
                       rows);
}

Extent usual_extent(Node element) {
  const std::string_view name = element.name();
  if (name == "block") return block_extent(element);
  if (name == "contact" || name == "coil") return kContactExtent;
  if (name == "leftPowerRail" || name == "rightPowerRail") return kRailExtent;
  if (name == "step" || name == "macroStep") return {80, 30};
  if (name == "transition") return {20, 2};
  if (name == "jumpStep") return {12, 13};
  if (name == "actionBlock") return {120, 30};
  if (name.ends_with("vergence")) return {100, name.starts_with("simultaneous") ? 3 : 1};
  const Node text = element.child("expression");
  const std::string_view label = text ? text.child_value() : element.attribute("label").value();
  const std::string_view named = element.attribute("name").value();
  return extent_of_text(characters(label.empty() ? named : label));
}

// Has it pins of its own, or none that gives?
bool ends(std::string_view name) {
  static constexpr std::string_view kNames[] = {
      "block",    "jump",        "return",  "outVariable", "connector", "rightPowerRail",
      "jumpStep", "actionBlock", "comment", "label",       "error",     "vendorElement"};
  return std::ranges::find(kNames, name) != std::end(kNames);
}

class Body {
 public:
  explicit Body(Node body) : chart_(std::string_view(body.name()) == "SFC"), body_(body) {}

  void run() {
    for (Node element : body_.children()) {
      if (!element.child("position")) continue;
      by_id_.emplace(element.attribute("localId").value(), element);
    }
    give_outputs();
    for (Node element : body_.children()) {
      if (!element.child("position")) continue;
      give_extent(element);
      give_pins(element);
    }
    for (Node element : body_.children()) {
      if (element.child("position")) give_wires(element, element);
    }
  }

 private:
  // TC6 leaves pins open that give; a divergence has one for each way.
  void give_outputs() {
    std::map<std::string, int> read;
    for (Node element : body_.children()) {
      const bool action = std::string_view(element.name()) == "actionBlock";
      for (Node pin : element.children("connectionPointIn")) {
        for (Node wire : pin.children("connection")) {
          const std::string from = wire.attribute("refLocalId").value();
          if (action) {
            const auto step = by_id_.find(from);
            if (step != by_id_.end()) give_output(step->second, "connectionPointOutAction");
          } else {
            ++read[from];
          }
        }
      }
    }
    for (auto& [id, element] : by_id_) {
      if (ends(element.name())) continue;
      const bool ways = std::string_view(element.name()).ends_with("Divergence");
      const int missing = element.child("connectionPointOut") ? 0 : read[id];
      for (int i = 0; i < (ways ? missing : std::min(missing, 1)); ++i) {
        give_output(element, "connectionPointOut");
      }
    }
  }

  // Behind the pins that read, and those that give something else.
  static void give_output(Node element, const char* name) {
    const bool action = std::string_view(name) == "connectionPointOutAction";
    if (action && element.child(name)) return;
    Node last = element.child("position");
    for (Node pin : element.children("connectionPointIn")) last = pin;
    for (Node pin : element.children("connectionPointOut")) last = pin;
    const bool named = element.name() == std::string_view("step") ||
                       std::string_view(element.name()).ends_with("Divergence");
    Node pin = element.insert_child_after(name, last);
    if (named) pin.append_attribute("formalParameter") = "";
  }

  void give_extent(Node element) {
    const std::string_view name = element.name();
    if (name == "vendorElement") return;
    const Extent usual = usual_extent(element);
    if (!element.attribute("height")) element.append_attribute("height") = usual.height;
    if (!element.attribute("width")) element.append_attribute("width") = usual.width;
  }

  static Extent extent_of(Node element) {
    return {whole(element.attribute("width")), whole(element.attribute("height"))};
  }

  static void give_pin(Node pin, Point at) {
    if (!pin || pin.child("relPosition")) return;
    set_point(pin.prepend_child("relPosition"), at);
  }

  void give_pins(Node element) {
    const Extent extent = extent_of(element);
    if (std::string_view(element.name()) == "block") {
      int row = 0;
      for (Node pin : pins(element, "inputVariables")) {
        give_pin(pin.child("connectionPointIn"), {0, kFirstPin + kPinDistance * row++});
      }
      row = 0;
      for (Node pin : pins(element, "outputVariables")) {
        const Point at = {extent.width, kFirstPin + kPinDistance * row++};
        give_pin(pin.child("connectionPointOut"), at);
      }
      return;
    }
    if (chart_ && std::string_view(element.name()) != "actionBlock") {
      give_row(element, "connectionPointIn", extent.width, 0);
      give_row(element, "connectionPointOut", extent.width, extent.height);
      give_pin(element.child("connectionPointOutAction"), {extent.width, extent.height / 2});
      give_pin(element.child("condition").child("connectionPointIn"), {0, extent.height / 2});
      return;
    }
    int row = 0;
    for (Node pin : element.children("connectionPointIn")) {
      give_pin(pin, {0, pin_of(extent) + kPinDistance * row++});
    }
    row = 0;
    for (Node pin : element.children("connectionPointOut")) {
      give_pin(pin, {extent.width, pin_of(extent) + kPinDistance * row++});
    }
  }

  // Pins of a chart's element, side by side.
  static void give_row(Node element, const char* name, int width, int y) {
    const int count = static_cast<int>(
        std::distance(element.children(name).begin(), element.children(name).end()));
    int number = 0;
    for (Node pin : element.children(name)) {
      const int64_t all = int64_t{width} * number;  // a document may say any width
      const int x = count == 1 ? width / 2 : static_cast<int>(all / (count - 1));
      ++number;
      give_pin(pin, {x, y});
    }
  }

  static Point pin_point(Node element, Node pin) {
    const Point at = point_of(element.child("position"));
    const Point in = point_of(pin.child("relPosition"));
    return {at.x + in.x, at.y + in.y};
  }

  // The pin that gives: of that name, or the only one.
  static Node source_pin(Node element, std::string_view name) {
    if (std::string_view(element.name()) == "block") {
      Node first;
      for (Node pin : pins(element, "outputVariables")) {
        if (!first) first = pin.child("connectionPointOut");
        if (name == pin.attribute("formalParameter").value()) {
          return pin.child("connectionPointOut");
        }
      }
      return first;
    }
    for (Node pin : element.children()) {
      const bool gives = std::string_view(pin.name()).starts_with("connectionPointOut");
      if (gives && name == pin.attribute("formalParameter").value()) return pin;
    }
    return element.child("connectionPointOut");
  }

  // `below`: `element`, or something in it. The depth of what is written is small.
  void give_wires(Node element, Node below) {
    for (Node child : below.children()) {
      const std::string_view name = child.name();
      if (name == "addData") continue;
      if (name != "connectionPointIn") {
        give_wires(element, child);
        continue;
      }
      for (Node wire : child.children("connection")) {
        if (!wire.child("position")) give_way(element, child, wire);
      }
    }
  }

  void give_way(Node element, Node pin, Node wire) {
    const auto found = by_id_.find(wire.attribute("refLocalId").value());
    if (found == by_id_.end()) return;
    Node from = source_pin(found->second, wire.attribute("formalParameter").value());
    const bool action = std::string_view(element.name()) == "actionBlock";
    if (action) from = found->second.child("connectionPointOutAction");
    if (std::string_view(found->second.name()).ends_with("Divergence")) {
      Node& next = next_way_[found->first];
      next = next ? next.next_sibling("connectionPointOut") : from;
      if (next) from = next;
    }
    const Point end = pin_point(element, pin);
    const Point begin = from ? pin_point(found->second, from) : end;
    const bool upright = chart_ && !action && std::string_view(pin.parent().name()) != "condition";
    std::vector<Point> way = {end};
    if (upright ? end.x != begin.x : end.y != begin.y) {
      const Point middle = {(end.x + begin.x) / 2, (end.y + begin.y) / 2};
      way.push_back(upright ? Point{end.x, middle.y} : Point{middle.x, end.y});
      way.push_back(upright ? Point{begin.x, middle.y} : Point{middle.x, begin.y});
    }
    way.push_back(begin);
    Node last;
    for (Point each : way) {
      Node position =
          last ? wire.insert_child_after("position", last) : wire.prepend_child("position");
      set_point(position, each);
      last = position;
    }
  }

  bool chart_;
  Node body_;
  std::map<std::string, Node> by_id_;
  std::map<std::string, Node> next_way_;  // of divergences: the pin that was read last
};

}  // namespace

Extent extent_of_box(int pin_letters, int type_letters, size_t rows) {
  const int letters = std::max(pin_letters + 2, type_letters);
  return {std::max(60, kLetter * letters + 10), kFirstPin - 10 + kPinDistance * int(rows)};
}

Extent extent_of_text(int letters) { return {kLetter * letters + 20, kTextHeight}; }

int pin_of(Extent extent) {
  return extent.height <= kRailExtent.height ? extent.height / 2 : kRailExtent.height / 2;
}

void put_geometry(Node node) {
  for (Node child : node.children()) {
    const std::string_view name = child.name();
    // Of what vendors add, these have bodies as TC6 has them.
    if (name == "data" && !is_vendor(child, "method") && !is_vendor(child, "property")) continue;
    if (name == "LD" || name == "FBD" || name == "SFC") {
      Body(child).run();
    } else {
      put_geometry(child);
    }
  }
}

}  // namespace plcopen
