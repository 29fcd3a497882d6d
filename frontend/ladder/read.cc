#include "frontend/ladder/read.h"

#include <queue>

#include "base/limits.h"
#include "frontend/ladder/element.h"
#include "frontend/lex/characters.h"
#include "frontend/network/comments.h"

namespace frontend::ladder {
namespace {

using Code = base::DiagnosticCode;

class RungReader {
 public:
  RungReader(std::string_view text, base::SourcePos begin, const Rung& rung,
             network::Network& network, base::Diagnostics& diagnostics,
             const DeclarationIndex* declarations)
      : text_(text),
        begin_(begin),
        rung_(rung),
        network_(network),
        diagnostics_(diagnostics),
        declarations_(declarations),
        made_(rung.pieces.size()) {}

  void run() {
    if (rung_.damaged || !check_pieces() || !check_nodes() || !check_size()) return;
    network::Element rail;
    rail.kind = network::Kind::kLeftRail;
    rail.outputs.resize(1);
    network_.elements.push_back(std::move(rail));
    const std::vector<uint32_t> order = execution_order();
    if (order.size() != rung_.pieces.size()) return circle(order);
    for (uint32_t number : order) make(number);
  }

 private:
  void report(Code code, uint32_t byte, uint32_t bytes, std::string text, std::string fix) {
    uint32_t at = begin_.offset + byte;
    diagnostics_.add(code, {{at}, {at + bytes}}, std::move(text), std::move(fix));
  }
  void report(Code code, const Piece& piece, std::string text, std::string fix) {
    report(code, piece.byte, piece.bytes, std::move(text), std::move(fix));
  }

  // Boxes have a `:` that stands in no parentheses, or `_` as a word.
  bool is_contact(const Piece& piece) const {
    if (piece.kind != SegmentKind::kContact) return false;
    std::string_view inside = text_.substr(piece.byte, piece.bytes);
    bool word = false;
    bool colon = false;
    int depth = 0;
    char quote = '\0';
    for (char c : inside.substr(1)) {  // behind its own bracket
      if (quote != '\0') {
        if (c == quote) quote = '\0';
      } else if (c == '\'' || c == '"') {
        quote = c;
      } else {
        depth += c == '(' || c == '[' ? 1 : c == ')' || c == ']' ? -1 : 0;
        colon = colon || (c == ':' && depth <= 0);
      }
    }
    for (size_t i = 1; i + 1 < inside.size() && !word; ++i) {
      bool alone = !is_name_part(inside[i - 1]) && !is_name_part(inside[i + 1]);
      word = inside[i] == '_' && alone;
    }
    return !word && !colon;
  }

  // Every wire gets power from somewhere, and somebody uses it.
  bool check_nodes() {
    bool good = true;
    for (const Node& node : rung_.nodes) {
      bool fed = node.powered || !node.drivers.empty();
      if (!fed && (node.bytes != 0 || !node.users.empty())) {
        report(Code::kNoPower, node.byte, node.bytes, "no power arrives on this wire",
               "connect its left end with the left rail or with an element");
        good = false;
      }
      if (!node.users.empty()) continue;
      for (uint32_t driver : node.drivers) {
        const Piece& piece = rung_.pieces[driver];
        if (!is_contact(piece)) continue;
        good = false;
        if (node.ends) {
          report(Code::kRungWithoutCoil, piece,
                 "behind this contact the rung ends at the right rail without a coil",
                 "write the coil that it switches: ( name )");
        } else {
          report(Code::kOpenBranch, piece, "the branch behind this contact is never joined",
                 "lead its wire to a `+` of another row, to a coil or to a box");
        }
      }
    }
    return good;
  }

  bool check_pieces() {
    bool good = true;
    for (const Piece& piece : rung_.pieces) {
      if (piece.left == kNoNode) {
        report(Code::kNoPower, piece, "no wire touches the left side of this element",
               "draw `-` from where its power comes, without a gap");
        good = false;
      } else if (piece.left == piece.right) {
        report(Code::kShortCircuit, piece, "a wire leads around this element: it changes nothing",
               "put an element into the other branch, or take one of the two away");
        good = false;
      } else if (piece.right == kNoNode && is_contact(piece)) {
        report(Code::kOpenBranch, piece, "no wire goes on behind this contact",
               "draw `-` to the coil, without a gap");
        good = false;
      }
    }
    return good;
  }

  // Every element after a wire has a link to every one in front of it.
  bool check_size() {
    uint64_t links = 0;
    for (const Node& node : rung_.nodes) links += uint64_t{node.drivers.size()} * node.users.size();
    if (links <= base::kMaxLinks) return true;
    const Piece& first = rung_.pieces.front();
    report(Code::kTooComplex, first,
           "the wires of this rung connect " + std::to_string(links) +
               " pairs of elements; the limit is " + std::to_string(base::kMaxLinks),
           "give what a wire carries to a coil, and begin new rungs with its contact");
    return false;
  }

  // From left to right along power, otherwise as they are drawn: row by row.
  std::vector<uint32_t> execution_order() {
    std::vector<uint32_t> waits(rung_.pieces.size());
    std::priority_queue<uint32_t, std::vector<uint32_t>, std::greater<>> ready;
    for (uint32_t i = 0; i < rung_.pieces.size(); ++i) {
      waits[i] = static_cast<uint32_t>(rung_.nodes[rung_.pieces[i].left].drivers.size());
      if (waits[i] == 0) ready.push(i);
    }
    std::vector<uint32_t> order;
    while (!ready.empty()) {
      uint32_t next = ready.top();
      ready.pop();
      order.push_back(next);
      if (rung_.pieces[next].right == kNoNode) continue;
      for (uint32_t user : rung_.nodes[rung_.pieces[next].right].users) {
        if (--waits[user] == 0) ready.push(user);
      }
    }
    return order;
  }

  void circle(const std::vector<uint32_t>& order) {
    std::vector<bool> done(rung_.pieces.size());
    for (uint32_t number : order) done[number] = true;
    for (uint32_t i = 0; i < rung_.pieces.size(); ++i) {
      if (done[i]) continue;
      report(Code::kPowerCircle, rung_.pieces[i],
             "power would flow in a circle through this element",
             "give the value to a variable with a coil, and read it with a contact");
      return;
    }
  }

  void make(uint32_t number) {
    const Piece& piece = rung_.pieces[number];
    auto made = make_element(text_, begin_, piece, network_, diagnostics_, declarations_);
    if (!made) return;
    for (network::Comment& comment : network::comments_in(text_.substr(piece.byte, piece.bytes))) {
      network_.comments.push_back(std::move(comment.text));
    }
    made_[number] = made;
    network::Input& input = network_.elements[made->element].inputs[made->input];
    const Node& node = rung_.nodes[piece.left];
    if (node.powered) input.from.push_back({0, 0});
    for (uint32_t driver : node.drivers) {
      if (!made_[driver]) continue;
      if (network_.elements[made_[driver]->element].outputs.empty()) {
        report(Code::kBadElement, piece, "no power goes on behind JMP and RETURN",
               "put it into a branch of its own, or in front of them");
        continue;
      }
      input.from.push_back(made_[driver]->out);
    }
  }

  std::string_view text_;
  base::SourcePos begin_;
  const Rung& rung_;
  network::Network& network_;
  base::Diagnostics& diagnostics_;
  const DeclarationIndex* declarations_;
  std::vector<std::optional<Made>> made_;
};

// What stands in front of a rung: comments, a label.
class Heads {
 public:
  Heads(std::string_view text, base::SourcePos begin, const std::vector<Row>& rows)
      : text_(text), begin_(begin), rows_(rows) {}

  // Reads the rows from the last one taken up to `end`.
  network::Network take(uint32_t end, network::Body& body) {
    network::Network out;
    for (; next_ < end; ++next_) {
      const Row& row = rows_[next_];
      if (row.kind == RowKind::kLabel) {
        if (!out.label.empty()) {  // two labels in front of one rung
          body.networks.push_back(std::move(out));
          out = {};
        }
        out.label.text = text_.substr(row.label, row.label_bytes);
        uint32_t at = begin_.offset + row.label;
        out.label.span = {{at}, {at + row.label_bytes}};
      }
      if (row.kind == RowKind::kHead) {
        if (out.headed) {  // two titles in front of one rung
          body.networks.push_back(std::move(out));
          out = {};
        }
        out.headed = true;
        out.title = row.head.title;
        out.disabled = row.head.disabled;
      }
      out.comments.insert(out.comments.end(), row.comments.begin(), row.comments.end());
    }
    return out;
  }

 private:
  std::string_view text_;
  base::SourcePos begin_;
  const std::vector<Row>& rows_;
  uint32_t next_ = 0;
};

}  // namespace

network::Body read(std::string_view text, base::SourcePos begin, base::Diagnostics& diagnostics,
                   const DeclarationIndex* declarations) {
  if (!begin.valid()) begin = {0};
  network::Body body;
  body.language = network::Language::kLadder;
  body.span = {begin, {begin.offset + static_cast<uint32_t>(text.size())}};
  const std::vector<Row> rows = read_rows(text, begin, diagnostics);
  Heads heads(text, begin, rows);
  for (const Rung& rung : find_rungs(rows, begin, diagnostics)) {
    network::Network network = heads.take(rung.last_row + 1, body);
    const Piece& first = rung.pieces.front();
    const Piece& last = rung.pieces.back();
    network.span = {{begin.offset + first.byte}, {begin.offset + last.byte + last.bytes}};
    RungReader(text, begin, rung, network, diagnostics, declarations).run();
    body.networks.push_back(std::move(network));
  }
  network::Network rest = heads.take(static_cast<uint32_t>(rows.size()), body);
  const bool named = !rest.label.empty() || rest.headed;
  if (named || !rest.comments.empty()) body.networks.push_back(std::move(rest));
  return body;
}

}  // namespace frontend::ladder
