#include "frontend/draw/shapes.h"

#include <algorithm>

#include "base/wrapped.h"

namespace frontend::draw {

using network::Element;
using network::Kind;
using network::Modifier;

namespace {

constexpr double kStub = 14;  // wire between an operand and its pin
constexpr double kHead = 20;  // the type's row
constexpr double kNameRow = 16;
constexpr double kSymbol = 12;  // half the width of a contact
constexpr double kNoteRow = 13;
constexpr size_t kNoteColumns = 18;  // of a comment above a symbol
constexpr size_t kNoteLines = 2;
constexpr size_t kPinNoteColumns = 24;  // of one beside a pin

std::string pin_name(std::string_view name, Modifier modifier) {
  if (modifier == Modifier::kRising) return "\xE2\x86\x91" + std::string(name);
  if (modifier == Modifier::kFalling) return "\xE2\x86\x93" + std::string(name);
  return std::string(name);
}

// Cut between characters.
std::string shortened(const std::string& text, size_t bytes) {
  if (text.size() <= bytes) return text;
  size_t end = bytes;
  while (end > 0 && (static_cast<uint8_t>(text[end]) & 0xC0) == 0x80) --end;
  return text.substr(0, end) + "...";
}

const char* letter(Modifier modifier) {
  switch (modifier) {
    case Modifier::kRising:
      return "P";
    case Modifier::kFalling:
      return "N";
    case Modifier::kSet:
      return "S";
    case Modifier::kReset:
      return "R";
    default:
      return "";
  }
}

// A comment as lines above a symbol, the address below them.
std::vector<std::string> note_lines(const Look& look, std::string_view operand) {
  const Note* note = look.notes == nullptr ? nullptr : look.notes->find(operand);
  if (note == nullptr) return {};
  std::vector<std::string> out = base::wrapped(note->comment, kNoteColumns);
  if (out.size() > kNoteLines) {
    out.resize(kNoteLines);
    out.back() += " ...";
  }
  for (std::string& line : out) line = shortened(line, kNoteColumns + 6);
  if (!note->address.empty()) out.push_back(note->address);
  return out;
}

BoxPin input_pin(const network::Network& network, uint32_t element, uint32_t pin,
                 const BoxStyle& style) {
  const network::Input& input = network.elements[element].inputs[pin];
  BoxPin out;
  out.pin = pin;
  out.name = pin_name(input.name, input.modifier);
  out.ring = input.modifier == Modifier::kNegated;
  if (style.power != nullptr) {
    network::Input plain = input;
    plain.modifier = Modifier::kNone;
    out.truth = style.power->input(plain);
  }
  if (input.from.size() != 1) return out;
  const Element& from = network.elements[input.from[0].element];
  bool below = input.from[0].element >= element;
  bool written = !style.rails && (below || from.kind == Kind::kLeftRail);
  if (from.kind != Kind::kSource && !written) return out;
  out.operand = written_operand(network, input.from[0]);
  out.note = short_note(*style.look, out.operand);
  if (style.look->live != nullptr) out.value = style.look->live->shown(out.operand);
  return out;
}

BoxPin output_pin(const network::Network& network, const network::Sinks& sinks, uint32_t element,
                  uint32_t pin, bool attached, const BoxStyle& style) {
  const Element& block = network.elements[element];
  const network::Output& output = block.outputs[pin];
  BoxPin out;
  out.pin = pin;
  out.name = network::is_result(block, pin) ? "" : output.name;
  out.ring = output.negated;
  out.through = pin == style.first_output || !attached;
  if (style.power != nullptr) out.truth = style.power->output({element, pin});
  std::string shown = block.operand.text + '.' + output.name;
  for (uint32_t s : attached ? sinks.at(element, pin) : std::vector<uint32_t>{}) {
    const Element& sink = network.elements[s];
    if (!out.operand.empty()) out.operand += ", ";
    if (sink.inputs[0].modifier == Modifier::kNegated) out.operand += "NOT ";
    out.operand += sink_text(sink);
    shown = sink.operand.text;
    const std::string note = short_note(*style.look, shown);
    if (!note.empty()) out.note += (out.note.empty() ? "" : ", ") + note;
  }
  if (style.look->live != nullptr) out.value = style.look->live->shown(shown);
  return out;
}

double beside(const BoxPin& pin) {
  double width = pin.operand.empty() ? 0 : text_width(pin.operand) + kStub + 4;
  if (!pin.value.empty())
    width += text_width(pin.value, Type::kValue) + (width == 0 ? kStub : 0) + 8;
  if (!pin.note.empty()) width += text_width(pin.note, Type::kNote) + 8;
  return width;
}

void first(std::vector<BoxPin>& pins, uint32_t pin) {
  auto at = std::find_if(pins.begin(), pins.end(), [&](const BoxPin& p) { return p.pin == pin; });
  if (at != pins.end()) std::rotate(pins.begin(), at, at + 1);
}

}  // namespace

Ink ink(Truth truth) {
  return truth == Truth::kTrue ? Ink::kOn : truth == Truth::kFalse ? Ink::kOff : Ink::kPlain;
}

std::string short_note(const Look& look, std::string_view operand) {
  const Note* note = look.notes == nullptr ? nullptr : look.notes->find(operand);
  if (note == nullptr) return {};
  const bool both = !note->address.empty() && !note->comment.empty();
  return note->address + (both ? " " : "") + shortened(note->comment, kPinNoteColumns);
}

std::string written_operand(const network::Network& network, network::Link link) {
  const Element& from = network.elements[link.element];
  if (from.kind == Kind::kLeftRail) return "TRUE";
  if (from.kind != Kind::kBlock) return from.operand.text;
  return from.operand.text + '.' + from.outputs[link.output].name;
}

std::string sink_text(const Element& sink) {
  std::string mark = letter(sink.modifier);
  if (sink.modifier == Modifier::kNegated) mark = "/";
  return mark.empty() ? sink.operand.text : '(' + mark + ") " + sink.operand.text;
}

Box make_box(const network::Network& network, const network::Sinks& sinks, uint32_t element,
             const std::vector<bool>& attached, const BoxStyle& style) {
  const Element& block = network.elements[element];
  Box box;
  box.title = block.operand.text;
  box.type = block.type.text;
  for (uint32_t pin = 0; pin < block.inputs.size(); ++pin) {
    box.inputs.push_back(input_pin(network, element, pin, style));
  }
  for (uint32_t pin = 0; pin < block.outputs.size(); ++pin) {
    box.outputs.push_back(output_pin(network, sinks, element, pin, attached[pin], style));
  }
  first(box.inputs, style.first_input);
  first(box.outputs, style.first_output);
  double left = 0;
  double right = 0;
  for (const BoxPin& pin : box.inputs) {
    box.before = std::max(box.before, beside(pin));
    left = std::max(left, text_width(pin.name, Type::kSmall));
  }
  for (const BoxPin& pin : box.outputs) {
    box.behind = std::max(box.behind, beside(pin));
    right = std::max(right, text_width(pin.name, Type::kSmall));
  }
  box.width = std::max(
      {56.0, text_width(box.type) + 16, left + right + 30, text_width(box.title, Type::kBold) + 4});
  box.up = kHead + kPinRow / 2 + (box.title.empty() ? 4 : kNameRow);
  double rows = static_cast<double>(std::max<size_t>({box.inputs.size(), box.outputs.size(), 1}));
  box.down = (rows - 0.5) * kPinRow + 4;
  return box;
}

void draw_box(Svg& svg, const Box& box, double x, double y) {
  double left = x + box.before;
  double right = left + box.width;
  double top = y - kPinRow / 2 - kHead;
  svg.rect(left, top, box.width, y + box.down - 4 - top);
  double middle = left + box.width / 2;
  svg.text(middle, top + 14, box.type, Type::kMono, Anchor::kMiddle);
  if (!box.title.empty()) svg.text(middle, top - 5, box.title, Type::kBold, Anchor::kMiddle);
  double at = y;
  for (const BoxPin& pin : box.inputs) {
    svg.text(left + (pin.ring ? 9 : 5), at + 4, pin.name, Type::kSmall);
    if (!pin.operand.empty()) {
      svg.line(left - kStub, at, left, at, ink(pin.truth));
      svg.text(left - kStub - 3, at + 4, pin.operand, Type::kMono, Anchor::kEnd);
      double behind = left - kStub - 11 - text_width(pin.operand);
      svg.text(behind, at + 4, pin.value, Type::kValue, Anchor::kEnd);
      if (!pin.value.empty()) behind -= text_width(pin.value, Type::kValue) + 8;
      svg.text(behind, at + 4, pin.note, Type::kNote, Anchor::kEnd);
    }
    if (pin.ring) svg.ring(left - 4, at, 4);
    at += kPinRow;
  }
  at = y;
  for (const BoxPin& pin : box.outputs) {
    svg.text(right - 5, at + 4, pin.name, Type::kSmall, Anchor::kEnd);
    double behind = right + (pin.through ? 4 : kStub + 3);
    double text_y = pin.through ? at - 4 : at + 4;
    if (!pin.operand.empty()) {
      if (!pin.through) svg.line(right, at, right + kStub, at, ink(pin.truth));
      svg.text(behind, text_y, pin.operand);
      behind += text_width(pin.operand) + 8;
    }
    svg.text(behind, text_y, pin.value, Type::kValue);
    if (!pin.value.empty()) behind += text_width(pin.value, Type::kValue) + 8;
    svg.text(behind, text_y, pin.note, Type::kNote);
    if (pin.ring) svg.ring(right + 4, at, 4);
    at += kPinRow;
  }
}

Symbol make_symbol(const Element& element, const Look& look) {
  const Live* live = look.live;
  Symbol out;
  out.kind = element.kind;
  out.modifier = element.modifier;
  out.operand = element.kind == Kind::kReturn ? "RETURN" : element.operand.text;
  bool text_in_wire = element.kind == Kind::kJump || element.kind == Kind::kReturn;
  if (live != nullptr && !text_in_wire) {
    out.own = live->truth(element.operand.text);
    out.value = live->shown(element.operand.text);
    bool opens = element.kind == Kind::kContact && element.modifier == Modifier::kNegated;
    if (opens) out.own = !out.own;
  }
  out.width = std::max(56.0, text_width(out.operand) + (text_in_wire ? 44 : 16));
  out.width = std::max(out.width, text_width(out.value, Type::kValue) + 16);
  if (!text_in_wire) out.notes = note_lines(look, element.operand.text);
  for (const std::string& line : out.notes) {
    out.width = std::max(out.width, text_width(line, Type::kNote) + 12);
  }
  out.up = (text_in_wire ? 14 : 32) + static_cast<double>(out.notes.size()) * kNoteRow;
  out.down = out.value.empty() ? 16 : 28;
  return out;
}

void draw_symbol(Svg& svg, const Symbol& symbol, double x, double width, double y, Ink in,
                 Ink out) {
  double middle = x + width / 2;
  if (symbol.kind == Kind::kJump || symbol.kind == Kind::kReturn) {
    double begin = x + width - text_width(symbol.operand) - 20;
    svg.line(x, y, begin, y, in);
    svg.arrow_right(begin + 8, y, in);
    svg.text(begin + 12, y + 4, symbol.operand, Type::kBold);
    return;
  }
  bool coil = symbol.kind == Kind::kCoil;
  Ink own = ink(symbol.own);
  svg.line(x, y, middle - kSymbol, y, in);
  svg.line(middle + kSymbol, y, x + width, y, out);
  if (coil) {
    svg.arc(middle - 6, y, 20, true, own);
    svg.arc(middle + 6, y, 20, false, own);
    svg.line(middle - kSymbol, y, middle - 10, y, in);
    svg.line(middle + 10, y, middle + kSymbol, y, out);
  } else {
    svg.line(middle - kSymbol + 4, y - 10, middle - kSymbol + 4, y + 10, own);
    svg.line(middle + kSymbol - 4, y - 10, middle + kSymbol - 4, y + 10, own);
    svg.line(middle - kSymbol, y, middle - kSymbol + 4, y, in);
    svg.line(middle + kSymbol - 4, y, middle + kSymbol, y, out);
  }
  if (symbol.modifier == Modifier::kNegated) svg.line(middle - 5, y + 8, middle + 5, y - 8, own);
  svg.text(middle, y + 4, letter(symbol.modifier), Type::kBold, Anchor::kMiddle);
  svg.text(middle, y - 16, symbol.operand, Type::kMono, Anchor::kMiddle);
  double above = y - 16 - kNoteRow * static_cast<double>(symbol.notes.size());
  for (const std::string& line : symbol.notes) {
    svg.text(middle, above, line, Type::kNote, Anchor::kMiddle);
    above += kNoteRow;
  }
  svg.text(middle, y + 23, symbol.value, Type::kValue, Anchor::kMiddle);
}

}  // namespace frontend::draw
