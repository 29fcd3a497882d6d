// Ladders: a comparison that no power reaches, as it stands in front of contacts and coils in the
// drawings of Beremiz and OpenPLC, is a contact of what it compares: [ n > 5 ].
#include <algorithm>

#include "adapters/plcopen/drawing.h"
#include "base/name_case.h"

namespace plcopen {

using network::Element;
using network::Input;
using network::Kind;
using network::Link;
using network::Modifier;

namespace {

struct Comparison {
  const char* box;
  const char* sign;
};
constexpr Comparison kComparisons[] = {{"GT", ">"},  {"GE", ">="}, {"EQ", "="},
                                       {"LE", "<="}, {"LT", "<"},  {"NE", "<>"}};

const Comparison* comparison_of(const Element& element) {
  if (element.kind != Kind::kBlock || !element.operand.empty()) return nullptr;
  for (const Comparison& each : kComparisons) {
    if (base::same_name(each.box, element.type.text)) return &each;
  }
  return nullptr;
}

// `all`: all elements. Is each input a variable or number by itself, without EN?
bool is_of_variables(const Element& box, const std::vector<Element>& all) {
  return std::ranges::all_of(box.inputs, [&](const Input& input) {
    return input.from.size() == 1 && input.modifier == Modifier::kNone &&
           !base::same_name(input.name, "EN") && all[input.from[0].element].kind == Kind::kSource;
  });
}

std::string text_of(const Element& box, const Comparison& how, const std::vector<Element>& all) {
  std::string listed;
  bool plain = box.inputs.size() == 2;
  for (const Input& input : box.inputs) {
    const std::string& operand = all[input.from[0].element].operand.text;
    plain = plain && operand.find_first_of(" (") == std::string::npos;
    listed += (listed.empty() ? "" : ", ") + operand;
  }
  if (!plain) return std::string(how.box) + '(' + listed + ')';
  const size_t comma = listed.find(", ");
  return listed.substr(0, comma) + ' ' + how.sign + ' ' + listed.substr(comma + 2);
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
    const Comparison* const how = comparison_of(all[i]);
    if (how == nullptr || readers[i] == 0 || !as_power[i] || !is_of_variables(all[i], all))
      continue;
    const bool negated =
        std::ranges::any_of(all[i].outputs, [](const network::Output& out) { return out.negated; });
    if (negated) continue;
    const std::string text = text_of(all[i], *how, all);
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
