// The objects of an export -> sources.
#include <algorithm>

#include "adapters/text_export/networks.h"
#include "adapters/text_export/text_export.h"
#include "adapters/text_export/tree.h"
#include "adapters/xml/diagram_text.h"
#include "adapters/xml/document.h"

namespace text_export {
namespace {

using Code = base::DiagnosticCode;

constexpr const char* kIndent = "  ";

// Comments nest here: where they did not, `(* a (* b *)` becomes `(* a ( * b *)`.
std::string with_flat_comments(std::string_view text) {
  std::string out;
  bool inside = false;
  for (size_t at = 0; at < text.size(); ++at) {
    const std::string_view two = text.substr(at, 2);
    if (!inside && (text[at] == '\'' || text[at] == '"')) {  // a text ends in its row
      const char quote = text[at];
      do {
        out += text[at];
        if (text[at] == '$' && at + 1 < text.size()) out += text[++at];
        ++at;
      } while (at < text.size() && text[at] != quote && text[at] != '\n');
      if (at < text.size()) out += text[at];
    } else if (two == "(*" && inside) {
      out += "( ";
    } else if (two == "(*" || (two == "*)" && inside)) {
      inside = two == "(*";
      out += two;
      ++at;
    } else {
      out += text[at];
    }
  }
  return out;
}

class Writer {
 public:
  Writer(const Export& from, const PinNames& pins, xml::Imported& out)
      : from_(from), pins_(pins), out_(out) {}

  void run();

 private:
  void report(Code code, uint32_t at, uint32_t network, std::string text, std::string fix);
  std::string text(Part part, bool nested) const;
  std::string body(const Object& object, Part part, const std::string& what);
  std::string drawing(const Object& object, Part part, const std::string& what);
  std::string pou(const Object& object);

  const Export& from_;
  const PinNames& pins_;
  xml::Imported& out_;
  std::string pou_;
  size_t links_ = 0;  // of all drawings
};

void Writer::report(Code code, uint32_t at, uint32_t network, std::string text, std::string fix) {
  const base::SourcePos place{from_.begin.offset +
                              std::min<uint32_t>(at, static_cast<uint32_t>(from_.text.size()))};
  out_.add_finding({code, {place, place}, pou_, network, std::move(text), std::move(fix)});
}

// Rows end in LF, without blanks at their end or empty rows around.
std::string Writer::text(Part part, bool nested) const {
  const std::string whole =
      nested ? std::string(from_.of(part)) : with_flat_comments(from_.of(part));
  std::string_view rest = whole;
  while (!rest.empty() && xml::trimmed(rest.substr(0, rest.find('\n'))).empty()) {
    if (rest.find('\n') == std::string_view::npos) return {};
    rest.remove_prefix(rest.find('\n') + 1);
  }
  std::string out = xml::indented(rest, "");
  while (out.ends_with("\n\n")) out.pop_back();
  return out;
}

std::string Writer::drawing(const Object& object, Part part, const std::string& what) {
  const auto add = [&](Code code, uint32_t at, uint32_t network, std::string message,
                       std::string fix) {
    report(code, part.begin + at, network, std::move(message), std::move(fix));
  };
  const std::string_view word = word_of_form(from_.of(object.declaration));
  if (!word.empty()) {
    report(Code::kXmlBody, part.begin, 0,
           "the body of " + what + ": a variable is called `" + std::string(word) +
               "`, which is a word of the form",
           "rename it where the export was made");
  }
  const auto made =
      word.empty() ? read_networks(from_.of(part), what, pins_, add, links_) : std::nullopt;
  if (!made) return "{error 'the body of " + what + " was not imported'}\n";
  if (made->networks.empty()) return {};
  return xml::diagram_text(*made, from_.of(object.declaration),
                           [&](uint32_t network, const std::string& why) {
                             report(Code::kLadderAsFbd, part.begin, network, why, {});
                           })
      .text;
}

std::string Writer::body(const Object& object, Part part, const std::string& what) {
  if (is_drawn(from_.of(part))) return drawing(object, part, what);
  return text(part, object.nested);
}

std::string Writer::pou(const Object& object) {
  std::string out = text(object.declaration, object.nested);
  for (const Action& action : object.actions) {
    if (!xml::is_name(action.name)) {
      report(Code::kXmlBadValue, action.body.begin, 0,
             "an action is called `" + action.name + "`, which is no name", {});
      continue;
    }
    out += "\n" + std::string(kIndent) + "ACTION " + action.name + ":\n" +
           xml::indented(body(object, action.body, "action " + action.name), kIndent) +
           std::string(kIndent) + "END_ACTION\n";
  }
  const std::string statements = body(object, object.body, object.name);
  if (!statements.empty()) out += "\n" + statements;
  return out + "END_" + object.word + "\n";
}

void Writer::run() {
  for (const Remark& remark : from_.remarks) {
    report(remark.code, remark.place.begin, 0, remark.text, remark.fix);
  }
  for (const Object& object : from_.objects) {
    const bool list = object.kind == Kind::kGlobals;
    // A list may have any name; nothing in V2.3 says it.
    const std::string name = list ? xml::as_name(object.name) : object.name;
    if (!xml::is_name(name)) {
      report(Code::kXmlBadValue, object.declaration.begin, 0,
             "`" + object.name + "` is no name of Structured Text", {});
      continue;
    }
    pou_ = list ? std::string() : name;
    out_.add_source(
        name, object.kind == Kind::kPou ? pou(object) : text(object.declaration, object.nested));
    pou_.clear();
  }
  if (from_.objects.empty() && !out_.failed()) {
    report(Code::kUnknownXml, 0, 0,
           "there is no PROGRAM, FUNCTION_BLOCK, FUNCTION, TYPE or VAR_GLOBAL in this export", {});
  }
}

}  // namespace

bool is_more_than_text(const Export& of) {
  const auto drawn = [&of](Part body) { return is_drawn(of.of(body)); };
  const auto in_own_way = [&](const Object& object) {
    if (drawn(object.body)) return true;
    const auto is_one = [&](Part part) {
      return !object.nested && with_flat_comments(of.of(part)) != of.of(part);
    };
    return is_one(object.declaration) || is_one(object.body) ||
           std::any_of(object.actions.begin(), object.actions.end(), [&](const Action& action) {
             return drawn(action.body) || is_one(action.body);
           });
  };
  return std::any_of(of.remarks.begin(), of.remarks.end(),
                     [](const Remark& one) { return one.foreign; }) ||
         std::any_of(of.objects.begin(), of.objects.end(), in_own_way);
}

void import(const Export& from, const PinNames& pins, xml::Imported& out) {
  Writer(from, pins, out).run();
}

}  // namespace text_export
