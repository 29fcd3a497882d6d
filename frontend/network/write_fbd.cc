#include <algorithm>
#include <limits>
#include <map>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include "frontend/lex/characters.h"
#include "frontend/network/element_text.h"
#include "frontend/network/expressions.h"
#include "frontend/network/head.h"
#include "frontend/network/write.h"
#include "ir/types/types.h"

namespace frontend::network {

namespace {

struct Value {
  Modifier modifier = Modifier::kNone;
  std::string text;
  bool steady = true;  // a wire or a constant: what is written later does not change it
};

constexpr uint32_t kNoElement = std::numeric_limits<uint32_t>::max();

bool writes(Kind kind) {
  return kind == Kind::kCoil || kind == Kind::kSink || kind == Kind::kBlock;
}

class Writer {
 public:
  Writer(const Body& body, uint32_t indent, std::string_view taken) : body_(body), indent_(indent) {
    add_names(taken);
    claimed_ = names_;
    collect_names();
  }

  std::string run() {
    std::string all;
    for (const Network& network : body_.networks) {
      network_ = &network;
      find_uses();
      find_kept();
      head(network);
      for (const std::string& comment : network.comments) row(comment_rows(comment, indent_));
      if (!network.label.empty()) row(network.label.text + ':');
      for (uint32_t i = 0; i < network.elements.size(); ++i) element(i);
      if (!all.empty() && !out_.empty()) all += '\n';
      all += std::exchange(out_, {});
    }
    return all;
  }

 private:
  void head(const Network& network);
  void collect_names();
  void add_names(std::string_view text);
  void find_uses();
  void use(Link link, uint32_t user);
  void find_kept();
  void keep(uint32_t i);
  void element(uint32_t i);
  void contact(uint32_t i);
  void coil(uint32_t i);
  void block(uint32_t i);
  void conditional(uint32_t i, std::string_view words);
  void assign(const Element& to, Value value);

  std::string expression(const Element& source);
  Value value(const Input& input);
  Value value(Link link);
  Value with(Value value, Modifier modifier);
  Value joined(std::vector<Value> terms);
  Value wire(const char* type, const std::vector<Value>& pins);
  std::string new_name(std::string_view type);
  void row(const std::string& text) { out_ += std::string(indent_, ' ') + text + '\n'; }

  const Body& body_;
  uint32_t indent_;
  const Network* network_ = nullptr;
  bool below_head_ = false;  // the network above has a row {network ...}
  std::string out_;
  std::unordered_set<std::string> names_;    // everything that could be a name, folded
  std::unordered_set<std::string> claimed_;  // taken, or wires of the body that kept their names
  std::unordered_map<std::string, uint32_t> numbers_;  // of the last name, by what it begins with
  std::vector<uint32_t> written_;  // by element: those before it that write something
  std::vector<uint32_t> users_;    // how many inputs use it
  std::vector<uint32_t> last_user_;
  // What is known of power after an element; of a contact that is used at once, its operands.
  std::vector<std::vector<Value>> terms_;
  std::vector<std::string> wires_;                                      // of boxes of functions
  std::map<std::pair<uint32_t, uint32_t>, std::string> kept_;           // wires of outputs, by link
  std::map<std::vector<std::pair<uint32_t, uint32_t>>, Value> joints_;  // wires of ORs, by links
};

// What has no title stands in the network above unless something begins another one.
void Writer::head(const Network& network) {
  std::string text = head_text(network.title, network.disabled);
  const bool begins = network.headed || (below_head_ && network.label.empty());
  if (text.empty() && begins) text = "{network}";
  if (!text.empty()) row(text);
  below_head_ = !text.empty();
}

void Writer::collect_names() {
  for (const Network& network : body_.networks) {
    add_names(network.label.text);
    for (const Element& element : network.elements) {
      add_names(element.operand.text);
      add_names(element.type.text);
      add_names(element.wire.text);
    }
  }
}

void Writer::add_names(std::string_view text) {
  for (size_t i = 0; i < text.size();) {
    size_t end = i;
    while (end < text.size() && is_name_part(text[end])) ++end;
    if (end > i) names_.insert(ir::fold_name(text.substr(i, end - i)));
    i = end + 1;
  }
}

std::string Writer::new_name(std::string_view type) {
  std::string stem;
  for (char c : type.substr(type.rfind('.') + 1)) {
    stem += static_cast<char>(c >= 'A' && c <= 'Z' ? c + 32 : c);
  }
  uint32_t& number = numbers_[stem];
  for (;;) {
    std::string name = stem + std::to_string(++number);
    if (names_.insert(ir::fold_name(name)).second) return name;
  }
}

void Writer::find_uses() {
  size_t count = network_->elements.size();
  written_.assign(count, 0);
  users_.assign(count, 0);
  last_user_.assign(count, 0);
  terms_.assign(count, {});
  wires_.assign(count, {});
  joints_.clear();
  kept_.clear();
  uint32_t written = 0;
  for (uint32_t i = 0; i < count; ++i) {
    const Element& element = network_->elements[i];
    written_[i] = written;
    if (writes(element.kind)) ++written;
    if (element.kind == Kind::kRightRail) continue;
    for (const Input& input : element.inputs) {
      for (Link link : input.from) use(link, i);
    }
  }
}

void Writer::use(Link link, uint32_t user) {
  ++users_[link.element];
  last_user_[link.element] = user;
}

// An output that is named is that of the nearest box above. Of an instance with several boxes, what
// is used below the next one has a wire.
void Writer::find_kept() {
  const std::vector<Element>& elements = network_->elements;
  std::vector<uint32_t> until(elements.size());    // the last one that its value gets to
  std::unordered_map<std::string, uint32_t> next;  // boxes, by folded instance
  std::vector<uint32_t> again(elements.size(), kNoElement);
  for (uint32_t i = static_cast<uint32_t>(elements.size()); i-- > 0;) {
    const Element& element = elements[i];
    const bool leads_on = element.kind == Kind::kCoil || element.kind == Kind::kContact;
    for (const Input& input : element.inputs) {
      for (Link link : input.from) {
        if (link.element >= i) continue;
        const uint32_t end = leads_on ? std::max(i, until[i]) : i;
        until[link.element] = std::max(until[link.element], end);
      }
    }
    if (element.kind != Kind::kBlock || element.operand.empty()) continue;
    auto [below, first] = next.try_emplace(ir::fold_name(element.operand.text), i);
    if (!first) again[i] = std::exchange(below->second, i);
  }
  // By element: boxes up to it that may change any instance, by a method or a pointer.
  std::vector<uint32_t> reaching(elements.size() + 1);
  for (size_t i = 0; i < elements.size(); ++i) {
    const Element& box = elements[i];
    const bool reaches =
        box.kind == Kind::kBlock && (box.type.text.find('.') != std::string::npos ||
                                     box.operand.text.find('^') != std::string::npos);
    reaching[i + 1] = reaching[i] + (reaches ? 1 : 0);
  }
  for (const Element& element : elements) {
    for (const Input& input : element.inputs) {
      for (Link link : input.from) {
        const Element& box = elements[link.element];
        const uint32_t end = until[link.element];
        if (box.kind != Kind::kBlock || box.operand.empty() || end == 0) continue;
        const bool moves = box.operand.text.find_first_of("[^") != std::string::npos &&
                           written_[end] > written_[link.element] + 1;
        const bool reached = reaching[end] > reaching[link.element + 1];
        if (again[link.element] >= end && !moves && !reached) continue;
        kept_.try_emplace({link.element, link.output});
      }
    }
  }
}

void Writer::keep(uint32_t i) {
  const Element& element = network_->elements[i];
  for (auto at = kept_.lower_bound({i, 0}); at != kept_.end() && at->first.first == i; ++at) {
    at->second = new_name("MOVE");
    row("WIRE " + at->second + " := MOVE(" + element.operand.text + '.' +
        element.outputs[at->first.second].name + ");");
  }
}

void Writer::element(uint32_t i) {
  const Element& element = network_->elements[i];
  for (const std::string& comment : element.comments) row(comment_rows(comment, indent_));
  switch (element.kind) {
    case Kind::kLeftRail:
      terms_[i] = {{Modifier::kNone, "TRUE", true}};
      return;
    case Kind::kRightRail:
      return;
    case Kind::kSource:
      terms_[i] = {{Modifier::kNone, expression(element), false}};
      return;
    case Kind::kContact:
      return contact(i);
    case Kind::kCoil:
      return coil(i);
    case Kind::kSink: {
      if (element.inputs[0].from.empty()) return;  // the variable keeps its value
      Value from = value(element.inputs[0]);
      return assign(element, std::move(from));
    }
    case Kind::kBlock:
      return block(i);
    case Kind::kJump:
      return conditional(i, "JMP " + element.operand.text);
    case Kind::kReturn:
      return conditional(i, "RETURN");
  }
}

// A contact is one more pin of the AND that its user makes, or has a wire of its own.
void Writer::contact(uint32_t i) {
  const Element& element = network_->elements[i];
  std::vector<Value> terms;
  const Input& input = element.inputs[0];
  if (input.from.size() == 1 && input.modifier == Modifier::kNone) {
    terms = terms_[input.from[0].element];
  }
  if (terms.empty()) terms = {value(input)};
  if (terms.size() == 1 && terms[0].text == "TRUE" && terms[0].steady) terms.clear();
  terms.push_back({element.modifier, element.operand.text, false});
  bool edge = element.modifier > Modifier::kNegated;
  bool once = users_[i] <= 1 || (terms.size() == 1 && !edge);
  bool unchanged = users_[i] == 0 || written_[last_user_[i]] == written_[i];
  if (!once || !unchanged) {
    if (terms.size() == 1) terms.insert(terms.begin(), {Modifier::kNone, "TRUE", true});
    terms = {joined(std::move(terms))};
  }
  terms_[i] = std::move(terms);
}

void Writer::coil(uint32_t i) {
  const Element& element = network_->elements[i];
  Value power = value(element.inputs[0]);
  terms_[i] = {power};
  if (element.inputs[0].from.empty()) return;  // the variable keeps its value
  if (users_[i] > 0 && !power.steady) {
    power = wire("AND", {{Modifier::kNone, "TRUE", true}, power});
  }
  assign(element, power);
  terms_[i] = {power};
}

void Writer::assign(const Element& to, Value value) {
  bool set = to.modifier == Modifier::kSet || to.modifier == Modifier::kReset;
  if (!set) value = with(std::move(value), to.modifier);
  const char* sign = !set ? " := " : to.modifier == Modifier::kSet ? " S= " : " R= ";
  row(to.operand.text + sign + pin_value(value.modifier, value.text) + ';');
}

void Writer::conditional(uint32_t i, std::string_view words) {
  const Element& element = network_->elements[i];
  Value condition = value(element.inputs[0]);
  std::string text(words);
  bool always = condition.text == "TRUE" && condition.modifier == Modifier::kNone;
  if (!always) text += " IF " + pin_value(condition.modifier, condition.text);
  row(text + ';');
}

void Writer::block(uint32_t i) {
  const Element& element = network_->elements[i];
  std::string pins;
  for (const Input& input : element.inputs) {
    if (input.from.empty()) continue;
    Value from = value(input);
    if (!pins.empty()) pins += ", ";
    if (!input.name.empty()) pins += input.name + " := ";
    pins += pin_value(from.modifier, from.text);
  }
  std::string call = element.type.text + '(' + pins + ");";
  if (!element.operand.empty()) {
    row(element.operand.text + " : " + call);
    return keep(i);
  }
  // Networks without a label between them are one in text.
  bool free = !element.wire.empty() && claimed_.insert(ir::fold_name(element.wire.text)).second;
  wires_[i] = free ? element.wire.text : new_name(element.type.text);
  row("WIRE " + wires_[i] + " := " + call);
}

// Wires may have got other names.
std::string Writer::expression(const Element& source) {
  return operand_with(source, [&](const Input& wire) {
    const Value from = value(wire);
    return from.modifier == Modifier::kNone ? from.text : "(NOT " + from.text + ')';
  });
}

Value Writer::value(const Input& input) {
  if (input.from.empty()) return with({Modifier::kNone, "FALSE", true}, input.modifier);
  if (input.from.size() == 1) return with(value(input.from[0]), input.modifier);
  std::vector<std::pair<uint32_t, uint32_t>> key;
  for (Link link : input.from) key.emplace_back(link.element, link.output);
  std::sort(key.begin(), key.end());
  auto [joint, is_new] = joints_.try_emplace(std::move(key));
  if (is_new) {
    std::vector<Value> pins;
    for (Link link : input.from) pins.push_back(value(link));
    joint->second = wire("OR", pins);
  }
  return with(joint->second, input.modifier);
}

Value Writer::value(Link link) {
  const Element& from = network_->elements[link.element];
  if (from.kind != Kind::kBlock) return joined(terms_[link.element]);
  const Output& output = from.outputs[link.output];
  Value value;
  const auto kept = kept_.find({link.element, link.output});
  if (kept != kept_.end() && !kept->second.empty()) {
    value.text = kept->second;
  } else {
    value.text = from.operand.empty() ? wires_[link.element] : from.operand.text;
    if (!is_result(from, link.output)) value.text += '.' + output.name;
  }
  if (output.negated) value.modifier = Modifier::kNegated;
  return value;
}

Value Writer::with(Value value, Modifier modifier) {
  if (modifier == Modifier::kNone) return value;
  // An edge of power at the rail is one of a wire: constants have none.
  const bool rail = value.steady && (value.text == "TRUE" || value.text == "FALSE");
  if (value.modifier == Modifier::kNone && (modifier == Modifier::kNegated || !rail)) {
    value.modifier = modifier;
    return value;
  }
  if (value.modifier == Modifier::kNegated && modifier == Modifier::kNegated) {
    value.modifier = Modifier::kNone;
    return value;
  }
  value = wire("AND", {{Modifier::kNone, "TRUE", true}, value});
  value.modifier = modifier;
  return value;
}

Value Writer::joined(std::vector<Value> terms) {
  if (terms.empty()) return {Modifier::kNone, "FALSE", true};
  return terms.size() == 1 ? std::move(terms[0]) : wire("AND", terms);
}

Value Writer::wire(const char* type, const std::vector<Value>& pins) {
  std::string name = new_name(type);
  std::string text;
  for (const Value& pin : pins) {
    text += (text.empty() ? "" : ", ") + pin_value(pin.modifier, pin.text);
  }
  row("WIRE " + name + " := " + type + '(' + text + ");");
  return {Modifier::kNone, name, true};
}

}  // namespace

std::string write_fbd(const Body& body, uint32_t indent, std::string_view taken) {
  return Writer(body, indent, taken).run();
}

}  // namespace frontend::network
