// The text of an export -> its objects.
#include <algorithm>

#include "adapters/text_export/networks.h"
#include "adapters/text_export/scanner.h"
#include "adapters/text_export/text_export.h"
#include "adapters/xml/document.h"
#include "base/name_case.h"
#include "stdlib/registry.h"

namespace text_export {
namespace {

using base::same_name;
using Code = base::DiagnosticCode;

constexpr std::string_view kMarker = "@END_DECLARATION";

bool is_one_of(std::string_view word, std::initializer_list<const char*> words) {
  return std::any_of(words.begin(), words.end(),
                     [word](const char* one) { return same_name(word, one); });
}

bool is_section(std::string_view word) {
  return is_one_of(word,
                   {"VAR", "VAR_INPUT", "VAR_OUTPUT", "VAR_IN_OUT", "VAR_TEMP", "VAR_EXTERNAL"});
}

bool begins_object(std::string_view word) {
  return is_one_of(word, {"PROGRAM", "FUNCTION", "FUNCTION_BLOCK", "ACTION", "TYPE", "VAR_GLOBAL",
                          "VAR_CONFIG"});
}

// Parts of the editor and of devices.
bool is_foreign(std::string_view word) {
  return word.starts_with("_") || is_one_of(word, {"LIBRARY", "PLC_CONFIGURATION", "VISUALISATION",
                                                   "TASKCONFIGURATION", "WATCHLIST"});
}

class Splitter : private Scanner {
 public:
  explicit Splitter(Export& out) : Scanner(out.text), out_(out) {}
  void run();

 private:
  std::string value_of(std::string_view attribute, std::string_view comment) const;

  void attribute();
  void foreign(std::string_view first);
  void pou(std::string_view word);
  void declaration(Object& object);
  void body(Part& body, std::string_view end, const std::string& what);
  void action();
  void type();
  void globals();
  void unknown();
  void library(uint32_t begin);
  void remark(Code code, uint32_t begin, std::string text, std::string fix = {}) {
    out_.remarks.push_back({code, false, {begin, begin}, std::move(text), std::move(fix)});
  }

  Export& out_;
  std::string list_;         // of global variables: the name that the next one has
  bool no_end_var_ = false;  // from here to the end: looked for once
};

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
  const std::string nested = value_of("@NESTEDCOMMENTS", comment);
  if (!nested.empty()) nested_ = !same_name(nested, "No");
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
    if (!is_section(word()) || no_end_var_) return;
    no_end_var_ = !seek_word("END_VAR");
    if (no_end_var_) return;
    word();
    object.declaration.end = at_;
    object.body.begin = at_;
  }
}

// Behind the declaration.
void Splitter::body(Part& body, std::string_view end, const std::string& what) {
  const uint32_t begin = at_;
  skip_blanks_and_comments();
  const bool drawn = is_body_word(rest().substr(0, line_end() - at_));
  if (!drawn) at_ = begin;
  body.begin = at_;
  const bool found = drawn ? seek_line(end) : seek_word(end);
  body.end = at_;
  if (found) {
    word();
    if (!at_end() && text_[at_] == ';') ++at_;
  } else {
    remark(Code::kXmlMissing, body.begin, what + " has no " + std::string(end),
           "the export was cut off: export it again");
  }
}

void Splitter::pou(std::string_view kind) {
  Object object;
  object.kind = Kind::kPou;
  object.nested = nested_;
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
  const uint32_t name = at_;
  if (word().empty()) {  // what is no name is shown as it stands
    while (!at_end() && text_[at_] != ':' && text_[at_] != '\n') ++at_;
  }
  action.name = std::string(text_.substr(name, at_ - name));
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
  object.nested = nested_;
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
  object.nested = nested_;
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
void Splitter::foreign(std::string_view first) {
  const uint32_t begin = at_;
  const std::string own = "END_" + std::string(first);
  for (skip_line(); !at_end(); skip_line()) {
    const std::string_view line = xml::trimmed(text_.substr(at_, line_end() - at_));
    const bool ends =
        same_name(line, own) || (same_name(first, "PLC_CONFIGURATION") && line == "PLC_END");
    if (ends) {
      skip_line();
      break;
    }
    // `FUNCTION_BLOCK Pump`, where a row of the list of a library is `PUMP: 2048`.
    const std::string_view object = line.substr(0, line.find_first_of(" \t:"));
    const bool listed = xml::trimmed(line.substr(object.size())).starts_with(":");
    if (same_name(first, "LIBRARY") && begins_object(object) && !listed) break;
    if (line.starts_with("(* @NESTEDCOMMENTS") || line.starts_with("(* @PATH") ||
        line.starts_with("(* @GLOBAL_VARIABLE_LIST")) {
      break;
    }
  }
  if (same_name(first, "LIBRARY")) {
    library(begin);
  } else {
    remark(Code::kXmlNotUnderstood, begin,
           "`" + std::string(first) + "` begins a part that is not read");
  }
  out_.remarks.back().foreign = true;
}

// Anything else up to the next object: an error, since it may have been one.
void Splitter::unknown() {
  const uint32_t begin = at_;
  const std::string_view line = xml::trimmed(text_.substr(at_, line_end() - at_));
  remark(Code::kXmlBadValue, begin,
         "`" + std::string(line.substr(0, 40)) + "` begins nothing that an export holds",
         "write it into a source of its own");
  for (skip_line(); !at_end(); skip_line()) {
    skip_blanks();
    if (rest().starts_with("(* @")) return;
    const uint32_t row = at_;
    const std::string_view first = word();
    at_ = row;
    if (begins_object(first)) return;
  }
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
    } else if (begins_object(first)) {
      globals();
    } else if (is_foreign(first)) {
      foreign(first);
    } else {
      unknown();
    }
  }
  if (open_comment_) remark(Code::kXmlMissing, *open_comment_, "a comment does not end");
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
