#include "frontend/ladder/drawing.h"

#include "base/diagnostics_render.h"
#include "frontend/lex/characters.h"
#include "frontend/network/comments.h"
#include "ir/types/utf.h"

namespace frontend::ladder {
namespace {

using Code = base::DiagnosticCode;

bool is_utf8(std::string_view text) {
  while (!text.empty()) {
    uint32_t bytes = ir::read_utf8(text).bytes;
    if (bytes == 0) return false;
    text.remove_prefix(bytes);
  }
  return true;
}

class RowReader {
 public:
  RowReader(std::string_view text, base::SourcePos begin, base::Diagnostics& diagnostics)
      : text_(text), begin_(begin.valid() ? begin.offset : 0), diagnostics_(diagnostics) {
    wide_ = is_utf8(text);
  }

  std::vector<Row> run() {
    while (at_ < text_.size()) {
      column_ = 0;
      rows_.emplace_back();
      row();
    }
    return std::move(rows_);
  }

 private:
  Row& current() { return rows_.back(); }
  char peek(size_t ahead = 0) const {
    return at_ + ahead < text_.size() ? text_[at_ + ahead] : '\0';
  }
  bool at(std::string_view mark) const { return text_.substr(at_, mark.size()) == mark; }
  bool at_line_end() const { return at_ >= text_.size() || text_[at_] == '\n'; }
  void take() {
    bool continuation = wide_ && (static_cast<uint8_t>(text_[at_]) & 0xC0) == 0x80;
    ++at_;
    if (!continuation) ++column_;
  }
  void report(Code code, size_t from, size_t to, std::string text, std::string fix) {
    current().damaged = true;
    diagnostics_.add(code,
                     {{begin_ + static_cast<uint32_t>(from)}, {begin_ + static_cast<uint32_t>(to)}},
                     std::move(text), std::move(fix));
  }

  void row() {
    while (!at_line_end()) {
      char c = peek();
      if (is_space(c)) {
        if (c == '\t' && !tab_reported_) tab();
        take();
      } else if (at("//") || at("(*") || at("/*")) {
        comment();
      } else if (current().segments.empty() && is_name_start(c) && label()) {
        continue;
      } else if (c == '{' && current().segments.empty()) {
        head();
      } else {
        segment();
      }
    }
    if (at_ < text_.size()) ++at_;  // the line's end
  }

  void tab() {
    tab_reported_ = true;
    report(Code::kBadDrawing, at_, at_ + 1,
           "a tab stands in the drawing: how wide it is depends on the editor",
           "use blanks in a drawing");
  }

  // May go on over line ends.
  void comment() {
    size_t end = network::comment_end(text_, at_);
    std::string_view whole = text_.substr(at_, end - at_);
    bool line = at("//");
    if (!line && end == text_.size() &&
        (whole.size() < 4 || !whole.ends_with(at("(*") ? "*)" : "*/"))) {
      report(Code::kUnterminatedComment, at_, at_ + 2, "this comment is not closed",
             "close it after its text");
    }
    current().comments.push_back(network::comment_text(whole));
    if (current().kind == RowKind::kBlank) current().kind = RowKind::kComment;
    skip(end - at_);
  }

  void skip(size_t count) {
    while (count-- > 0 && at_ < text_.size()) take();
  }

  bool label() {
    size_t end = at_;
    while (end < text_.size() && is_name_part(text_[end])) ++end;
    size_t colon = end;
    while (colon < text_.size() && (text_[colon] == ' ' || text_[colon] == '\t')) ++colon;
    const bool taken = current().kind == RowKind::kLabel || current().kind == RowKind::kHead;
    if (colon >= text_.size() || text_[colon] != ':' || taken) {
      return false;
    }
    current().kind = RowKind::kLabel;
    current().label = static_cast<uint32_t>(at_);
    current().label_bytes = static_cast<uint32_t>(end - at_);
    while (at_ <= colon) take();
    return true;
  }

  // {network 'title' disabled}
  void head() {
    const size_t begin = at_;
    while (!at_line_end() && peek() != '}') take();
    const bool closed = peek() == '}';
    if (closed) take();
    std::optional<network::Head> head;
    const bool first = current().kind == RowKind::kBlank || current().kind == RowKind::kComment;
    if (closed && first) head = network::read_head(text_.substr(begin, at_ - begin));
    if (!head) {
      const size_t end = closed ? at_ : begin + 1;
      report(Code::kBadDrawing, begin, end, "this row between { } is not understood",
             std::string(network::kHeadForm));
      return;
    }
    current().kind = RowKind::kHead;
    current().head = std::move(*head);
  }

  void segment() {
    size_t begin = at_;
    Segment out;
    out.column = column_;
    out.byte = static_cast<uint32_t>(at_);
    switch (peek()) {
      case '-':
        out.kind = SegmentKind::kWire;
        while (peek() == '-') take();
        break;
      case '+':
        out.kind = SegmentKind::kJoint;
        take();
        break;
      case '|':
        out.kind = SegmentKind::kBar;
        take();
        break;
      case '[':
      case '(':
        out.kind = peek() == '[' ? SegmentKind::kContact : SegmentKind::kCoil;
        if (!element()) return;
        break;
      default:
        return bad_characters();
    }
    out.end = column_;
    out.bytes = static_cast<uint32_t>(at_ - begin);
    if (current().kind == RowKind::kLabel) {
      report(Code::kBadDrawing, begin, at_, "a rung stands in the row of a label",
             "give the label a row of its own, in front of the rung");
    } else if (current().kind == RowKind::kHead) {
      report(Code::kBadDrawing, begin, at_, "a rung stands in the row of its title",
             "give what stands in { } a row of its own, in front of the rung");
    }
    current().kind = RowKind::kDrawing;
    current().segments.push_back(out);
  }

  // From a bracket to its counterpart in the same row.
  bool element() {
    size_t begin = at_;
    std::string closing;
    while (!at_line_end()) {
      char c = peek();
      if (c == '[' || c == '(') closing += c == '[' ? ']' : ')';
      if (c == '\'' || c == '"') {
        take();
        while (!at_line_end() && peek() != c) skip(peek() == '$' ? 2 : 1);
      }
      if ((c == ']' || c == ')') && closing.back() == c) {
        closing.pop_back();
        if (closing.empty()) {
          take();
          return true;
        }
      }
      if (!at_line_end()) take();
    }
    report(Code::kUnclosedElement, begin, begin + 1,
           std::string("`") + closing.back() + "` is missing in this row",
           "an element stands in one row, from bracket to bracket");
    return false;
  }

  void bad_characters() {
    size_t begin = at_;
    while (!at_line_end() && !is_space(peek()) && std::string_view("-+|[(").find(peek()) > 4) {
      take();
    }
    if (current().damaged) return;
    std::string shown = base::printable(text_.substr(begin, at_ - begin));
    report(Code::kBadDrawing, begin, at_, "`" + shown + "` is no part of a drawing",
           "contacts stand in [ ], coils in ( ), wires are made of - + |");
  }

  std::string_view text_;
  uint32_t begin_;
  base::Diagnostics& diagnostics_;
  std::vector<Row> rows_;
  size_t at_ = 0;
  uint32_t column_ = 0;
  bool wide_ = false;
  bool tab_reported_ = false;
};

}  // namespace

std::vector<Row> read_rows(std::string_view text, base::SourcePos begin,
                           base::Diagnostics& diagnostics) {
  return RowReader(text, begin, diagnostics).run();
}

}  // namespace frontend::ladder
