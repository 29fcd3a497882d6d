// One XML document, safe to walk: of limited size and depth, in UTF-8 whatever it was in. Its
// text stands in a SourceMap (kQuoted), so every node has a place that messages can show.
// Elements are found by their local name: `ppx:Variable` and `Variable` are the same, because
// tools declare the namespaces as they like.
#pragma once

#include <functional>
#include <optional>
#include <pugixml.hpp>
#include <set>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "adapters/xml/diagram_text.h"
#include "adapters/xml/imported.h"
#include "base/name_case.h"
#include "base/result.h"

namespace xml {

using Node = pugi::xml_node;
using Code = base::DiagnosticCode;

// UTF-8 of bytes in UTF-8, UTF-16, ISO-8859-1 or windows-1252, by byte order mark, first bytes and
// declaration. A file in UTF-8 that declares UTF-16 is taken for what it is: that is what comes
// out of text writers. Errors: the text says which byte or encoding.
struct Decoded {
  std::string text;   // without byte order mark
  std::string error;  // empty: none
};
Decoded to_utf8(std::string_view bytes);
// Bytes that are no UTF-8 are read as windows-1252, as the compiler reads sources.
std::string as_utf8(std::string_view bytes);
// UTF-8 of a text that declares nothing: UTF-8, or else windows-1252. NUL becomes a blank.
std::string text_as_utf8(std::string_view bytes);

// How documents and parts of them are parsed.
inline constexpr unsigned kAsRead = pugi::parse_default | pugi::parse_ws_pcdata_single;

class Document {
 public:
  // Adds the text to `sources` under `name` and parses it. What is wrong becomes a finding of
  // `out` (E1070, E1072); root() is empty then.
  Document(std::string name, std::string_view bytes, base::SourceMap& sources, Imported& out);

  Node root() const { return root_; }
  // Where the element's name stands, or the text of another node.
  base::SourceSpan span(Node node) const;

 private:
  bool parse(const std::string& text, Imported& out);
  bool within_depth(Imported& out);

  pugi::xml_document parsed_;
  Node root_;
  base::SourcePos begin_;
  size_t size_ = 0;
};

// What is inside of it stands in the POU or network named so.
class Reporter {
 public:
  Reporter(const Document& document, Imported& out) : document_(document), out_(out) {}

  void add(Code code, Node at, std::string text, std::string fix = {});
  // Nodes that were made of others stand where these do.
  void set_origins(const std::unordered_map<const void*, Node>* origins) { origins_ = origins; }
  Node origin(Node node) const;
  // VAR_IN_OUT of the document's POUs, `pou.name` as folded names; null: none is known.
  void set_in_outs(const std::set<std::string>* in_outs) { in_outs_ = in_outs; }
  bool is_in_out(std::string_view pou, std::string_view name) const {
    return in_outs_ != nullptr &&
           in_outs_->count(base::fold_name(pou) + "." + base::fold_name(name));
  }
  void set_pou(std::string pou) { pou_ = std::move(pou), network_ = 0; }
  const std::string& pou() const { return pou_; }
  void set_network(uint32_t network) { network_ = network; }
  // For diagram_text(): adds W0075 at `drawing`.
  AsFbd as_fbd(Node drawing);
  // An attribute that has to be there; empty, after a report, when it is not.
  std::string_view required(Node node, const char* attribute);
  // The same for an attribute that is a name of Structured Text.
  std::string_view required_name(Node node, const char* attribute = "name");

  // Takes declarations in the place of sources of their own; null: none does.
  using Taker = std::function<bool(Node element, const std::string& name, std::string& text)>;
  void set_taker(const Taker* taker) { taker_ = taker; }
  bool take(Node element, const std::string& name, std::string& text) const {
    return taker_ != nullptr && (*taker_)(element, name, text);
  }

  const Document& document() const { return document_; }
  Imported& out() { return out_; }

 private:
  const Document& document_;
  Imported& out_;
  const std::unordered_map<const void*, Node>* origins_ = nullptr;
  const std::set<std::string>* in_outs_ = nullptr;
  const Taker* taker_ = nullptr;
  std::string pou_;
  uint32_t network_ = 0;
};

// --- walking
std::string_view local_name(Node node);
std::string_view local_name(std::string_view name);  // after the last `:`
bool is(Node node, std::string_view name);
Node child(Node node, std::string_view name);
// `names`: child of child ...
Node find(Node node, std::initializer_list<std::string_view> names);
std::vector<Node> children(Node node);  // elements
std::vector<Node> children(Node node, std::string_view name);
Node first_element(Node node);
std::string_view attribute(Node node, std::string_view name);  // by local name; empty: none
// xsd:boolean; nullopt: neither
std::optional<bool> boolean(std::string_view text);

// All text below, in order: paragraphs and `br` end lines. Empty lines at both ends are dropped.
std::string text_of(Node node);
std::string_view trimmed(std::string_view text);

// Letters, digits and `_`, as the lexer takes them (frontend/lex/characters.h).
bool is_name(std::string_view text);
// `text` as such a name: other characters become `_`.
std::string as_name(std::string_view text);
// `(* text *)`, which nothing in `text` ends.
std::string comment(std::string_view text, std::string_view indent);
// The lines of `text`, each after `indent` unless empty, each ended.
std::string indented(std::string_view text, std::string_view indent);
// How a message shows the element: <variable name="x">
std::string shown(Node node);

}  // namespace xml
