// Pins of blocks -> inputs and outputs of elements of the model, not linked yet.
#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <string>

#include "adapters/plcopen/drawing.h"
#include "base/name_case.h"
#include "stdlib/registry.h"

namespace plcopen {

using network::Element;
using network::Kind;
using network::Modifier;

namespace {

// CODESYS numbers the pins of operators with EN as the first: In2 and In3 after it.
bool is_operator(Node block) {
  for (Node data : xml::children(xml::child(block, "addData"), "data")) {
    if (is_vendor(data, "fbdcalltype") && xml::trimmed(xml::text_of(data)) == "operator") {
      return true;
    }
  }
  return false;
}

// The names of a standard function's inputs say no more than their positions when all of them are
// connected, in order.
void leave_out_usual_names(Node node, Element& block) {
  uint32_t position = 0;
  for (const network::Input& input : block.inputs) {
    if (base::same_name(input.name, "EN")) continue;
    const std::string usual = stdlib::parameter_at(block.type.text, position++);
    if (usual.empty() || !base::same_name(input.name, usual)) return;
  }
  for (Node pin : xml::children(xml::child(node, "inputVariables"), "variable")) {
    if (xml::children(xml::child(pin, "connectionPointIn")).empty()) return;
  }
  for (network::Input& input : block.inputs) {
    if (!base::same_name(input.name, "EN")) input.name.clear();
  }
}

}  // namespace

void Drawing::add_pins(Node node, uint32_t block, Raw& raw) {
  const bool by_position = is_operator(node);
  const std::string_view type = xml::attribute(node, "typeName");
  std::map<std::string, Node> in_outs;  // with Beremiz one is an input and an output of that name
  for (const char* list : {"inputVariables", "inOutVariables"}) {
    for (Node pin : xml::children(xml::child(node, list), "variable")) {
      network::Input input;
      input.name = xml::attribute(pin, "formalParameter");
      if (by_position && !base::same_name(input.name, "EN")) input.name.clear();
      input.modifier = modifier_of(pin, false);
      all_.elements[block].inputs.push_back(std::move(input));
      const uint32_t number = static_cast<uint32_t>(all_.elements[block].inputs.size() - 1);
      wait_for(block, number, pin, false);
      const std::string_view name = xml::attribute(pin, "formalParameter");
      if (list[2] != 'O' && report_.is_in_out(type, name)) in_outs[base::fold_name(name)] = pin;
      if (list[2] == 'O') {
        raw.passed.push_back({std::string(xml::attribute(pin, "formalParameter")),
                              xml::child(pin, "connectionPointIn"), kNone});
      }
    }
  }
  if (all_.elements[block].operand.empty()) leave_out_usual_names(node, all_.elements[block]);
  for (Node pin : xml::children(xml::child(node, "outputVariables"), "variable")) {
    const std::string name(xml::attribute(pin, "formalParameter"));
    if (const auto in = in_outs.find(base::fold_name(name)); in != in_outs.end()) {
      raw.passed.push_back({name, xml::child(in->second, "connectionPointIn"), kNone});
      continue;
    }
    all_.elements[block].outputs.push_back({name, negated(pin)});
    add_storage(pin, block);
    Node written = xml::find(pin, {"connectionPointOut", "expression"});
    if (!written) continue;  // a variable that stands at the pin
    Element sink;
    sink.kind = Kind::kSink;
    sink.position = all_.elements[block].position;
    sink.operand.text = expression(written);
    sink.inputs.resize(1);
    sink.inputs[0].from.push_back(
        {block, static_cast<uint32_t>(all_.elements[block].outputs.size() - 1)});
    const bool open = sink.operand.empty() || sink.operand.text == "???";  // of an editor
    if (!open) push(std::move(sink));
  }
}

namespace {

// Functions of the document that have no result, by folded name.
std::set<std::string> functions_without_result(Node document) {
  std::set<std::string> out;
  for (Node pou : xml::children(xml::find(document, {"project", "types", "pous"}), "pou")) {
    const bool function = xml::attribute(pou, "pouType") == "function";
    if (!function || xml::find(pou, {"interface", "returnType"})) continue;
    out.insert(base::fold_name(xml::attribute(pou, "name")));
  }
  return out;
}

}  // namespace

// The first output of a function's box is its result. Where the function has none, the box gets one
// that nothing is connected to.
void Drawing::add_results() {
  std::optional<std::set<std::string>> without;
  std::vector<bool> added(all_.elements.size());
  for (size_t i = 0; i < all_.elements.size(); ++i) {
    Element& block = all_.elements[i];
    if (block.kind != Kind::kBlock || !block.operand.empty() || block.outputs.empty()) continue;
    if (!stdlib::parameter_at(block.type.text, 0).empty()) continue;
    const auto node = nodes_.find(static_cast<uint32_t>(i));
    if (node == nodes_.end()) continue;
    if (!without) without = functions_without_result(node->second.root());
    const bool named = std::ranges::none_of(block.outputs, [](const network::Output& output) {
      return output.name.empty() || base::same_name(output.name, "OUT");
    });
    added[i] = named && without->contains(base::fold_name(block.type.text));
    if (added[i]) block.outputs.insert(block.outputs.begin(), network::Output{});
  }
  for (Element& element : all_.elements) {
    for (network::Input& input : element.inputs) {
      for (network::Link& link : input.from) link.output += added[link.element] ? 1 : 0;
    }
  }
}

// A pin that sets or resets does so with what stands behind it; see store().
void Drawing::add_storage(Node pin, uint32_t block) {
  if (edge_of(pin) != Modifier::kNone) {
    fail(Code::kXmlBody, pin, "an output sees edges", "use a block R_TRIG or F_TRIG");
  }
  const Modifier modifier = storage_of(pin);
  const uint32_t output = static_cast<uint32_t>(all_.elements[block].outputs.size() - 1);
  if (modifier != Modifier::kNone) stored_.emplace(std::pair(block, output), Stored{modifier, pin});
}

}  // namespace plcopen
