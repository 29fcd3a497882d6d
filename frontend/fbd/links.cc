#include "frontend/fbd/links.h"

#include <algorithm>
#include <unordered_set>

#include "frontend/network/expressions.h"
#include "frontend/network/pins.h"
#include "ir/types/types.h"

namespace frontend::fbd {
namespace {

using Code = base::DiagnosticCode;
using network::Cursor;
using network::Element;
using network::Input;
using network::Kind;
using network::Link;

bool is_plain_name(std::string_view text) {
  return text.find_first_of(".[](){}^ +-*/<>=,;:'\"") == std::string_view::npos;
}

std::string_view without_blanks(std::string_view text) {
  size_t first = text.find_first_not_of(" \t");
  return first == std::string_view::npos ? std::string_view() : text.substr(first);
}

// The source that stands for this operand, in front of its element.
uint32_t source_of(const std::vector<Element>& elements, uint32_t element,
                   const network::Text& operand) {
  while (element-- > 0) {
    bool same = elements[element].kind == Kind::kSource &&
                elements[element].span.begin == operand.span.begin;
    if (same) return element;
  }
  return 0;
}

void drop(std::vector<Element>& elements, const std::vector<bool>& dropped) {
  std::vector<uint32_t> numbers(elements.size());
  uint32_t kept = 0;
  for (uint32_t i = 0; i < elements.size(); ++i) {
    numbers[i] = kept;
    if (dropped[i]) continue;
    if (kept != i) elements[kept] = std::move(elements[i]);
    ++kept;
  }
  elements.resize(kept);
  for (Element& element : elements) {
    for (network::Input& input : element.inputs) {
      for (Link& link : input.from) link.element = numbers[link.element];
    }
  }
}

}  // namespace

void Links::add_box(const network::Text& name, uint32_t element, bool wire) {
  auto [found, fresh] = boxes_.emplace(ir::fold_name(name.text), Box{{}, wire, name});
  found->second.elements.push_back(element);
  names_.push_back(found->first);
  longest_ = std::max({longest_, found->first.size(), name.text.size()});
  if (fresh || (!wire && !found->second.wire)) return;
  diagnostics_.add(Code::kBoxTwice, name.span, "there is another box named `" + name.text + "`",
                   "choose another name");
}

void Links::add_use(uint32_t element, uint32_t input, const network::Text& operand) {
  if (!operand.empty()) uses_.push_back({element, input, operand});
}

void Links::forget(size_t uses, size_t elements) {
  uses_.resize(uses);
  while (!names_.empty()) {
    const auto box = boxes_.find(names_.back());
    if (box->second.elements.back() < elements) return;
    box->second.elements.pop_back();
    if (box->second.elements.empty()) boxes_.erase(box);
    names_.pop_back();
  }
}

void Links::finish(network::Network& network) {
  std::vector<Element>& elements = network.elements;
  std::vector<bool> dropped(elements.size());
  for (const Use& use : uses_) {
    uint32_t source = source_of(elements, use.element, use.operand);
    Found found = find(use, network);
    dropped[source] = found.link || found.reported;
    if (found.reported) continue;
    elements[source].inputs = std::move(found.wires);
    std::vector<Link>& from = elements[use.element].inputs[use.input].from;
    from.push_back(found.link.value_or(Link{source, 0}));
  }
  drop(elements, dropped);
  boxes_.clear();
  names_.clear();
  longest_ = 0;
  uses_.clear();
  outputs_.clear();
}

// An output that no other use has named yet is a new one.
uint32_t Links::output_number(network::Network& network, uint32_t box, std::string_view name) {
  std::vector<network::Output>& outputs = network.elements[box].outputs;
  auto [found, fresh] = outputs_.try_emplace(box);
  for (uint32_t i = 0; fresh && i < outputs.size(); ++i) {
    found->second.emplace(ir::fold_name(outputs[i].name), i);
  }
  const uint32_t next = static_cast<uint32_t>(outputs.size());
  auto [number, added] = found->second.emplace(ir::fold_name(name), next);
  if (added) outputs.push_back({std::string(name), false});
  return number->second;
}

Links::Found Links::find(const Use& use, network::Network& network) {
  base::Diagnostics unheard;
  const std::string_view whole = use.operand.text;
  Cursor operand(whole, {0}, unheard);
  const Box* box = nullptr;
  size_t behind = 0;
  for (; !operand.at_end(); operand.take()) {  // the longest beginning that names a box
    size_t end = operand.token().begin + operand.token().length;
    if (end > longest_) break;
    auto found = boxes_.find(ir::fold_name(whole.substr(0, end)));
    if (found == boxes_.end()) continue;
    box = &found->second;
    behind = end;
  }
  if (box == nullptr) return expression(use, network);
  std::string_view rest = without_blanks(whole.substr(behind));
  if (rest.empty()) return whole_box(use, *box);
  if (rest[0] != '.') return expression(use, network);
  rest = without_blanks(rest.substr(1));
  if (rest.empty() || !is_plain_name(rest)) return expression(use, network);
  const uint32_t element = box_for(use, *box);
  if (box->wire && element >= use.element) return feedback(use, *box);
  return {Link{element, output_number(network, element, rest)}, false, {}};
}

// Of an instance with several boxes the one that was there last, else the first one below.
uint32_t Links::box_for(const Use& use, const Box& box) {
  const auto below = std::lower_bound(box.elements.begin(), box.elements.end(), use.element);
  return below == box.elements.begin() ? *below : *(below - 1);
}

Links::Found Links::whole_box(const Use& use, const Box& box) {
  if (!box.wire) return {};  // the instance itself, as an argument
  const uint32_t element = box_for(use, box);
  if (element >= use.element) return feedback(use, box);
  return {Link{element, 0}, false, {}};
}

Links::Found Links::feedback(const Use& use, const Box& box) {
  diagnostics_.add(Code::kFeedback, use.operand.span,
                   "`" + box.name.text + "` is used above its box, and a wire keeps nothing",
                   "give it to a variable, and use that here");
  return {{}, true, {}};
}

// The wires in an expression. They are boxes of functions: what an instance is named by is a
// variable, and stays one.
Links::Found Links::expression(const Use& use, network::Network& network) {
  const std::string_view text = use.operand.text;
  Found out;
  std::unordered_set<std::string> seen;
  for (const network::FreeName& name : network::free_names(text)) {
    const auto found = boxes_.find(ir::fold_name(text.substr(name.begin, name.end - name.begin)));
    if (found == boxes_.end() || !found->second.wire) continue;
    const Box& box = found->second;
    const uint32_t element = box_for(use, box);
    if (element >= use.element) return feedback(use, box);
    const std::string_view member =
        text.substr(name.member_begin, name.member_end - name.member_begin);
    const bool enabled = ir::same_name(member, "ENO");
    const size_t end = enabled ? name.member_end : name.end;
    const std::string_view whole = text.substr(name.begin, end - name.begin);
    if (!member.empty() && !enabled) {
      return part_in_expression(use, text.substr(name.begin, name.member_end - name.begin));
    }
    if (!seen.insert(ir::fold_name(enabled ? found->first + ".ENO" : found->first)).second)
      continue;
    Input input;
    input.name = enabled ? box.name.text + ".ENO" : std::string(whole);
    input.from = {Link{element, enabled ? output_number(network, element, member) : 0}};
    out.wires.push_back(std::move(input));
  }
  return out;
}

// What a function gives beside its result has no type before its call is known.
Links::Found Links::part_in_expression(const Use& use, std::string_view part) {
  diagnostics_.add(Code::kBoxInExpression, use.operand.span,
                   "`" + std::string(part) +
                       "` stands in an expression, where a box of a function "
                       "has its result and ENO only",
                   "give it to a variable right below the box, and use that in the expression");
  return {{}, true, {}};
}

}  // namespace frontend::fbd
