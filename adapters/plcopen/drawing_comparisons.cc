// Ladders: a comparison that no power reaches, as it stands in front of contacts and coils in the
// drawings of Beremiz and OpenPLC, is a contact of what it compares: [ n > 5 ].
#include <algorithm>

#include "adapters/plcopen/drawing.h"
#include "adapters/xml/comparison.h"
#include "base/name_case.h"

namespace plcopen {

using network::Element;
using network::Input;
using network::Kind;
using network::Link;
using network::Modifier;

namespace {

bool is_comparison(const Element& element) {
  return element.kind == Kind::kBlock && element.operand.empty() &&
         !xml::comparison_sign(element.type.text).empty();
}

// `all`: all elements. Is each input a variable or number by itself, without EN?
bool is_of_variables(const Element& box, const std::vector<Element>& all) {
  return std::ranges::all_of(box.inputs, [&](const Input& input) {
    return input.from.size() == 1 && input.modifier == Modifier::kNone &&
           !base::same_name(input.name, "EN") && all[input.from[0].element].kind == Kind::kSource;
  });
}

std::string text_of(const Element& box, const std::vector<Element>& all) {
  std::vector<std::string> operands;
  for (const Input& input : box.inputs) {
    operands.push_back(all[input.from[0].element].operand.text);
  }
  return xml::comparison_text(box.type.text, operands);
}

}  // namespace

void Drawing::compare_as_contacts() {
  std::vector<Element>& all = all_.elements;
  std::vector<uint32_t> readers(all.size(), 0);
  std::vector<bool> as_power(all.size(), true);
  for (const Element& element : all) {
    for (const Input& input : element.inputs) {
      for (Link link : input.from) {
        ++readers[link.element];
        const bool usual = all[link.element].outputs.size() == 1 ||
                           !base::same_name(all[link.element].outputs[link.output].name, "ENO");
        if (element.kind == Kind::kSink || !usual) as_power[link.element] = false;
      }
    }
  }
  const uint32_t count = static_cast<uint32_t>(all.size());
  for (uint32_t i = 0; i < count; ++i) {
    const bool compares = is_comparison(all[i]) && is_of_variables(all[i], all);
    if (!compares || readers[i] == 0 || !as_power[i]) continue;
    const bool negated =
        std::ranges::any_of(all[i].outputs, [](const network::Output& out) { return out.negated; });
    if (negated) continue;
    const std::string text = text_of(all[i], all);
    for (const Input& input : all[i].inputs) {
      Element& source = all[input.from[0].element];
      if (--readers[input.from[0].element] != 0) continue;
      source.kind = Kind::kRightRail;  // nothing comes of it
      source.operand = {};
      source.outputs.clear();
      source.inputs.resize(1);
    }
    Element rail;
    rail.kind = Kind::kLeftRail;
    rail.position = all[i].position;
    rail.outputs.resize(1);
    const uint32_t begin = push(std::move(rail));
    nodes_[begin] = nodes_[i];
    Element& contact = all[i];
    contact.kind = Kind::kContact;
    contact.operand.text = text;
    contact.type = {};
    contact.inputs.assign(1, {});
    contact.inputs[0].from.push_back({begin, 0});
    contact.outputs.assign(1, {});
  }
  for (Element& element : all) {  // a contact has one output
    for (Input& input : element.inputs) {
      for (Link& link : input.from) {
        if (all[link.element].kind == Kind::kContact) link.output = 0;
      }
    }
  }
}

}  // namespace plcopen
