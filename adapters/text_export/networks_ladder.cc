// What of a ladder carries power.
#include <algorithm>
#include <set>
#include <utility>

#include "adapters/text_export/builder.h"
#include "base/limits.h"

namespace text_export {

std::vector<Link> Builder::both(std::vector<Link> from, Wire wire, uint32_t at) {
  if (wire.from.empty()) fail(at, "nothing is connected to a branch");
  if (from == rail() && !wire.negated) return wire.from;
  Element block;
  block.kind = network::Kind::kBlock;
  block.type.text = "AND";
  block.inputs.resize(2);
  block.outputs.resize(1);
  connect(block.inputs[0], {std::move(from)}, at);
  connect(block.inputs[1], std::move(wire), at);
  return {{push(std::move(block)), 0}};
}

std::vector<Link> Builder::branches(const Tree& tree, const std::vector<Link>& from) {
  std::vector<Link> out;
  std::set<std::pair<uint32_t, uint32_t>> seen;
  for (const Tree& way : tree.parts) {
    for (Link link : power(way, from)) {
      if (seen.emplace(link.element, link.output).second) out.push_back(link);
    }
  }
  links_ += out.size();
  if (links_ > base::kMaxLinks) {
    fail(tree.at, "its wires connect more than " + std::to_string(base::kMaxLinks) + " pairs");
  }
  return out;
}

std::vector<Link> Builder::power(const Tree& tree, std::vector<Link> from) {
  if (failed_) return {};
  const bool group = tree.shape == Shape::kAnd || tree.shape == Shape::kOr;
  if (group && (tree.negated || tree.parts.empty())) {
    fail(tree.at, tree.negated ? "a branch is negated, which is not known here"
                               : "a branch has no elements");
    return {};
  }
  switch (tree.shape) {
    case Shape::kEmpty:
      return from;
    case Shape::kOr:
      return branches(tree, from);
    case Shape::kAnd:
      for (const Tree& part : tree.parts) from = power(part, std::move(from));
      return from;
    case Shape::kContact: {
      Element out;
      out.kind = network::Kind::kContact;
      out.operand = operand(tree.text, tree.at, "a contact");
      out.modifier = negation(tree.negated);
      out.inputs.resize(1);
      out.outputs.resize(1);
      connect(out.inputs[0], {std::move(from)}, tree.at);
      return {{push(std::move(out)), 0}};
    }
    default:
      break;
  }
  Wire wire = value(tree);
  return both(std::move(from), std::move(wire), tree.at);
}

// Contacts, then what is done beside the coils while power arrives, then the coils.
void Builder::rung(const DrawnNetwork& drawn) {
  const Tree& rung = drawn.trees[0];
  if (rung.negated) fail(rung.at, "the power of a rung is negated, which is not known here");
  const bool ends = !rung.ends.empty() || !drawn.enabled.empty();
  if (!ends && rung.parts[0].shape == Shape::kBox) {
    box(rung.parts[0], {}, false);
    return;
  }
  const std::vector<Link> from = power(rung.parts[0], rail());
  for (const Tree& tree : drawn.enabled) {
    const Tree& what = tree.shape == Shape::kAssign ? tree.parts[0] : tree;
    if (what.shape != Shape::kBox || !what.enabled || tree.negated) {
      fail(tree.at, "what stands beside the coils is no box with EN");
    }
    if (failed_) return;
    const Wire wire = box(what, from, tree.shape == Shape::kAssign && !tree.ends.empty());
    if (tree.shape != Shape::kAssign) continue;
    for (const End& target : tree.ends) {
      if (!failed_ && !target.name.empty()) end(target, wire, false);
    }
  }
  for (const End& target : rung.ends) {
    if (!failed_ && !target.name.empty()) end(target, {from}, true);
  }
  const bool acts = std::any_of(out_.elements.begin(), out_.elements.end(), [](const Element& one) {
    return one.kind == network::Kind::kCoil || one.kind == network::Kind::kSink ||
           !one.type.empty();
  });
  if (failed_ || acts) return;
  if (out_.elements.size() > 1) {
    report_(Code::kNoCoil, drawn.at, number_, "a network ends nowhere, and is left out", {});
  }
  out_.elements.clear();
}

}  // namespace text_export
