#include "frontend/network/element_text.h"

#include <algorithm>

#include "frontend/lex/characters.h"
#include "frontend/lex/lexer.h"
#include "ir/types/types.h"
#include "ir/types/utf.h"

namespace frontend::network {

Sinks::Sinks(const Network& network) : sinks_(network.elements.size()) {
  for (uint32_t i = 0; i < network.elements.size(); ++i) {
    const Element& element = network.elements[i];
    sinks_[i].resize(element.outputs.size());
  }
  for (uint32_t i = 0; i < network.elements.size(); ++i) {
    const Element& element = network.elements[i];
    if (element.kind != Kind::kSink || element.inputs.empty()) continue;
    for (Link link : element.inputs[0].from) sinks_[link.element][link.output].push_back(i);
  }
}

const std::vector<uint32_t>& Sinks::at(uint32_t element, uint32_t output) const {
  return sinks_[element][output];
}

std::string_view modifier_mark(Modifier modifier) {
  switch (modifier) {
    case Modifier::kNone:
      return " ";
    case Modifier::kNegated:
      return "/ ";
    case Modifier::kRising:
      return "P ";
    case Modifier::kFalling:
      return "N ";
    case Modifier::kSet:
      return "S ";
    case Modifier::kReset:
      return "R ";
  }
  return " ";
}

bool is_plain_name(std::string_view operand) {
  bool fresh = true;
  for (char c : operand) {
    if (c == '.' && !fresh) {
      fresh = true;
    } else if (fresh ? is_name_start(c) : is_name_part(c)) {
      fresh = false;
    } else {
      return false;
    }
  }
  return !fresh;
}

std::string pin_value(Modifier modifier, std::string_view operand) {
  std::string text(operand);
  if (modifier == Modifier::kNone) return text;
  if (modifier == Modifier::kNegated && is_plain_name(operand)) return "NOT " + text;
  return '[' + std::string(modifier_mark(modifier)) + text + ']';
}

bool is_result(const Element& block, uint32_t output) {
  if (!block.operand.empty()) return false;
  for (uint32_t i = 0; i < block.outputs.size(); ++i) {
    if (!ir::same_name(block.outputs[i].name, "ENO")) return i == output;
  }
  return false;
}

namespace {

// The text of one box: its parts, then their order.
class BoxText {
 public:
  BoxText(const Network& network, const Sinks& sinks, const Cell& cell)
      : network_(network),
        sinks_(sinks),
        cell_(cell),
        block_(network.elements[cell.element]),
        function_(block_.operand.empty()) {
    enabled_ = ir::same_name(block_.inputs[cell.input].name, "EN");
  }

  std::optional<std::string> run() {
    if (block_.inputs[cell_.input].modifier != Modifier::kNone || !inputs() || !outputs()) {
      return std::nullopt;
    }
    if (!function_) {
      std::string head = block_.operand.text + ": " + block_.type.text;
      std::string pins = list(inputs_, names_enable());
      return "[ " + head + (pins.empty() ? "" : "  " + pins) + " ]";
    }
    if (result_.empty()) return "[ " + block_.type.text + '(' + list(inputs_, true) + ") ]";
    return "[ " + result_ + " := " + value() + " ]";
  }

 private:
  bool inputs();
  bool outputs();
  std::string output_name(uint32_t pin) const;
  bool power(uint32_t pin);
  bool target(uint32_t pin, uint32_t number);
  std::string list(const std::vector<std::string>& inputs, bool with_enable) const;
  std::string value() const;
  bool names_enable() const;

  const Network& network_;
  const Sinks& sinks_;
  const Cell& cell_;
  const Element& block_;
  bool function_;
  bool enabled_ = false;
  std::vector<std::string> inputs_;  // without EN where power arrives
  struct Target {                    // a variable that is written
    uint32_t sink = 0;
    bool only_result = false;  // nothing else gets the result
    std::string text;
  };
  std::vector<Target> targets_;
  std::string power_;  // `name=>_`; empty: power leaves where it would by itself
  std::vector<std::string> outputs_;
  std::string result_;  // the variable in front of `:=`
};

bool BoxText::inputs() {
  bool gap = false;  // an input by position is not connected
  for (uint32_t pin = 0; pin < block_.inputs.size(); ++pin) {
    const Input& input = block_.inputs[pin];
    std::string name = input.name.empty() ? "" : input.name + ":=";
    if (pin == cell_.input) {
      if (!enabled_) inputs_.push_back(name + "_");
      continue;
    }
    if (input.from.empty()) {
      gap = gap || name.empty();
      continue;
    }
    if (gap && name.empty()) return false;
    const Element& source = network_.elements[input.from[0].element];
    inputs_.push_back(name + pin_value(input.modifier, source.operand.text));
  }
  return true;
}

// Variables are written in the order of their sinks, whatever the order of the outputs is.
bool BoxText::outputs() {
  for (uint32_t pin = 0; pin < block_.outputs.size(); ++pin) {
    if (pin == cell_.output && !power(pin)) return false;
    for (uint32_t s : sinks_.at(cell_.element, pin)) {
      if (!target(pin, s)) return false;
    }
  }
  std::ranges::stable_sort(targets_, {}, [](const Target& target) { return target.sink; });
  // The call writes the others, then the result goes to the variable in front of it.
  if (!targets_.empty() && targets_.back().only_result && power_.empty()) {
    result_ = network_.elements[targets_.back().sink].operand.text;
    targets_.pop_back();
  }
  for (Target& target : targets_) outputs_.push_back(std::move(target.text));
  if (!power_.empty()) outputs_.push_back(power_);
  return true;
}

std::string BoxText::output_name(uint32_t pin) const {
  return (is_result(block_, pin) ? "" : block_.outputs[pin].name) + "=>";
}

// The output that power leaves by.
bool BoxText::power(uint32_t pin) {
  const Output& output = block_.outputs[pin];
  if (output.negated) return false;
  const std::string usual = enabled_ ? "ENO" : "Q";
  const bool named = enabled_ || !function_;
  const bool is_usual = named ? ir::same_name(output.name, usual) : is_result(block_, pin);
  if (!is_usual) power_ = output_name(pin) + "_";
  return true;
}

bool BoxText::target(uint32_t pin, uint32_t number) {
  const Element& sink = network_.elements[number];
  bool negated = block_.outputs[pin].negated != (sink.modifier == Modifier::kNegated);
  const bool plain = sink.modifier == Modifier::kNone || sink.modifier == Modifier::kNegated;
  if (!plain || sink.inputs[0].from.size() != 1) return false;
  if (sink.inputs[0].modifier == Modifier::kNegated) negated = !negated;
  if (sink.inputs[0].modifier > Modifier::kNegated) return false;
  const Modifier modifier = negated ? Modifier::kNegated : Modifier::kNone;
  const bool only_result =
      is_result(block_, pin) && !negated && sinks_.at(cell_.element, pin).size() == 1;
  targets_.push_back(
      {number, only_result, output_name(pin) + pin_value(modifier, sink.operand.text)});
  return true;
}

std::string BoxText::list(const std::vector<std::string>& inputs, bool with_enable) const {
  std::string out = with_enable && enabled_ ? "EN:=_" : "";
  for (const auto* part : {&inputs, &outputs_}) {
    for (const std::string& pin : *part) out += (out.empty() ? "" : ", ") + pin;
  }
  return out;
}

// A block may be a timer, as only others know: power gets to its IN then, unless the box says EN.
bool BoxText::names_enable() const {
  return !block_.inputs[cell_.input].by_itself &&
         std::ranges::none_of(block_.inputs, [](const Input& input) {
           return input.name.empty() || ir::same_name(input.name, "IN");
         });
}

// After `v :=`: a call, or what a MOVE has at its input.
std::string BoxText::value() const {
  std::string call = block_.type.text + '(' + list(inputs_, false) + ')';
  if (!ir::same_name(block_.type.text, "MOVE") || !enabled_ || inputs_.size() != 1) return call;
  if (!outputs_.empty()) return call;
  for (const Input& input : block_.inputs) {
    if (input.from.empty() || &input == &block_.inputs[cell_.input]) continue;
    const std::string& operand = network_.elements[input.from[0].element].operand.text;
    bool by_itself = input.name.empty() && input.modifier == Modifier::kNone;
    // `v := F(a)` would be the function, not a MOVE of its result.
    if (!by_itself || operand.back() == ')') return call;
    return operand;
  }
  return call;
}

}  // namespace

std::optional<std::string> ladder_element(const Network& network, const Sinks& sinks,
                                          const Cell& cell) {
  const Element& element = network.elements[cell.element];
  if (element.kind == Kind::kBlock) return BoxText(network, sinks, cell).run();
  if (element.inputs[cell.input].modifier != Modifier::kNone) return std::nullopt;
  for (const Output& output : element.outputs) {
    if (output.negated) return std::nullopt;
  }
  std::string inside(modifier_mark(element.modifier));
  switch (element.kind) {
    case Kind::kContact:
      return '[' + inside + element.operand.text + " ]";
    case Kind::kCoil:
      return '(' + inside + element.operand.text + " )";
    case Kind::kJump:
      return "( JMP " + element.operand.text + " )";
    case Kind::kReturn:
      return "( RETURN )";
    default:
      return std::nullopt;
  }
}

namespace {

// Is `text` the inside of one comment between these marks, which nest?
bool fits_between(std::string_view text, std::string_view open, std::string_view close) {
  uint32_t depth = 0;
  for (size_t i = 0; i + 1 < text.size(); ++i) {
    std::string_view mark = text.substr(i, 2);
    if (mark == open) {
      ++depth;
      ++i;
    } else if (mark == close) {
      if (depth-- == 0) return false;
      ++i;
    }
  }
  return depth == 0;
}

// A line that the lexer would take for the end of the diagram.
bool has_end_line(std::string_view comment) {
  for (size_t at = comment.find('\n'); at != std::string_view::npos; at = comment.find('\n', at)) {
    while (at < comment.size() && is_space(comment[at])) ++at;
    if (ir::same_name(comment.substr(at, 4), "END_")) return true;
  }
  return false;
}

std::string with_lines(std::string_view text, std::string_view before) {
  std::string out;
  bool fresh = false;
  for (char c : text) {
    if (c == '\r') continue;
    if (fresh && c != '\n') out += before;
    fresh = c == '\n';
    out += c == '\t' ? ' ' : c;
  }
  return out;
}

}  // namespace

std::string comment_rows(std::string_view comment, uint32_t indent) {
  std::string margin(indent, ' ');
  if (fits_between(comment, "(*", "*)") && !has_end_line(comment)) {
    if (comment.empty()) return "(* *)";
    return "(* " + with_lines(comment, margin + "   ") + " *)";
  }
  if (comment.find('\n') == std::string_view::npos) return "// " + with_lines(comment, {});
  // Each line by itself, as it is when it is read again.
  std::string out;
  while (!comment.empty()) {
    const size_t end = std::min(comment.find('\n'), comment.size());
    const std::string_view line = comment.substr(0, end);
    comment.remove_prefix(std::min(end + 1, comment.size()));
    out += (out.empty() ? "" : "\n" + margin) + comment_rows(line, indent);
  }
  return out;
}

bool is_one_diagram(Language language, std::string_view rows) {
  std::string word = language == Language::kLadder ? "LADDER" : "FBD";
  std::string text = word + '\n' + std::string(rows) + "\nEND_" + word + '\n';
  base::Diagnostics unheard;
  return lex(text, base::SourcePos{0}, unheard).tokens.size() == 3;
}

bool is_utf8(std::string_view text) {
  while (!text.empty()) {
    uint32_t bytes = ir::read_utf8(text).bytes;
    if (bytes == 0) return false;
    text.remove_prefix(bytes);
  }
  return true;
}

uint32_t count_columns(std::string_view text, bool wide) {
  uint32_t columns = 0;
  for (char c : text) {
    bool continuation = wide && (static_cast<uint8_t>(c) & 0xC0) == 0x80;
    columns += continuation ? 0 : 1;
  }
  return columns;
}

}  // namespace frontend::network
