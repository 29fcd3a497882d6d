// The text of an export -> its objects.
#include <algorithm>
#include <optional>

#include "adapters/text_export/text_export.h"
#include "adapters/xml/document.h"
#include "base/name_case.h"
#include "stdlib/registry.h"

namespace text_export {
namespace {

using base::same_name;
using Code = base::DiagnosticCode;

constexpr std::string_view kMarker = "@END_DECLARATION";

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }

bool is_section(std::string_view word) {
  constexpr const char* kSections[] = {"VAR",        "VAR_INPUT", "VAR_OUTPUT",
                                       "VAR_IN_OUT", "VAR_TEMP",  "VAR_EXTERNAL"};
  return std::any_of(std::begin(kSections), std::end(kSections),
                     [word](const char* section) { return same_name(word, section); });
}

class Splitter {
 public:
  explicit Splitter(Export& out) : out_(out), text_(out.text) {}
  void run();

 private:
  bool at_end() const { return at_ >= text_.size(); }
  std::string_view rest() const { return text_.substr(at_); }
  uint32_t line_end() const {
    return static_cast<uint32_t>(std::min(text_.find('\n', at_), text_.size()));
  }
  void skip_line() { at_ = std::min<uint32_t>(line_end() + 1, size()); }
  uint32_t size() const { return static_cast<uint32_t>(text_.size()); }

  void skip_blanks();
  void skip_comment();
  void skip_blanks_and_comments();
  std::string_view word();       // that stands here; takes it
  std::string_view next_word();  // behind what is no word; takes it. Empty: the end
  bool seek_word(std::string_view wanted);
  bool seek_line(std::string_view wanted);
  std::string value_of(std::string_view attribute, std::string_view comment) const;

  void attribute();
  void pou(std::string_view word);
  void declaration(Object& object);
  void body(Part& body, std::string_view end, const std::string& what);
  void action();
  void type();
  void globals();
  void unknown(std::string_view first);
  void library(uint32_t begin);
  void remark(Code code, uint32_t begin, std::string text, std::string fix = {}) {
    out_.remarks.push_back({code, {begin, begin}, std::move(text), std::move(fix)});
  }

  Export& out_;
  std::string_view text_;
  uint32_t at_ = 0;
  std::string list_;  // of global variables: the name that the next one has
};

void Splitter::skip_blanks() {
  while (!at_end() && is_blank(text_[at_])) ++at_;
}

// `(* ... (* ... *) ... *)`: comments nest. One that does not end is all that follows.
void Splitter::skip_comment() {
  uint32_t depth = 0;
  do {
    if (rest().starts_with("(*")) {
      ++depth;
      at_ += 2;
    } else if (rest().starts_with("*)")) {
      --depth;
      at_ += 2;
    } else {
      ++at_;
    }
  } while (depth > 0 && !at_end());
  at_ = std::min(at_, size());
}

void Splitter::skip_blanks_and_comments() {
  for (skip_blanks(); rest().starts_with("(*"); skip_blanks()) skip_comment();
}

std::string_view Splitter::word() {
  const uint32_t begin = at_;
  while (!at_end() && xml::is_name(text_.substr(begin, at_ + 1 - begin))) ++at_;
  return text_.substr(begin, at_ - begin);
}

std::string_view Splitter::next_word() {
  while (!at_end()) {
    if (rest().starts_with("(*")) {
      skip_comment();
      continue;
    }
    const char c = text_[at_];
    if (c == '\'' || c == '"') {  // a text ends in its row, at the latest
      const uint32_t end = line_end();
      for (++at_; at_ < end && text_[at_] != c; ++at_) at_ += text_[at_] == '$' ? 1 : 0;
      at_ = std::min(at_ + 1, size());
      continue;
    }
    // `16#FF`, `T#5s`, `8x`: no words, and not the names inside of them.
    if (const std::string_view found = word(); !found.empty()) return found;
    const bool digit = c >= '0' && c <= '9';
    ++at_;
    while (digit && !at_end() && xml::is_name("_" + std::string(1, text_[at_]))) ++at_;
  }
  return {};
}

// Up to in front of `wanted`.
bool Splitter::seek_word(std::string_view wanted) {
  for (;;) {
    const std::string_view found = next_word();
    if (found.empty()) return false;
    if (!same_name(found, wanted)) continue;
    at_ -= static_cast<uint32_t>(found.size());
    return true;
  }
}

// The same where texts are no Structured Text: `wanted` begins a line, and no comment of a network
// is around it.
bool Splitter::seek_line(std::string_view wanted) {
  bool inside = false;
  for (; !at_end(); skip_line()) {
    const std::string_view line = xml::trimmed(text_.substr(at_, line_end() - at_));
    if (line == "_COMMENT" || line == "_END_COMMENT") inside = line == "_COMMENT";
    const bool whole =
        line.size() <= wanted.size() || !xml::is_name("_" + std::string(1, line[wanted.size()]));
    if (!inside && whole && same_name(line.substr(0, wanted.size()), wanted)) {
      skip_blanks();
      return true;
    }
  }
  return false;
}

// `(* @PATH := '\/Pumps' *)`
std::string Splitter::value_of(std::string_view attribute, std::string_view comment) const {
  const size_t at = comment.find(attribute);
  const size_t from = at == std::string_view::npos ? at : comment.find('\'', at);
  if (from == std::string_view::npos) return {};
  return std::string(comment.substr(from + 1, comment.find('\'', from + 1) - from - 1));
}

// A comment in front of or behind an object.
void Splitter::attribute() {
  const uint32_t begin = at_;
  skip_comment();
  const std::string_view comment = text_.substr(begin, at_ - begin);
  const std::string list = value_of("@GLOBAL_VARIABLE_LIST", comment);
  if (!list.empty()) list_ = list;
}

void Splitter::declaration(Object& object) {
  object.declaration.begin = at_;
  word();
  skip_blanks();
  object.name = std::string(word());
  // The head is one row, with the comments that begin in it.
  while (!at_end() && text_[at_] != '\n') {
    if (rest().starts_with("(*")) {
      skip_comment();
    } else {
      ++at_;
    }
  }
  object.declaration.end = at_;
  object.body.begin = at_;
  for (;;) {
    const uint32_t behind = at_;
    skip_blanks_and_comments();
    const std::string_view between = text_.substr(behind, at_ - behind);
    if (const size_t marker = between.find(kMarker); marker != std::string_view::npos) {
      at_ = behind + static_cast<uint32_t>(between.rfind("(*", marker));
      object.declaration.end = at_;
      skip_comment();
      object.body.begin = at_;
      return;
    }
    const std::string_view section = word();
    if (!is_section(section) || !seek_word("END_VAR")) return;
    word();
    object.declaration.end = at_;
    object.body.begin = at_;
  }
}

// Behind the declaration.
void Splitter::body(Part& body, std::string_view end, const std::string& what) {
  body.begin = at_;
  skip_blanks();
  const bool drawn = rest().starts_with("_") &&
                     rest().substr(0, line_end() - at_).find("_BODY") != std::string_view::npos;
  if (!drawn) at_ = body.begin;
  const bool found = drawn ? seek_line(end) : seek_word(end);
  body.end = at_;
  if (found) {
    word();
  } else {
    remark(Code::kXmlMissing, body.begin, what + " has no " + std::string(end),
           "the export was cut off: export it again");
  }
}

void Splitter::pou(std::string_view kind) {
  Object object;
  object.kind = Kind::kPou;
  object.word = base::same_name(kind, "PROGRAM")    ? "PROGRAM"
                : base::same_name(kind, "FUNCTION") ? "FUNCTION"
                                                    : "FUNCTION_BLOCK";
  declaration(object);
  at_ = object.body.begin;
  body(object.body, "END_" + object.word, object.word + " " + object.name);
  out_.objects.push_back(std::move(object));
}

// Behind the POU that it belongs to.
void Splitter::action() {
  const uint32_t begin = at_;
  word();
  skip_blanks();
  Action action;
  action.name = std::string(word());
  skip_blanks();
  if (!at_end() && text_[at_] == ':') ++at_;
  body(action.body, "END_ACTION", "ACTION " + action.name);
  if (out_.objects.empty() || out_.objects.back().kind != Kind::kPou) {
    remark(Code::kXmlMissing, begin,
           "ACTION " + action.name + " stands behind no POU that it could belong to");
    return;
  }
  out_.objects.back().actions.push_back(std::move(action));
}

void Splitter::type() {
  Object object;
  object.kind = Kind::kType;
  object.declaration.begin = at_;
  word();
  skip_blanks_and_comments();
  object.name = std::string(word());
  if (seek_word("END_TYPE")) {
    word();
  } else {
    remark(Code::kXmlMissing, object.declaration.begin, "TYPE " + object.name + " has no END_TYPE",
           "the export was cut off: export it again");
  }
  object.declaration.end = at_;
  out_.objects.push_back(std::move(object));
}

// One list has several VAR_GLOBAL ... END_VAR.
void Splitter::globals() {
  Object object;
  object.kind = Kind::kGlobals;
  object.name = list_.empty() ? "Global_Variables" : list_;
  object.declaration.begin = at_;
  for (;;) {
    const uint32_t begin = at_;
    if (!same_name(word().substr(0, 4), "VAR_")) {
      at_ = object.declaration.end;
      break;
    }
    if (!seek_word("END_VAR")) {
      remark(Code::kXmlMissing, begin, "the list " + object.name + " has no END_VAR",
             "the export was cut off: export it again");
      object.declaration.end = at_;
      break;
    }
    word();
    object.declaration.end = at_;
    skip_blanks();
    while (rest().starts_with("(*") && !rest().starts_with("(* @")) {
      skip_comment();
      skip_blanks();
    }
  }
  list_.clear();
  out_.objects.push_back(std::move(object));
}

// Configurations of devices, visualisations, libraries: up to their end, or up to the attributes
// of the next object.
void Splitter::unknown(std::string_view first) {
  const uint32_t begin = at_;
  const std::string own = "END_" + std::string(first);
  for (skip_line(); !at_end(); skip_line()) {
    const std::string_view line = xml::trimmed(text_.substr(at_, line_end() - at_));
    const bool ends = same_name(line, own) || (first == "PLC_CONFIGURATION" && line == "PLC_END");
    if (ends) {
      skip_line();
      break;
    }
    if (line.starts_with("(* @NESTEDCOMMENTS") || line.starts_with("(* @PATH") ||
        line.starts_with("(* @GLOBAL_VARIABLE_LIST")) {
      break;
    }
  }
  if (same_name(first, "LIBRARY")) return library(begin);
  remark(Code::kXmlNotUnderstood, begin,
         "`" + std::string(first) + "` begins a part that is not read");
}

// `Standard.lib 5.6.98 12:03:02`, behind LIBRARY, and the names of what is in it.
void Splitter::library(uint32_t begin) {
  const size_t row = std::min(text_.find('\n', begin), text_.size());
  std::string_view name = xml::trimmed(text_.substr(row, text_.find('\n', row + 1) - row));
  name = name.substr(0, name.find(' '));
  if (stdlib::is_vendor_library(name.substr(0, name.rfind('.')))) {
    remark(Code::kXmlLeftOut, begin, "the library `" + std::string(name) + "` is part of stc");
    return;
  }
  remark(Code::kXmlNotUnderstood, begin,
         "the library `" + std::string(name) + "` is used, and its text is not in the export",
         "export the library, too, and import both together");
}

void Splitter::run() {
  for (skip_blanks(); !at_end(); skip_blanks()) {
    if (rest().starts_with("(*")) {
      attribute();
      continue;
    }
    const uint32_t begin = at_;
    const std::string_view first = word();
    at_ = begin;
    if (same_name(first, "PROGRAM") || same_name(first, "FUNCTION") ||
        same_name(first, "FUNCTION_BLOCK")) {
      pou(first);
    } else if (same_name(first, "ACTION")) {
      action();
    } else if (same_name(first, "TYPE")) {
      type();
    } else if (same_name(first, "VAR_GLOBAL") || same_name(first, "VAR_CONFIG")) {
      globals();
    } else {
      const std::string_view line = xml::trimmed(text_.substr(at_, line_end() - at_));
      unknown(first.empty() ? line.substr(0, 40) : first);
    }
  }
}

}  // namespace

Export split(std::string_view text, base::SourcePos begin) {
  Export out;
  out.text = text;
  out.begin = begin;
  Splitter(out).run();
  return out;
}

void add_pins(const Export& from, PinNames& pins) {
  for (const Object& object : from.objects) {
    if (object.word == "FUNCTION_BLOCK") pins.add(from.of(object.declaration));
  }
}

}  // namespace text_export
