#include "frontend/network/same.h"

#include <algorithm>
#include <unordered_map>
#include <utility>

#include "base/hash.h"
#include "frontend/lex/characters.h"
#include "frontend/lex/lexer.h"
#include "frontend/network/element_text.h"
#include "frontend/network/expressions.h"
#include "ir/types/types.h"

namespace frontend::network {

namespace {

// An operand but for blanks and case.
std::string normal(std::string_view text) {
  base::Diagnostics unheard;
  std::string out;
  for (const Token& token : lex(text, base::SourcePos{0}, unheard).tokens) {
    if (token.length == 0) continue;
    std::string_view part = text.substr(token.begin, token.length);
    bool string = part.find_first_of("'\"") != std::string_view::npos;
    out += (out.empty() ? "" : " ") + (string ? std::string(part) : ir::fold_name(part));
  }
  return out;
}

// Folded names in an operand.
std::vector<std::string> words(std::string_view text) {
  std::vector<std::string> out;
  for (size_t i = 0; i < text.size();) {
    size_t end = i;
    while (end < text.size() && is_name_part(text[end])) ++end;
    if (end > i) out.push_back(ir::fold_name(text.substr(i, end - i)));
    i = end + 1;
  }
  return out;
}

class Printer {
 public:
  Printer(bool fbd, Timing timing) : fbd_(fbd), timing_(timing) {}

  std::string run(const Body& body) {
    for (const Headed& headed : with_heads(body)) {
      // In FBD what has no label is drawn together with what stands in front of it.
      if (out_.empty() || !fbd_ || !headed.label.empty() || headed.headed) {
        out_ += std::exchange(comments_, {}) + "network " + ir::fold_name(headed.label) +
                (headed.disabled ? " disabled " : " ") + headed.title + '\n';
        done_ = 0;
        unknown_ = 0;
        written_.clear();
      }
      for (const std::string& comment : headed.comments) add_comment(comment);
      network_ = headed.network;
      if (network_ == nullptr) continue;
      text_.assign(network_->elements.size(), {});
      for (uint32_t i = 0; i < network_->elements.size(); ++i) element(i);
    }
    return out_ + comments_;
  }

 private:
  // By lines: one comment of several may stand in text as several (comment_rows()).
  void add_comment(std::string_view comment) {
    while (true) {
      const size_t end = std::min(comment.find('\n'), comment.size());
      comments_ += "// " + std::string(comment.substr(0, end)) + '\n';
      if (end == comment.size()) return;
      comment.remove_prefix(end + 1);
    }
  }

  void element(uint32_t i) {
    const Element& element = network_->elements[i];
    switch (element.kind) {
      case Kind::kLeftRail:
        text_[i] = fbd_ ? "{TRUE}" : "|";
        break;
      case Kind::kRightRail:
        break;
      case Kind::kSource:
        text_[i] = '{' + expression(element) + '}';
        break;
      case Kind::kContact: {
        std::string own = std::to_string(read_behind(element)) + ' ' + print(element);
        text_[i] = base::to_hex(base::sha256(base::as_bytes(own)));
        break;
      }
      default:
        text_[i] = '#' + std::to_string(++done_);
        out_ += "  " + text_[i] + ' ' + print(element) + '\n';
        note_written(element);
        break;
    }
  }

  uint32_t read_behind(const Element& contact) const;
  void note_written(const Element& element);
  std::string expression(const Element& source) const;
  std::string print(const Element& element) const;
  std::string print(const Input& input) const;
  std::string link(Link link, bool& negated) const;

  const bool fbd_;
  const Timing timing_;
  const Network* network_ = nullptr;
  std::vector<std::string> text_;  // of links to an element
  std::string out_;
  std::string comments_;  // of the network that is being printed
  uint32_t done_ = 0;     // elements that write something
  // With kAsRead: the last of them that wrote a variable, by folded name, or nobody knows what.
  std::unordered_map<std::string, uint32_t> written_;
  uint32_t unknown_ = 0;
};

// The number of the last element that may have written what the contact reads.
uint32_t Printer::read_behind(const Element& contact) const {
  const std::string& operand = contact.operand.text;
  bool plain = operand.find_first_of("^%(#") == std::string::npos;
  if (timing_ == Timing::kExact || !plain) return done_;
  uint32_t behind = unknown_;
  for (const std::string& word : words(operand)) {
    auto at = written_.find(word);
    if (at != written_.end()) behind = std::max(behind, at->second);
  }
  return behind;
}

void Printer::note_written(const Element& element) {
  // After a jump an edge may not see its operand.
  bool leaves = element.kind == Kind::kJump || element.kind == Kind::kReturn;
  if (leaves) unknown_ = done_;
  if (leaves) return;
  const std::string& operand = element.operand.text;
  bool box = element.kind == Kind::kBlock;
  bool move = box && operand.empty() && ir::same_name(element.type.text, "MOVE");
  if (box ? !move : operand.find_first_of("^%(#") != std::string::npos) unknown_ = done_;
  for (const std::string& word : words(operand)) written_[word] = done_;
}

// A wire in it is what it comes from, whatever its name.
std::string Printer::expression(const Element& source) const {
  std::string out;
  for (const OperandPiece& piece : operand_pieces(source)) {
    bool negated = false;
    const std::string text =
        piece.input == nullptr ? normal(piece.text) : link(piece.input->from[0], negated);
    out += (out.empty() || text.empty() ? "" : " ") + std::string(negated ? "!" : "") + text;
  }
  return out;
}

std::string Printer::print(const Element& element) const {
  // What negates a variable that a box writes may stand in front of the variable, too.
  Modifier modifier = element.modifier;
  bool sink = element.kind == Kind::kSink || element.kind == Kind::kCoil;
  Input only = element.inputs.empty() ? Input{} : element.inputs[0];
  if (sink && modifier == Modifier::kNegated && only.modifier <= Modifier::kNegated) {
    bool twice = only.modifier == Modifier::kNegated;
    only.modifier = twice ? Modifier::kNone : Modifier::kNegated;
    modifier = Modifier::kNone;
  }
  std::string out = std::to_string(static_cast<uint32_t>(element.kind)) + ' ' +
                    std::to_string(static_cast<uint32_t>(modifier)) + ' ' +
                    normal(element.operand.text) + " : " + normal(element.type.text);
  if (sink) return out + ' ' + print(only);
  std::string nothing;  // inputs by position that nothing is connected to, unless others follow
  for (const Input& input : element.inputs) {
    if (!input.from.empty()) {
      out += nothing + ' ' + print(input);
      nothing.clear();
    } else if (input.name.empty()) {
      nothing += " <";
    }
  }
  return out;
}

std::string Printer::print(const Input& input) const {
  bool negated = input.modifier == Modifier::kNegated;
  std::vector<std::string> links;
  for (Link from : input.from) {
    bool inverted = false;
    std::string text = link(from, inverted);
    if (inverted && input.from.size() != 1) text = '!' + text;
    if (inverted && input.from.size() == 1) negated = !negated;
    links.push_back(std::move(text));
  }
  std::sort(links.begin(), links.end());
  links.erase(std::unique(links.begin(), links.end()), links.end());
  std::string out = ir::fold_name(input.name) + '<' + (negated ? "!" : "");
  if (input.modifier > Modifier::kNegated) {
    out += '^' + std::to_string(static_cast<uint32_t>(input.modifier));
  }
  for (const std::string& text : links) out += ' ' + text;
  return out;
}

std::string Printer::link(Link link, bool& negated) const {
  const Element& from = network_->elements[link.element];
  std::string operand = normal(from.operand.text);
  const bool source = from.kind == Kind::kSource && from.inputs.empty();
  if (source && ir::same_name(operand.substr(0, 4), "NOT ")) {
    std::string name = operand.substr(4);
    std::erase(name, ' ');
    if (is_plain_name(name)) {  // as a pin that is negated
      negated = true;
      return '{' + operand.substr(4) + '}';
    }
  }
  if (link.output < from.outputs.size()) negated = from.outputs[link.output].negated;
  // An output of a box below is that of the last scan.
  std::string of = text_[link.element].empty() ? '?' + operand : text_[link.element];
  if (from.kind != Kind::kBlock || is_result(from, link.output)) return of;
  return of + '.' + ir::fold_name(from.outputs[link.output].name);
}

}  // namespace

namespace {}  // namespace

std::vector<Headed> with_heads(const Body& body) {
  std::vector<Headed> out;
  Headed next;
  for (const Network& network : body.networks) {
    const bool second_label = !network.label.empty() && !next.label.empty();
    if (second_label || (network.headed && next.headed)) out.push_back(std::exchange(next, {}));
    if (!network.label.empty()) next.label = network.label.text;
    if (network.headed) {
      next.headed = true;
      next.title = network.title;
      next.disabled = network.disabled;
    }
    for (const std::string& comment : network.comments) next.comments.push_back(comment);
    for (const Element& element : network.elements) {
      next.comments.insert(next.comments.end(), element.comments.begin(), element.comments.end());
    }
    if (std::all_of(network.elements.begin(), network.elements.end(), is_rail)) continue;
    next.network = &network;
    out.push_back(std::exchange(next, {}));
  }
  if (!next.label.empty() || !next.comments.empty() || next.headed) out.push_back(std::move(next));
  return out;
}

std::string canonical(const Body& body, Timing timing) {
  return Printer(body.language == Language::kFbd, timing).run(body);
}

}  // namespace frontend::network
