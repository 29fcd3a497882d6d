#include "frontend/ladder/element.h"

#include <algorithm>
#include <string_view>

#include "frontend/network/pins.h"
#include "ir/types/types.h"

namespace frontend::ladder {
namespace {

using Code = base::DiagnosticCode;
using network::Cursor;
using network::Element;
using network::Input;
using network::Kind;
using network::Link;
using network::Modifier;
using network::Pin;
using network::Text;

class ElementReader {
 public:
  ElementReader(std::string_view text, base::SourcePos begin, const Piece& piece,
                network::Network& network, base::Diagnostics& diagnostics,
                const DeclarationIndex* declarations)
      : piece_(piece),
        span_{{begin.offset + piece.byte}, {begin.offset + piece.byte + piece.bytes}},
        cursor_(text.substr(piece.byte + 1, piece.bytes - 2), {span_.begin.offset + 1},
                diagnostics),
        network_(network),
        declarations_(declarations) {}

  std::optional<Made> run() {
    size_t before = network_.elements.size();
    Made made = piece_.kind == SegmentKind::kCoil ? coil() : contact_or_box();
    if (cursor_.good() && !cursor_.at_end()) {
      bad("expected its end, found " + cursor_.found());
    }
    if (cursor_.good()) return made;
    network_.elements.resize(before);
    return std::nullopt;
  }

 private:
  void bad(std::string text) {
    bool coil = piece_.kind == SegmentKind::kCoil;
    base::SourceSpan at = cursor_.at_end() ? span_ : cursor_.token().span();
    cursor_.report(Code::kBadElement, at,
                   std::string(coil ? "this coil" : "this contact or box") +
                       " is not understood: " + std::move(text),
                   coil ? "write (x) (/x) (Sx) (Rx) (Px) (Nx) (JMP label) or (RETURN)"
                        : "write [x] [/x] [P x] [N x] [name: TYPE IN:=_] or [v := F(a)]");
  }

  uint32_t add(Element element) {
    if (!element.span.begin.valid()) element.span = span_;
    network_.elements.push_back(std::move(element));
    return static_cast<uint32_t>(network_.elements.size() - 1);
  }
  Made add_simple(Kind kind, Modifier modifier, Text operand) {
    Element element;
    element.kind = kind;
    element.modifier = modifier;
    element.operand = std::move(operand);
    element.inputs.resize(1);
    bool ends = kind == Kind::kJump || kind == Kind::kReturn;
    element.outputs.resize(ends ? 0 : 1);
    uint32_t number = add(std::move(element));
    return {number, 0, {number, 0}};
  }

  Made coil() {
    if (cursor_.at_jump()) {
      cursor_.take();
      return add_simple(Kind::kJump, Modifier::kNone, cursor_.label());
    }
    if (cursor_.kind() == TokenKind::kReturn) {
      cursor_.take();
      return add_simple(Kind::kReturn, Modifier::kNone, {});
    }
    Modifier modifier = network::read_modifier(cursor_, true);
    Text operand = cursor_.operand(TokenKind::kRightParen);
    if (operand.empty()) bad("it names no variable");
    return add_simple(Kind::kCoil, modifier, std::move(operand));
  }

  Made contact_or_box() {
    if (size_t colon = find(TokenKind::kColon); colon != 0) return block(colon);
    if (size_t assign = find(TokenKind::kAssign); assign != 0) return assignment();
    if (is_power_call()) return function({});
    Modifier modifier = network::read_modifier(cursor_, false);
    Text operand = cursor_.operand(TokenKind::kRightBracket);
    if (operand.empty()) bad("it names no operand");
    return add_simple(Kind::kContact, modifier, std::move(operand));
  }

  // The place of the first such token outside of brackets; 0: none.
  size_t find(TokenKind wanted) {
    size_t begin = cursor_.place();
    uint32_t depth = 0;
    size_t found = 0;
    for (; !cursor_.at_end() && found == 0; cursor_.take()) {
      TokenKind k = cursor_.kind();
      if (k == TokenKind::kLeftParen || k == TokenKind::kLeftBracket) ++depth;
      if (k == TokenKind::kRightParen || k == TokenKind::kRightBracket) depth -= depth > 0 ? 1 : 0;
      if (depth == 0 && k == wanted) found = cursor_.place();
    }
    cursor_.go_to(begin);
    return found;
  }

  // `F(...)` and nothing after it; the cursor stays.
  bool is_call() {
    size_t begin = cursor_.place();
    bool call = !cursor_.name().empty() && cursor_.kind() == TokenKind::kLeftParen;
    uint32_t depth = 0;
    while (call && !cursor_.at_end()) {
      if (cursor_.kind() == TokenKind::kLeftParen) ++depth;
      if (cursor_.kind() == TokenKind::kRightParen && --depth == 0) break;
      cursor_.take();
    }
    call = call && cursor_.kind() == TokenKind::kRightParen && cursor_.kind(1) == TokenKind::kEnd;
    cursor_.go_to(begin);
    return call;
  }

  bool is_power_call() {
    if (!is_call()) return false;
    size_t begin = cursor_.place();
    cursor_.name();
    cursor_.take();
    bool power = false;
    for (const Pin& pin : network::read_pins(cursor_, TokenKind::kRightParen)) {
      power = power || pin.power;
    }
    cursor_.go_to(begin);
    cursor_.forget();
    return power;
  }

  // inst: TYPE pins
  Made block(size_t colon) {
    size_t begin = cursor_.place();
    while (cursor_.place() < colon) cursor_.take();
    Element element;
    element.kind = Kind::kBlock;
    element.operand = cursor_.text_from(begin);
    cursor_.take();
    element.type = cursor_.name();
    if (element.operand.empty() || element.type.empty()) {
      bad("a box is an instance, `:` and its type");
      return {};
    }
    bool parenthesised = cursor_.accept(TokenKind::kLeftParen);
    TokenKind closing = parenthesised ? TokenKind::kRightParen : TokenKind::kRightBracket;
    std::vector<Pin> pins = network::read_pins(cursor_, closing);
    if (parenthesised) close_parenthesis();
    return finish(std::move(element), pins, "Q");
  }

  // F(pins), whose result goes to `target` unless that is empty.
  Made function(Text target) {
    Element element;
    element.kind = Kind::kBlock;
    element.type = cursor_.name();
    cursor_.take();
    std::vector<Pin> pins = network::read_pins(cursor_, TokenKind::kRightParen);
    close_parenthesis();
    element.outputs.emplace_back();
    if (!target.empty()) {
      Pin& result = pins.emplace_back();
      result.output = true;
      result.span = target.span;
      result.value.operand = std::move(target);
    }
    return finish(std::move(element), pins, "");
  }

  void close_parenthesis() {
    if (cursor_.good() && !cursor_.accept(TokenKind::kRightParen)) bad("`)` is missing");
  }

  // v := F(a, b)  or  v := a + b, which is a MOVE
  Made assignment() {
    Text target = cursor_.operand(TokenKind::kRightBracket);
    cursor_.take();
    if (target.empty()) bad("there is no variable in front of `:=`");
    if (is_call()) return function(std::move(target));
    Element element;
    element.kind = Kind::kBlock;
    element.type = {"MOVE", target.span};
    element.outputs.emplace_back();
    Pin from;
    size_t begin = cursor_.place();
    from.value.operand = cursor_.operand(TokenKind::kRightBracket);
    from.span = cursor_.span_from(begin);
    if (from.value.operand.empty()) bad("there is no value after `:=`");
    Pin to;
    to.output = true;
    to.span = target.span;
    to.value.operand = std::move(target);
    return finish(std::move(element), {from, to}, "");
  }

  // Sources of inputs stand in front of the box, sinks of outputs after it.
  Made finish(Element element, const std::vector<Pin>& pins, const char* usual_output) {
    Made made;
    bool power_in = false;
    const Pin* power_out = nullptr;
    for (const Pin& pin : pins) {
      if (pin.power && pin.output) {
        if (power_out != nullptr) return twice(pin, "power goes on from two outputs");
        power_out = &pin;
      }
      if (pin.output) continue;
      Input input;
      input.name = pin.name.text;
      input.span = pin.span;
      input.modifier = pin.value.modifier;
      if (pin.power) {
        if (power_in) return twice(pin, "power arrives at two inputs");
        power_in = true;
        made.input = static_cast<uint32_t>(element.inputs.size());
      } else if (!pin.value.operand.empty()) {
        input.from.push_back({source(pin.value.operand), 0});
      }
      element.inputs.push_back(std::move(input));
    }
    if (!power_in) {
      const char* arrives = times_power(element, pins) ? "IN" : "EN";
      Input power{arrives, {}, Modifier::kNone, true, span_};
      element.inputs.insert(element.inputs.begin(), std::move(power));
    }
    bool enable = ir::same_name(element.inputs[made.input].name, "EN");
    std::string way = power_out != nullptr ? power_out->name.text : enable ? "ENO" : usual_output;
    std::vector<std::pair<uint32_t, const Pin*>> sinks;
    for (const Pin& pin : pins) {
      if (!pin.output || pin.power || pin.value.operand.empty()) continue;
      sinks.push_back({output(element, pin.name.text), &pin});
    }
    uint32_t out = output(element, way);
    made.element = add(std::move(element));
    made.out = {made.element, out};
    for (auto [number, pin] : sinks) sink(number, *pin, made.element);
    return made;
  }

  // Power is what a timer times, unless the box says what IN is.
  bool times_power(const Element& element, const std::vector<Pin>& pins) const {
    const bool said = std::ranges::any_of(pins, [](const Pin& pin) {
      const std::string_view name = pin.name.text;
      return !pin.output &&
             (name.empty() || ir::same_name(name, "IN") || ir::same_name(name, "EN"));
    });
    return !said && !element.operand.empty() && extends_timer(element.type.text);
  }

  bool extends_timer(std::string_view type) const {
    constexpr int kMostBases = 100;  // a block that extends itself is reported elsewhere
    if (const size_t dot = type.rfind('.'); dot != type.npos) type.remove_prefix(dot + 1);
    for (int i = 0; i < kMostBases && !type.empty(); ++i) {
      if (is_timer(type)) return true;
      type = declarations_ == nullptr ? std::string_view() : declarations_->base_of(type);
    }
    return false;
  }

  // TON, TOF, TP and their variants.
  static bool is_timer(std::string_view type) {
    static constexpr std::string_view kTimers[] = {"TON", "TOF", "TP"};
    for (const std::string_view variant : {"_LTIME", "_TIME"}) {
      const size_t front = type.size() - std::min(type.size(), variant.size());
      if (ir::same_name(type.substr(front), variant)) type = type.substr(0, front);
    }
    return std::ranges::any_of(kTimers,
                               [&](std::string_view timer) { return ir::same_name(type, timer); });
  }

  Made twice(const Pin& pin, const char* text) {
    cursor_.report(Code::kBadElement, pin.span, text, "write `_` once");
    return {};
  }

  uint32_t source(const Text& operand) {
    Element element;
    element.kind = Kind::kSource;
    element.operand = operand;
    element.span = operand.span;
    element.outputs.resize(1);
    return add(std::move(element));
  }

  void sink(uint32_t output, const Pin& pin, uint32_t block) {
    Element element;
    element.kind = Kind::kSink;
    element.modifier = pin.value.modifier;
    element.operand = pin.value.operand;
    element.span = pin.span;
    element.inputs.resize(1);
    element.inputs[0].from.push_back({block, output});
    add(std::move(element));
  }

  // The number of the output of that name; functions have their result first, without a name.
  static uint32_t output(Element& element, const std::string& name) {
    for (uint32_t i = 0; i < element.outputs.size(); ++i) {
      if (ir::same_name(element.outputs[i].name, name)) return i;
    }
    element.outputs.push_back({name, false});
    return static_cast<uint32_t>(element.outputs.size() - 1);
  }

  const Piece& piece_;
  base::SourceSpan span_;
  Cursor cursor_;
  network::Network& network_;
  const DeclarationIndex* declarations_;
};

}  // namespace

std::optional<Made> make_element(std::string_view text, base::SourcePos begin, const Piece& piece,
                                 network::Network& network, base::Diagnostics& diagnostics,
                                 const DeclarationIndex* declarations) {
  return ElementReader(text, begin, piece, network, diagnostics, declarations).run();
}

}  // namespace frontend::ladder
