#include "adapters/text_export/networks.h"

#include <utility>

#include "adapters/text_export/builder.h"
#include "adapters/xml/document.h"
#include "adapters/xml/operand.h"
#include "base/limits.h"

namespace text_export {

void Builder::fail(uint32_t at, const std::string& text, const std::string& fix) {
  if (std::exchange(failed_, true)) return;
  report_(Code::kXmlBody, at, number_, "the body of " + what_ + ": " + text, fix);
}

uint32_t Builder::push(Element element) {
  out_.elements.push_back(std::move(element));
  return static_cast<uint32_t>(out_.elements.size() - 1);
}

void Builder::connect(network::Input& input, Wire wire, uint32_t at) {
  links_ += wire.from.size();
  if (links_ > base::kMaxLinks) {
    fail(at, "its wires connect more than " + std::to_string(base::kMaxLinks) + " pairs");
    return;
  }
  input.from = std::move(wire.from);
  input.modifier = negation((input.modifier == Modifier::kNegated) != wire.negated);
}

// One expression and nothing else, since it stands between other text.
network::Text Builder::operand(std::string_view text, uint32_t at, const char* what) {
  if (text.empty() || text == "???") {
    fail(at, std::string(what) + " has no variable", "give its name where the export was made");
  } else if (!xml::is_operand(text)) {
    fail(at, std::string(what) + " is `" + std::string(text.substr(0, 60)) +
                 "`, which is no expression");
  }
  return {std::string(text), {}};
}

// --- values

Wire Builder::source(const Tree& tree) {
  if (tree.text.empty()) {
    if (tree.negated) fail(tree.at, "an operand without a variable is negated");
    return {};
  }
  Element element;
  element.kind = network::Kind::kSource;
  element.operand = operand(tree.text, tree.at, "an operand");
  element.outputs.resize(1);
  return {{{push(std::move(element)), 0}}, tree.negated};
}

Wire Builder::value(const Tree& tree) {
  if (failed_) return {};
  switch (tree.shape) {
    case Shape::kEmpty:
      return {};
    case Shape::kOperand:
      return source(tree);
    case Shape::kBox:
      return box(tree, {}, true);
    case Shape::kAssign:
      return assign(tree);
    default:
      break;
  }
  if (has_rail_) return {power(tree, rail())};
  fail(tree.at, "a contact stands in a network that is no ladder");
  return {};
}

// Behind a box, a variable is read once, however often its value is used and whatever is written
// meanwhile.
Wire Builder::read_once(Wire wire, uint32_t at) {
  if (wire.from.size() != 1) return wire;
  const Element& from = out_.elements[wire.from[0].element];
  if (from.kind != network::Kind::kSource || xml::is_literal(from.operand.text)) return wire;
  Element block;
  block.kind = network::Kind::kBlock;
  block.type.text = "MOVE";
  block.inputs.resize(1);
  block.outputs.resize(1);
  connect(block.inputs[0], {wire.from}, at);
  return {{{push(std::move(block)), 0}}, wire.negated};
}

void Builder::end(const End& target, Wire wire, bool power) {
  Element element;
  element.kind = power ? network::Kind::kCoil : network::Kind::kSink;
  element.operand = operand(target.name, target.at, "a coil or output");
  element.modifier =
      target.set ? (target.negated ? Modifier::kReset : Modifier::kSet) : negation(target.negated);
  element.inputs.resize(1);
  element.outputs.resize(power ? 1 : 0);
  connect(element.inputs[0], std::move(wire), target.at);
  push(std::move(element));
}

Wire Builder::assign(const Tree& tree) {
  if (tree.negated) fail(tree.at, "an assignment is negated, which is not known here");
  Wire wire = value(tree.parts[0]);
  if (tree.ends.size() > 1) wire = read_once(std::move(wire), tree.at);
  if (wire.from.empty() && !tree.ends.empty()) {
    fail(tree.at, "nothing is connected to a coil or output");
  }
  for (const End& target : tree.ends) {
    if (!failed_ && !target.name.empty()) end(target, wire, false);
  }
  return wire;
}

// --- boxes

void Builder::inputs(const Tree& tree, const Pins* pins, Element& block) {
  if (pins != nullptr && tree.parts.size() != pins->left.size()) {
    fail(tree.at, "the box `" + std::string(tree.owner) + "` has " +
                      std::to_string(tree.parts.size()) + " inputs, and " + std::string(tree.text) +
                      " declares " + std::to_string(pins->left.size()));
    return;
  }
  for (size_t i = 0; i < tree.parts.size() && !failed_; ++i) {
    network::Input input;
    if (pins != nullptr) input.name = pins->left[i];
    const Tree& part = tree.parts[i];
    if (tree.enabled && (part.shape == Shape::kBox || part.shape == Shape::kAssign)) {
      fail(part.at, "a box stands inside of a box with EN, which is not known here",
           "give its value a variable in a network of its own");
      return;
    }
    // At the rail it would have power, and open it keeps its value: nobody says which.
    if (has_rail_ && part.shape == Shape::kEmpty) {
      fail(part.at,
           "a pin of the box `" + std::string(tree.owner.empty() ? tree.text : tree.owner) +
               "` is _EMPTY in a ladder, which is not known here",
           "connect it where the export was made");
      return;
    }
    Wire wire = value(part);
    if (wire.from.empty()) {
      // What is not wired keeps its value; by position that would move those behind it.
      if (pins == nullptr) {
        fail(tree.parts[i].at, "a pin of the box `" + std::string(tree.text) + "` is not connected",
             "connect it where the export was made");
      }
      continue;
    }
    connect(input, std::move(wire), tree.at);
    block.inputs.push_back(std::move(input));
  }
}

// The first output leads on, if anything is behind the box; the ends are those of the others, or,
// where there are as many as outputs, of all.
void Builder::outputs(const Tree& tree, const Pins* pins, uint32_t block) {
  const size_t declared = pins == nullptr ? 1 : pins->right.size();
  if (tree.ends.size() != declared && tree.ends.size() + 1 != declared) {
    fail(tree.at, "the box `" + std::string(tree.owner) + "` has " +
                      std::to_string(tree.ends.size()) + " outputs beside the first, and " +
                      std::string(tree.text) + " declares " + std::to_string(declared) + " in all");
    return;
  }
  uint32_t output = static_cast<uint32_t>(declared - tree.ends.size());
  for (const End& target : tree.ends) {
    if (!target.name.empty() && !failed_) end(target, {{{block, output}}}, false);
    ++output;
  }
}

Wire Builder::box(const Tree& tree, const std::vector<Link>& power, bool leads_on) {
  Element block;
  block.kind = network::Kind::kBlock;
  block.type.text = std::string(tree.text);
  if (!xml::is_dotted_name(tree.text)) {
    fail(tree.at,
         "a box is of type `" + std::string(tree.text.substr(0, 60)) + "`, which is no name");
  }
  const Pins* pins = nullptr;
  if (tree.instance) {
    block.operand = operand(tree.owner, tree.at, "an instance");
    pins = pins_.find(tree.text);
    if (pins == nullptr) {
      fail(tree.at,
           "the pins of `" + std::string(tree.text) +
               "` have no names in an export, and the block " +
               "is declared in no file that is imported with it",
           "import the export of its library together with this one");
    } else if (!pins->unclear.empty()) {
      fail(tree.at, "in which order the pins of `" + std::string(tree.text) +
                        "` stand is not known: " + pins->unclear);
    } else if (leads_on && pins->right.empty()) {
      fail(tree.at, "the value of `" + std::string(tree.owner) + "` is used, and " +
                        std::string(tree.text) + " has no output");
    }
  }
  if (failed_) return {};
  if (tree.enabled) {
    if (power.empty()) fail(tree.at, "a box has EN where no power arrives");
    network::Input& enable = block.inputs.emplace_back();
    enable.name = "EN";
    connect(enable, {power}, tree.at);
  }
  inputs(tree, pins, block);
  if (failed_) return {};
  const bool eno = tree.enabled && !tree.instance;
  if (eno) block.outputs.push_back({"ENO", false});
  if (pins == nullptr) block.outputs.emplace_back();
  if (pins != nullptr) {
    for (const std::string& name : pins->right) block.outputs.push_back({name, false});
  }
  const uint32_t made = push(std::move(block));
  if (tree.instance) outputs(tree, pins, made);
  return {{{made, eno ? 1u : 0u}}, tree.negated};
}

network::Network Builder::run(const DrawnNetwork& drawn, bool ladder, uint32_t number) {
  number_ = number;
  out_.label.text = std::string(drawn.label);
  if (!out_.label.empty() && !xml::is_name(out_.label.text)) {
    fail(drawn.at, "the label `" + out_.label.text.substr(0, 60) + "` is no name");
  }
  out_.comments = drawn.comments;
  if (drawn.ladder && !ladder) fail(drawn.at, "a rung stands in a function block diagram");
  if (ladder) {
    Element left;
    left.kind = network::Kind::kLeftRail;
    left.outputs.resize(1);
    push(std::move(left));
    has_rail_ = true;
  }
  if (failed_) return {};
  if (drawn.ladder) {
    rung(drawn);
  } else {
    for (const Tree& tree : drawn.trees) {
      if (tree.shape == Shape::kBox) {
        box(tree, {}, false);
      } else {
        value(tree);
      }
    }
  }
  if (failed_ || out_.elements.size() == (ladder ? 1u : 0u)) out_.elements.clear();
  return std::move(out_);
}

bool is_body_word(std::string_view line) {
  line = xml::trimmed(line);
  line = line.substr(0, line.find_first_of(" \t("));
  return line.starts_with("_") && line.ends_with("_BODY") && xml::is_name(line);
}

bool is_drawn(std::string_view body) {
  const std::string_view text = xml::trimmed(body);
  return is_body_word(text.substr(0, text.find('\n')));
}

std::optional<network::Body> read_networks(std::string_view text, const std::string& what,
                                           const PinNames& pins, const Report& report,
                                           size_t& links) {
  const Drawn drawn = read_trees(text);
  if (!drawn.problem.empty()) {
    report(Code::kXmlBody, drawn.problem_at, drawn.problem_network,
           "the body of " + what + ": " + drawn.problem, {});
    return std::nullopt;
  }
  network::Body body;
  body.language = drawn.ladder ? network::Language::kLadder : network::Language::kFbd;
  bool failed = false;
  std::vector<std::string> comments;
  for (uint32_t i = 0; i < drawn.networks.size(); ++i) {
    Builder builder(pins, report, what, links);
    network::Network made = builder.run(drawn.networks[i], drawn.ladder, i + 1);
    failed = failed || builder.failed();
    comments.insert(comments.end(), made.comments.begin(), made.comments.end());
    if (made.elements.empty() && made.label.empty()) continue;  // as the editor makes them
    made.comments = std::move(comments);
    comments.clear();
    body.networks.push_back(std::move(made));
  }
  if (failed) return std::nullopt;
  if (!comments.empty()) body.networks.emplace_back().comments = std::move(comments);
  return body;
}

}  // namespace text_export
