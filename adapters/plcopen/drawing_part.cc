// What leads to one condition of a chart, as a drawing of its own.
#include <algorithm>
#include <map>

#include "adapters/plcopen/drawing.h"

namespace plcopen {

using network::Element;
using network::Kind;
using network::Link;

Drawing Drawing::part(const std::vector<Link>& links, const std::string& end, size_t& work) const {
  std::map<uint32_t, uint32_t> number;  // in the part, of what is used
  std::vector<uint32_t> open;
  bool ladder = false;  // else it is drawn as function blocks are
  const auto follow = [&](const std::vector<Link>& from) {
    ladder = ladder || from.size() > 1;
    for (Link link : from) {
      if (number.emplace(link.element, 0).second) open.push_back(link.element);
    }
  };
  follow(links);
  while (!open.empty()) {
    const Element& element = all_.elements[open.back()];
    open.pop_back();
    ladder = ladder || element.kind == Kind::kContact || element.kind == Kind::kLeftRail;
    for (const network::Input& input : element.inputs) follow(input.from);
  }
  work += number.size() + precedences_.size();
  Drawing out(ladder, report_);
  out.failed_ = failed_;
  Element last;
  last.kind = ladder ? Kind::kCoil : Kind::kSink;
  last.operand.text = end;
  last.inputs.resize(1);
  last.inputs[0].from = links;
  if (ladder) last.outputs.resize(1);
  last.position.known = true;
  for (auto& [i, made] : number) {
    const Element& element = all_.elements[i];
    made = out.push(element);
    if (const Node node = place_of(i)) out.nodes_.emplace(made, node);
    const network::Position& at = element.position;
    last.position.known = last.position.known && at.known;
    last.position.x = std::max(last.position.x, at.x + std::max(at.width, 0) + 40);
    last.position.y = std::max(last.position.y, at.y);
  }
  out.push(std::move(last));
  for (Element& element : out.all_.elements) {
    for (network::Input& input : element.inputs) {
      for (Link& link : input.from) link.element = number[link.element];
    }
  }
  for (const network::Precedence& each : precedences_) {
    const auto first = number.find(each.first);
    const auto second = number.find(each.second);
    if (first == number.end() || second == number.end()) continue;
    out.precedences_.push_back({first->second, second->second});
  }
  return out;
}

}  // namespace plcopen
