#include "frontend/fbd/read.h"

#include "frontend/fbd/links.h"
#include "frontend/network/comments.h"
#include "frontend/network/head.h"
#include "frontend/network/pins.h"
#include "ir/types/types.h"

namespace frontend::fbd {
namespace {

using Code = base::DiagnosticCode;
using network::Cursor;
using network::Element;
using network::Input;
using network::Kind;
using network::Modifier;
using network::Pin;
using network::PinValue;
using network::Text;

constexpr uint32_t kNoRow = 0xffffffffu;

class Reader {
 public:
  Reader(std::string_view text, base::SourcePos begin, base::Diagnostics& diagnostics)
      : text_(text), begin_(begin), cursor_(text, begin, diagnostics), links_(diagnostics) {}

  network::Body run() {
    body_.language = network::Language::kFbd;
    body_.span = {begin_, {begin_.offset + static_cast<uint32_t>(text_.size())}};
    body_.networks.emplace_back();
    while (!cursor_.at_end()) {
      take_comments(cursor_.token().begin);
      size_t before = cursor_.place();
      elements_before_ = current().elements.size();
      uses_before_ = links_.uses();
      row();
      end_row(before);
    }
    take_comments(begin_.offset + static_cast<uint32_t>(text_.size()));
    attach(false);
    links_.finish(current());
    return std::move(body_);
  }

 private:
  // A network that begins behind what was read; the first one has nothing in front of it.
  void begin_network() {
    links_.finish(current());
    const network::Network& last = current();
    const bool fresh = last.elements.empty() && last.label.empty() && last.comments.empty();
    if (!fresh || last.headed) body_.networks.emplace_back();
    last_row_ = kNoRow;
  }

  // {network 'title' disabled}, from `at` of text_; returns where it ends.
  size_t head(size_t at) {
    const size_t end = std::min(text_.find('}', at), text_.size() - 1) + 1;
    const std::string_view pragma = text_.substr(at, end - at);
    const auto refuse = [&](const char* why, std::string fix) {
      const uint32_t offset = begin_.offset + static_cast<uint32_t>(at);
      cursor_.report(Code::kBadDiagramRow, {{offset}, {begin_.offset + static_cast<uint32_t>(end)}},
                     why, std::move(fix));
      cursor_.forget();
      return end;
    };
    const size_t first = std::min(pragma.find_first_not_of(" \t", 1), pragma.size());
    const std::string inside = base::fold_name(pragma.substr(first));
    for (const char* word : {"IF", "ELSIF", "ELSE", "END_IF", "DEFINE", "UNDEFINE"}) {
      if (!inside.starts_with(base::fold_name(word))) continue;
      return refuse("a drawing has no rows that are there on a condition only",
                    "write {IF ...} around the whole body, or two actions");
    }
    // Others are no rows.
    if (!inside.starts_with(base::fold_name("network"))) return end;
    std::optional<network::Head> head = network::read_head(pragma);
    if (!head) {
      return refuse("this row between { } is not understood", std::string(network::kHeadForm));
    }
    begin_network();
    attach(false);  // what stands in front of the row
    current().headed = true;
    current().title = std::move(head->title);
    current().disabled = head->disabled;
    return end;
  }

  network::Network& current() { return body_.networks.back(); }

  void bad(std::string text, std::string fix =
                                 "write a box `name : TYPE(pin := operand);`, "
                                 "`WIRE name := F(a, b);` or `variable := wire;`") {
    cursor_.report(Code::kBadDiagramRow, cursor_.token().span(), std::move(text), std::move(fix));
  }

  // Titles begin networks. Comments up to there belong to the next row, or to the last one when
  // they stand in its line.
  void take_comments(uint32_t until) {
    size_t from = behind_;
    size_t to = until - begin_.offset;
    behind_ = to;
    if (from >= to) return;
    for (size_t at = from; at < to;) {
      if (text_[at] == '{') {
        at = head(at);
        continue;
      }
      const size_t end = network::comment_end(text_, at);
      if (end == at) {
        ++at;
        continue;
      }
      const bool same_line = text_.substr(from, at - from).find('\n') == std::string_view::npos;
      std::string comment = network::comment_text(text_.substr(at, end - at));
      if (same_line && last_row_ != kNoRow) {
        current().elements[last_row_].comments.push_back(std::move(comment));
      } else {
        pending_.push_back(std::move(comment));
      }
      at = end;
    }
  }
  // Gives what is pending to the row that was read, or to the network.
  void attach(bool row) {
    for (std::string& comment : pending_) {
      if (row && last_row_ != kNoRow) {
        current().elements[last_row_].comments.push_back(std::move(comment));
      } else {
        current().comments.push_back(std::move(comment));
      }
    }
    pending_.clear();
  }

  void row() {
    if (cursor_.accept(TokenKind::kSemicolon)) return;
    if (cursor_.at_jump()) return jump();
    if (cursor_.kind() == TokenKind::kReturn) return leave();
    if (cursor_.is_word("WIRE") && is_name(cursor_.kind(1))) return wire();
    if (size_t colon = colon_of_row(); colon != 0) {
      return is_box(colon) ? block(colon) : label(colon);
    }
    assignment();
  }

  // Rows end with `;`, labels with their `:`. What is left of a bad row is skipped.
  void end_row(size_t before) {
    if (!label_) {
      if (cursor_.good() && !cursor_.accept(TokenKind::kSemicolon) && cursor_.place() != before) {
        bad("expected `;` at the end of the row, found " + cursor_.found(), "write `;`");
      }
      if (!cursor_.good()) {
        forget_row();
        while (!cursor_.at_end() && !cursor_.accept(TokenKind::kSemicolon)) cursor_.take();
      }
      if (cursor_.place() == before) cursor_.take();
    }
    cursor_.forget();
    const Token& last = cursor_.token_before();
    size_t row = behind_;
    behind_ = last.begin + last.length - begin_.offset;
    for (network::Comment& comment : network::comments_in(text_.substr(row, behind_ - row))) {
      pending_.push_back(std::move(comment.text));  // inside of the row
    }
    attach(!label_);
    label_ = false;
  }

  // What a bad row has made is not worth more messages.
  void forget_row() {
    current().elements.resize(elements_before_);
    links_.forget(uses_before_, elements_before_);
    last_row_ = kNoRow;
  }

  // The place of the `:` that the row has before any `:=`; 0: none.
  size_t colon_of_row() {
    size_t begin = cursor_.place();
    size_t found = 0;
    for (uint32_t depth = 0; !cursor_.at_end() && found == 0; cursor_.take()) {
      TokenKind k = cursor_.kind();
      if (k == TokenKind::kSemicolon || (k == TokenKind::kAssign && depth == 0)) break;
      if (k == TokenKind::kLeftBracket || k == TokenKind::kLeftParen) ++depth;
      if (k == TokenKind::kRightBracket || k == TokenKind::kRightParen) depth -= depth > 0 ? 1 : 0;
      if (k == TokenKind::kColon && depth == 0) found = cursor_.place();
    }
    cursor_.go_to(begin);
    return found;
  }

  // After the `:` of a box stand a type and its parenthesis.
  bool is_box(size_t colon) {
    size_t begin = cursor_.place();
    cursor_.go_to(colon + 1);
    bool box = !cursor_.name().empty() && cursor_.kind() == TokenKind::kLeftParen;
    cursor_.go_to(begin);
    return box;
  }

  void label(size_t colon) {
    size_t begin = cursor_.place();
    Text name = cursor_.name();
    if (cursor_.place() != colon || name.empty()) {
      bad("this is neither a label nor a box");
      return;
    }
    const network::Network& above = current();
    if (!above.headed || !above.elements.empty() || !above.label.empty()) {
      links_.finish(current());
      body_.networks.emplace_back();
    }
    cursor_.take();
    current().label = std::move(name);
    current().span = cursor_.span_from(begin);
    label_ = true;
    last_row_ = kNoRow;
    attach(false);
  }

  uint32_t add(Element element, size_t begin) {
    element.span = cursor_.span_from(begin);
    current().elements.push_back(std::move(element));
    return last_row_ = static_cast<uint32_t>(current().elements.size() - 1);
  }

  // Without IF it is linked to power.
  void condition(Element& element, Text& operand) {
    element.inputs.resize(1);
    if (!cursor_.is_word("IF") && cursor_.kind() != TokenKind::kIf) {
      Element rail;
      rail.kind = Kind::kLeftRail;
      rail.outputs.resize(1);
      current().elements.push_back(std::move(rail));
      element.inputs[0].from.push_back({static_cast<uint32_t>(current().elements.size() - 1), 0});
      return;
    }
    cursor_.take();
    PinValue value = network::read_value(cursor_, TokenKind::kSemicolon);
    if (value.operand.empty()) bad("there is no operand after IF");
    element.inputs[0].modifier = value.modifier;
    operand = std::move(value.operand);
  }

  void conditional(Kind kind, Text name, size_t begin) {
    Element element;
    element.kind = kind;
    element.operand = std::move(name);
    Text operand;
    condition(element, operand);
    uint32_t number = add_with_source(std::move(element), {operand}, begin);
    if (!operand.empty()) links_.add_use(number, 0, operand);
  }
  void jump() {
    size_t begin = cursor_.place();
    cursor_.take();
    conditional(Kind::kJump, cursor_.label(), begin);
  }
  void leave() {
    size_t begin = cursor_.place();
    cursor_.take();
    conditional(Kind::kReturn, {}, begin);
  }

  // inst : TYPE(pins)
  void block(size_t colon) {
    size_t begin = cursor_.place();
    while (cursor_.place() < colon) cursor_.take();
    Element element;
    element.operand = cursor_.text_from(begin);
    cursor_.take();
    Text name = element.operand;
    finish_block(std::move(element), begin, name, false);
  }

  // WIRE name := F(pins)
  void wire() {
    size_t begin = cursor_.place();
    cursor_.take();
    Text name = cursor_.name();
    if (!cursor_.accept(TokenKind::kAssign)) return bad("expected `:=` after the wire's name");
    size_t value = cursor_.place();
    bool call = !cursor_.name().empty() && cursor_.kind() == TokenKind::kLeftParen;
    cursor_.go_to(value);
    if (!call)
      return bad("a wire comes from the box of a function", "write `WIRE name := F(a, b);`");
    Element element;
    element.outputs.emplace_back();
    element.wire = name;
    finish_block(std::move(element), begin, name, true);
  }

  void finish_block(Element element, size_t begin, const Text& name, bool wire) {
    element.kind = Kind::kBlock;
    element.type = cursor_.name();
    cursor_.take();  // the parenthesis
    std::vector<Pin> pins = network::read_pins(cursor_, TokenKind::kRightParen);
    if (cursor_.good() && !cursor_.accept(TokenKind::kRightParen)) {
      bad("expected `)` after the pins, found " + cursor_.found(), "write `)`");
    }
    if (!cursor_.good()) return;
    std::vector<Text> operands;
    for (const Pin& pin : pins) {
      if (pin.output || pin.power) {
        cursor_.report(Code::kBadDiagramRow, pin.span,
                       pin.output ? "outputs are connected in rows of their own"
                                  : "`_` is a pin of ladder; here operands have names",
                       pin.output ? "write `variable := box.output;` below the box"
                                  : "write a wire, an output of a box or an expression");
        return;
      }
      operands.push_back(pin.value.operand);
      Input input;
      input.name = pin.name.text;
      input.modifier = pin.value.modifier;
      input.span = pin.span;
      element.inputs.push_back(std::move(input));
    }
    uint32_t number = add_with_source(std::move(element), operands, begin);
    for (uint32_t i = 0; i < operands.size(); ++i) links_.add_use(number, i, operands[i]);
    links_.add_box(name, number, wire);
  }

  // v := operand;  v S= operand;  v R= operand;
  void assignment() {
    size_t begin = cursor_.place();
    Element element;
    element.kind = Kind::kSink;
    while (!cursor_.at_end() && cursor_.kind() != TokenKind::kAssign &&
           cursor_.kind() != TokenKind::kSemicolon) {
      bool set = cursor_.is_word("S"), reset = cursor_.is_word("R");
      if ((set || reset) && cursor_.kind(1) == TokenKind::kEqual && cursor_.place() != begin) {
        element.modifier = set ? Modifier::kSet : Modifier::kReset;
        break;
      }
      cursor_.take();
    }
    element.operand = cursor_.text_from(begin);
    if (element.modifier != Modifier::kNone) cursor_.take();
    if (cursor_.place() == begin || cursor_.at_end() || cursor_.kind() == TokenKind::kSemicolon) {
      cursor_.go_to(begin);
      return bad("this is no row of a diagram");
    }
    cursor_.take();
    PinValue value = network::read_value(cursor_, TokenKind::kSemicolon);
    if (value.operand.empty()) return bad("there is no operand after `:=`");
    element.inputs.resize(1);
    element.inputs[0].modifier = value.modifier;
    element.inputs[0].span = value.operand.span;
    links_.add_use(add_with_source(std::move(element), {value.operand}, begin), 0, value.operand);
  }

  // Sources of what is no box stand in front of the element; which those are is known at the end
  // of the network, so every operand gets one, and those of boxes are dropped then.
  uint32_t add_with_source(Element element, const std::vector<Text>& operands, size_t begin) {
    for (const Text& operand : operands) {
      if (operand.empty()) continue;
      Element source;
      source.kind = Kind::kSource;
      source.operand = operand;
      source.outputs.resize(1);
      source.span = operand.span;
      current().elements.push_back(std::move(source));
    }
    return add(std::move(element), begin);
  }
  std::string_view text_;
  base::SourcePos begin_;
  Cursor cursor_;
  network::Body body_;
  Links links_;
  std::vector<std::string> pending_;  // comments in front of the next row
  size_t elements_before_ = 0;        // the current row
  size_t uses_before_ = 0;
  size_t behind_ = 0;           // the last row, in text_
  uint32_t last_row_ = kNoRow;  // its element
  bool label_ = false;          // the last row is a label
};

}  // namespace

network::Body read(std::string_view text, base::SourcePos begin, base::Diagnostics& diagnostics) {
  return Reader(text, begin.valid() ? begin : base::SourcePos{0}, diagnostics).run();
}

}  // namespace frontend::fbd
