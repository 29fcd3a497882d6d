#include "adapters/text_export/tree.h"

#include <algorithm>
#include <charconv>

#include "adapters/xml/document.h"
#include "base/limits.h"
#include "frontend/lex/characters.h"

namespace text_export {
namespace {

constexpr const char* kWords[] = {"_NETWORK",       "_LD_ASSIGN", "_LD_CONTACT", "_LD_AND",
                                  "_LD_OR",         "_ASSIGN",    "_OPERAND",    "_FUNCTION",
                                  "_FUNCTIONBLOCK", "_OPERATOR",  "_EMPTY",      "_EXPRESSION",
                                  "_OUTPUT",        "_ENABLED",   "_COMMENT",    "ENABLELIST_END"};

bool is_word(std::string_view line) {
  return std::find(std::begin(kWords), std::end(kWords), line) != std::end(kWords);
}

class Lines {
 public:
  Lines(std::string_view text, Drawn& out) : text_(text), out_(out) {}

  bool run();

 private:
  bool good() const { return out_.problem.empty(); }
  bool fail(std::string text);
  bool at_end() const { return at_ >= text_.size(); }
  std::string_view line() const;  // that stands here, without blanks around it
  void skip();
  std::string_view peek();  // behind empty lines
  std::string_view take();
  bool accept(std::string_view word);
  bool expect(std::string_view word);
  std::string_view operand();  // the line as it is; empty when a word stands in its place
  uint32_t count(std::string_view word);  // `word : n`

  bool network();
  void comment(DrawnNetwork& network);
  Tree tree();
  void box(Tree& out);
  void parts(Tree& out, uint32_t number);
  std::vector<End> ends();
  bool sign();  // negated?

  std::string_view text_;
  Drawn& out_;
  size_t at_ = 0;
  uint32_t depth_ = 0;
};

bool Lines::fail(std::string text) {
  if (!good()) return false;
  out_.problem = std::move(text);
  out_.problem_at = static_cast<uint32_t>(std::min(at_, text_.size()));
  out_.problem_network = static_cast<uint32_t>(out_.networks.size());
  return false;
}

std::string_view Lines::line() const {
  return xml::trimmed(text_.substr(at_, std::min(text_.find('\n', at_), text_.size()) - at_));
}

void Lines::skip() { at_ = std::min(text_.find('\n', at_), text_.size() - 1) + 1; }

std::string_view Lines::peek() {
  while (!at_end() && line().empty()) skip();
  return at_end() ? std::string_view() : line();
}

std::string_view Lines::take() {
  const std::string_view out = peek();
  if (!at_end()) skip();
  return out;
}

bool Lines::accept(std::string_view word) {
  if (peek() != word) return false;
  skip();
  return true;
}

bool Lines::expect(std::string_view word) {
  if (accept(word)) return true;
  const std::string found(peek().substr(0, 60));
  return fail("`" + (found.empty() ? std::string("the end") : found) + "` stands where `" +
              std::string(word) + "` is expected");
}

std::string_view Lines::operand() {
  if (at_end() || is_word(line())) return {};
  const std::string_view out = line();
  skip();
  return out;
}

uint32_t Lines::count(std::string_view word) {
  const std::string_view found = peek();
  std::string_view rest = found.substr(std::min(word.size(), found.size()));
  rest = xml::trimmed(rest);
  if (!found.starts_with(word) || !rest.starts_with(":")) {
    expect(word);
    return 0;
  }
  rest = xml::trimmed(rest.substr(1));
  uint32_t out = 0;
  const auto [end, error] = std::from_chars(rest.data(), rest.data() + rest.size(), out);
  // Each of them takes a line, so more than there is text are a mistake.
  if (error != std::errc() || out > text_.size())
    fail("`" + std::string(found) + "` has no number");
  if (good()) skip();
  return good() ? out : 0;
}

bool Lines::sign() {
  if (accept("_POSITIV")) return false;
  return expect("_NEGATIV");
}

std::vector<End> Lines::ends() {
  std::vector<End> out;
  for (uint32_t number = count("_OUTPUTS"); number > 0 && good(); --number) {
    End end;
    peek();
    end.at = static_cast<uint32_t>(at_);
    expect("_OUTPUT");
    end.negated = sign();
    end.set = !accept("_NO_SET") && expect("_SET");
    if (!accept("_EMPTY")) end.name = operand();
    out.push_back(end);
  }
  return out;
}

void Lines::parts(Tree& out, uint32_t number) {
  for (; number > 0 && good(); --number) out.parts.push_back(tree());
}

void Lines::box(Tree& out) {
  out.shape = Shape::kBox;
  const std::string_view word = take();
  out.instance = word == "_FUNCTIONBLOCK";
  if (out.instance) out.owner = operand();
  const uint32_t number = count("_BOX_EXPR");
  out.enabled = accept("_ENABLED");
  parts(out, number);
  expect("_EXPRESSION");
  out.negated = sign();
  out.text = operand();
  if (out.instance) out.ends = ends();
}

Tree Lines::tree() {
  Tree out;
  const std::string_view word = peek();
  out.at = static_cast<uint32_t>(at_);
  if (++depth_ > base::kMaxXmlDepth) {
    fail("its elements are nested deeper than " + std::to_string(base::kMaxXmlDepth) + " levels");
  }
  if (!good()) return out;
  if (word == "_EMPTY") {
    take();
  } else if (word == "_LD_CONTACT") {
    take();
    out.shape = Shape::kContact;
    out.text = operand();
    expect("_EXPRESSION");
    out.negated = sign();
  } else if (word == "_OPERAND") {
    take();
    out.shape = Shape::kOperand;
    expect("_EXPRESSION");
    out.negated = sign();
    out.text = operand();
  } else if (word == "_LD_AND" || word == "_LD_OR") {
    take();
    out.shape = word == "_LD_AND" ? Shape::kAnd : Shape::kOr;
    parts(out, count("_LD_OPERATOR"));
    expect("_EXPRESSION");
    out.negated = sign();
  } else if (word == "_FUNCTIONBLOCK" || word == "_FUNCTION" || word == "_OPERATOR") {
    box(out);
  } else if (word == "_ASSIGN") {
    take();
    out.shape = Shape::kAssign;
    out.parts.push_back(tree());
    expect("_EXPRESSION");
    out.negated = sign();
    out.ends = ends();
  } else {
    fail("an element `" + std::string(word.substr(0, 60)) + "` is not known here");
  }
  --depth_;
  return out;
}

// A text in ', which may have several lines.
void Lines::comment(DrawnNetwork& network) {
  if (!accept("_COMMENT")) return;
  std::string text;
  for (; !at_end() && !(line() == "_END_COMMENT" && text.ends_with('\'')); skip()) {
    text += text.empty() ? "" : "\n";
    text += line();
  }
  if (text.size() < 2 || text.front() != '\'') fail("a comment is no text in '");
  expect("_END_COMMENT");
  std::string_view inside = text;
  if (inside.starts_with("'")) inside.remove_prefix(1);
  if (inside.ends_with("'")) inside.remove_suffix(1);
  while (!inside.empty()) {
    const size_t end = std::min(inside.find('\n'), inside.size());
    const std::string_view one = xml::trimmed(inside.substr(0, end));
    if (!one.empty()) network.comments.emplace_back(one);
    inside.remove_prefix(std::min(end + 1, inside.size()));
  }
}

bool Lines::network() {
  DrawnNetwork& out = out_.networks.emplace_back();
  peek();
  out.at = static_cast<uint32_t>(at_);
  if (!expect("_NETWORK")) return false;
  out.label = operand();
  comment(out);
  if (accept("_LD_ASSIGN")) {
    out.ladder = true;
    Tree& rung = out.trees.emplace_back();
    rung.shape = Shape::kAssign;
    rung.at = out.at;
    rung.parts.push_back(tree());
    expect("_EXPRESSION");
    rung.negated = sign();
    for (uint32_t number = count("ENABLELIST"); number > 0 && good(); --number) {
      out.enabled.push_back(tree());
    }
    expect("ENABLELIST_END");
    rung.ends = ends();
    return good();
  }
  while (good() && !at_end() && !peek().empty() && peek() != "_NETWORK") {
    out.trees.push_back(tree());
  }
  return good();
}

bool Lines::run() {
  std::string_view head = peek();  // a comment may stand behind it
  head = head.substr(0, head.find_first_of(" \t("));
  out_.ladder = head == "_LD_BODY";
  if (!out_.ladder && head != "_FBD_BODY") {
    return fail("`" + std::string(head.substr(0, 60)) +
                "` begins a language that is not read here");
  }
  skip();
  peek();
  const size_t begin = at_;
  const uint32_t number = count("_NETWORKS");
  while (good() && !peek().empty()) {
    if (!network()) return false;
  }
  if (!good() || out_.networks.size() == number) return good();
  at_ = begin;
  fail("it says that it has " + std::to_string(number) + " networks, and has " +
       std::to_string(out_.networks.size()));
  out_.problem_network = 0;
  return false;
}

}  // namespace

std::string_view word_of_form(std::string_view declaration) {
  for (size_t at = 0; at < declaration.size();) {
    size_t end = at;
    while (end < declaration.size() && frontend::is_name_part(declaration[end])) ++end;
    if (is_word(declaration.substr(at, end - at))) return declaration.substr(at, end - at);
    at = std::max(end, at + 1);
  }
  return {};
}

Drawn read_trees(std::string_view body) {
  Drawn out;
  Lines(body, out).run();
  return out;
}

}  // namespace text_export
