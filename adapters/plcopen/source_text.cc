#include "adapters/plcopen/source_text.h"

#include <algorithm>

#include "base/hash.h"
#include "frontend/lex/characters.h"
#include "frontend/lex/lexer.h"

namespace plcopen {

using frontend::Token;
using frontend::TokenKind;
using xml::Node;

namespace {

bool is_data(Node node, const char* name) {
  return (xml::is(node, "data") || xml::is(node, "Data")) && xml::attribute(node, "name") == name;
}

bool is_add_data(Node node) { return xml::is(node, "addData") || xml::is(node, "AddData"); }

// The <data> of that name that belongs to `owner`.
Node data_of(Node owner, const char* name) {
  for (Node add : owner) {
    if (!is_add_data(add)) continue;
    for (Node data : add) {
      if (is_data(data, name)) return data;
    }
  }
  return {};
}

Node part_of(Node element) { return xml::child(data_of(element, kPartData), "part"); }

// In the project's own addData, or where IEC 61131-10 keeps it.
Node sources_of(Node root) {
  for (Node owner : {root, xml::child(root, "ContentHeader")}) {
    if (Node data = data_of(owner, kSourcesData)) return xml::child(data, "sources");
  }
  return {};
}

uint64_t number_of(Node part) { return part.attribute("number").as_ullong(); }

std::string raw_text(Node node) {
  std::string out;
  for (Node below : node) {
    if (below.type() == pugi::node_pcdata || below.type() == pugi::node_cdata) out += below.value();
  }
  return out;
}

// Tools break lines of text as they like.
void add_words(std::string_view text, std::string& out) {
  for (char c : text) {
    if (!frontend::is_space(c)) {
      out += c;
    } else if (!out.empty() && out.back() != ' ') {
      out += ' ';
    }
  }
  out += '\n';
}

std::string hash_of(std::string_view text) {
  std::string words;
  add_words(text, words);
  return base::short_hex(base::sha256(base::as_bytes(words)));
}

// What an element says, without elements inside of it that are parts of their own. The depth of a
// document is limited.
void add_element(Node node, std::string& out) {
  out += '<';
  out += xml::local_name(node);
  for (pugi::xml_attribute each : node.attributes()) {
    if (std::string_view(each.name()).starts_with("xmlns")) continue;
    out += ' ' + std::string(xml::local_name(std::string_view(each.name()))) + '=';
    add_words(xml::as_utf8(each.value()), out);
  }
  out += '>';
  for (Node below : node) {
    if (below.type() == pugi::node_pcdata || below.type() == pugi::node_cdata) {
      const std::string text = xml::as_utf8(below.value());
      if (!xml::trimmed(text).empty()) add_words(xml::trimmed(text), out);
    } else if (below.type() == pugi::node_element && !is_source_data(below) && !part_of(below)) {
      add_element(below, out);
    }
  }
  out += "</>";
}

std::string digest_of(Node element, const std::string& text_hash) {
  std::string all = text_hash;
  add_element(element, all);
  return base::short_hex(base::sha256(base::as_bytes(all)));
}

}  // namespace

bool is_source_data(Node data) { return is_data(data, kSourcesData) || is_data(data, kPartData); }

// --- writing

namespace {

struct UnitForm {
  TokenKind begin;
  TokenKind end;
};
constexpr UnitForm kUnitForms[] = {{TokenKind::kProgram, TokenKind::kEndProgram},
                                   {TokenKind::kFunction, TokenKind::kEndFunction},
                                   {TokenKind::kFunctionBlock, TokenKind::kEndFunctionBlock},
                                   {TokenKind::kType, TokenKind::kEndType},
                                   {TokenKind::kVarGlobal, TokenKind::kEndVar},
                                   {TokenKind::kVarConfig, TokenKind::kEndVar},
                                   {TokenKind::kConfiguration, TokenKind::kEndConfiguration},
                                   {TokenKind::kClass, TokenKind::kEndClass},
                                   {TokenKind::kInterface, TokenKind::kEndInterface},
                                   {TokenKind::kNamespace, TokenKind::kEndNamespace},
                                   {TokenKind::kMockFunction, TokenKind::kEndMockFunction},
                                   {TokenKind::kSetup, TokenKind::kEndSetup},
                                   {TokenKind::kTeardown, TokenKind::kEndTeardown},
                                   {TokenKind::kTest, TokenKind::kEndTest}};

const UnitForm* form_at(const Token& token) {
  for (const UnitForm& form : kUnitForms) {
    if (form.begin == token.kind) return &form;
  }
  return nullptr;
}

// The last token of the declaration that begins at `i`, with its semicolon.
size_t end_of_declaration(const std::vector<Token>& tokens, size_t i, const UnitForm& form) {
  size_t depth = 0;
  for (; tokens[i].kind != TokenKind::kEnd; ++i) {
    if (form.begin == TokenKind::kNamespace && tokens[i].kind == form.begin) ++depth;
    if (tokens[i].kind != form.end) continue;
    if (depth > 1) {
      --depth;
      continue;
    }
    return tokens[i + 1].kind == TokenKind::kSemicolon ? i + 1 : i;
  }
  return i - 1;
}

// Attributes in front of a declaration belong to it, and the comment that elements take for its
// documentation.
size_t begin_with_head(std::string_view text, size_t from, size_t begin) {
  for (;;) {
    std::string_view before = text.substr(from, begin - from);
    while (!before.empty() && frontend::is_space(before.back())) before.remove_suffix(1);
    const bool comment = before.ends_with("*)");
    if (!comment && !before.ends_with("}")) return begin;
    const size_t open = comment ? before.rfind("(*") : before.rfind('{');
    if (open == std::string_view::npos) return begin;
    if (!comment && !before.substr(open).starts_with("{attribute")) return begin;
    begin = from + open;
    if (comment) return begin;
  }
}

}  // namespace

SourceParts::SourceParts(const base::SourceMap& sources) {
  for (uint32_t file = 0; file < sources.file_count(); ++file) {
    if (!sources.is_source(file)) continue;
    std::string_view name = sources.file_name(file);
    name.remove_prefix(name.find_last_of("/\\") + 1);
    sources_.push_back(
        {std::string(name.substr(0, name.rfind('.'))), sources.begin(file).offset, {}});
    cut(sources.text(file), sources.begin(file).offset, sources_.back());
  }
}

void SourceParts::cut(std::string_view text, uint32_t begin, Source& out) {
  base::Diagnostics unheard;
  const std::vector<Token> tokens = frontend::lex(text, {0}, unheard).tokens;
  size_t from = 0;
  auto add = [&](size_t to, uint32_t number) {
    if (to <= from) return;
    out.parts.push_back(
        {begin + static_cast<uint32_t>(from), number, xml::as_utf8(text.substr(from, to - from))});
    from = to;
  };
  for (size_t i = 0; tokens[i].kind != TokenKind::kEnd; ++i) {
    const UnitForm* form = form_at(tokens[i]);
    if (form == nullptr) continue;
    add(begin_with_head(text, from, tokens[i].begin), 0);
    i = end_of_declaration(tokens, i, *form);
    add(tokens[i].begin + tokens[i].length, ++last_);
  }
  add(text.size(), 0);
}

uint32_t SourceParts::number_at(base::SourcePos at) const {
  auto source =
      std::upper_bound(sources_.begin(), sources_.end(), at.offset,
                       [](uint32_t offset, const Source& each) { return offset < each.begin; });
  if (source == sources_.begin()) return 0;
  const std::vector<Part>& parts = (source - 1)->parts;
  auto found =
      std::upper_bound(parts.begin(), parts.end(), at.offset,
                       [](uint32_t offset, const Part& part) { return offset < part.begin; });
  return found == parts.begin() ? 0 : (found - 1)->number;
}

void SourceParts::mark_partial(base::SourcePos at) { partial_.insert(number_at(at)); }

void SourceParts::tag(Node element, base::SourcePos at) const {
  const uint32_t number = number_at(at);
  if (number == 0) return;
  Node add = element.child("addData");
  if (!add) add = element.append_child("addData");
  Node data = add.append_child("data");
  data.append_attribute("name") = kPartData;
  data.append_attribute("handleUnknown") = "implementation";
  data.append_child("part").append_attribute("number") = number;
}

void SourceParts::put(Node project) const {
  Node add = project.child("addData");
  if (!add) add = project.append_child("addData");
  Node data = add.append_child("data");
  data.append_attribute("name") = kSourcesData;
  data.append_attribute("handleUnknown") = "implementation";
  Node all = data.append_child("sources");
  for (const Source& source : sources_) {
    Node own = all.append_child("source");
    own.append_attribute("name") = xml::as_utf8(source.name).c_str();
    for (const Part& part : source.parts) {
      Node node = own.append_child("part");
      if (part.number != 0) node.append_attribute("number") = part.number;
      node.append_child(pugi::node_pcdata).set_value(part.text.c_str());
    }
  }
}

void SourceParts::seal(Node root) const {
  std::map<uint64_t, std::pair<Node, uint32_t>> parts;
  for (Node source : xml::children(sources_of(root))) {
    for (Node part : xml::children(source)) {
      if (number_of(part) != 0) parts[number_of(part)] = {part, 0};
    }
  }
  std::vector<Node> todo = {root};
  while (!todo.empty()) {
    const Node node = todo.back();
    todo.pop_back();
    for (Node below : xml::children(node)) todo.push_back(below);
    Node part = part_of(node);
    auto found = parts.find(number_of(part));
    if (!part || found == parts.end()) continue;
    ++found->second.second;
    part.append_attribute("digest") =
        digest_of(node, hash_of(raw_text(found->second.first))).c_str();
  }
  for (auto& [number, part] : parts) {
    part.first.append_attribute("elements") = part.second;
    if (partial_.count(number) != 0) part.first.append_attribute("partial") = "true";
  }
}

// --- reading

SourceTexts::SourceTexts(Node root, xml::Imported& out) {
  for (Node source : xml::children(sources_of(root), "source")) {
    const std::string name = xml::as_name(xml::attribute(source, "name"));
    sources_.push_back({source, out.names.take(name)});
    for (Node node : xml::children(source, "part")) {
      Part part;
      part.node = node;
      part.elements = node.attribute("elements").as_uint();
      if (number_of(node) == 0 || part.elements == 0) continue;
      part.hash = hash_of(raw_text(node));
      parts_.emplace(number_of(node), std::move(part));
    }
  }
}

namespace {

// Where the next element begins that is not inside of this one.
uint32_t end_of(const xml::Document& document, Node element) {
  for (Node at = element; at; at = at.parent()) {
    for (Node next = at.next_sibling(); next; next = next.next_sibling()) {
      if (next.type() == pugi::node_element) return document.span(next).begin.offset;
    }
  }
  return 0xffffffffu;
}

}  // namespace

bool SourceTexts::take(const xml::Document& document, Node element, const std::string& name,
                       std::string& text) {
  Node own = part_of(element);
  auto found = parts_.find(number_of(own));
  if (!own || found == parts_.end()) return false;
  Part& part = found->second;
  extents_.push_back({document.span(element).begin.offset, end_of(document, element), &part});
  if (xml::attribute(own, "digest") == digest_of(element, part.hash)) {
    ++part.same;
  } else {
    part.names += (part.names.empty() ? "`" : ", `") + name + "`";
  }
  part.found += std::move(text);
  return true;
}

void SourceTexts::drop_findings(xml::Imported& out) {
  std::vector<size_t> order(out.findings.size());
  for (size_t i = 0; i < order.size(); ++i) order[i] = i;
  auto place = [&](size_t i) { return out.findings[i].span.begin.offset; };
  std::stable_sort(order.begin(), order.end(),
                   [&](size_t a, size_t b) { return place(a) < place(b); });
  std::sort(extents_.begin(), extents_.end(),
            [](const Extent& a, const Extent& b) { return a.begin < b.begin; });
  std::vector<bool> dropped(order.size());
  std::vector<Extent> around;  // the innermost one last
  size_t next = 0;
  for (size_t i : order) {
    while (next < extents_.size() && extents_[next].begin <= place(i)) {
      while (!around.empty() && around.back().end <= extents_[next].begin) around.pop_back();
      around.push_back(extents_[next++]);
    }
    while (!around.empty() && around.back().end <= place(i)) around.pop_back();
    dropped[i] = !around.empty() && is_whole(*around.back().part);
  }
  size_t kept = 0;
  for (size_t i = 0; i < dropped.size(); ++i) {
    if (dropped[i]) continue;
    if (kept != i) out.findings[kept] = std::move(out.findings[i]);
    ++kept;
  }
  out.findings.resize(kept);
}

namespace {

// `names` of changed elements; empty: there are none left.
void report_changed(Node part, const std::string& names, xml::Reporter& report) {
  if (names.empty()) {
    return report.add(xml::Code::kXmlLeftOut, part,
                      "a declaration that was written here is no longer there");
  }
  const std::string text = names + " was changed since it was exported, so its elements count, ";
  if (xml::boolean(xml::attribute(part, "partial")).value_or(false)) {
    return report.add(xml::Code::kXmlNotUnderstood, part, text + "which say less than its text did",
                      "compare it with the text, which stands here, and export it again");
  }
  report.add(xml::Code::kXmlLeftOut, part,
             text + "and comments that only its text had are left out");
}

}  // namespace

void SourceTexts::finish(xml::Reporter& report) {
  if (!extents_.empty()) drop_findings(report.out());
  for (const Source& source : sources_) {
    std::string text;
    for (Node node : xml::children(source.node, "part")) {
      auto found = parts_.find(number_of(node));
      if (found == parts_.end() || found->second.node != node) {
        text += raw_text(node);
        continue;
      }
      Part& part = found->second;
      if (is_whole(part)) {
        text += raw_text(node);
        continue;
      }
      if (!text.empty() && text.back() != '\n') text += '\n';
      text += part.found;
      report_changed(node, part.names, report);
    }
    report.out().sources.push_back({source.name + ".st", std::move(text)});
  }
}

}  // namespace plcopen
