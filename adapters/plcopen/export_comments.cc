// Comments that stand nowhere in a document: nobody should believe that they do.
#include <map>

#include "adapters/plcopen/writer.h"
#include "frontend/lex/lexer.h"

namespace plcopen {
namespace {

using frontend::Token;

struct Comment {
  size_t begin = 0;
  std::string words;  // between one blank each: lines are broken anew on the way
};

std::string words_of(std::string_view text) {
  const std::string all = xml::as_utf8(text);
  std::string out;
  for (size_t i = 0; i < all.size();) {
    const size_t begin = all.find_first_not_of(" \t\r\n", i);
    if (begin == std::string::npos) break;
    i = std::min(all.find_first_of(" \t\r\n", begin), all.size());
    out += (out.empty() ? "" : " ") + all.substr(begin, i - begin);
  }
  return out;
}

// Where the comment that opens at `at` ends; those inside of it count.
size_t end_of(std::string_view text, size_t at) {
  const char first = text[at];  // of (* or /*
  const char last = first == '(' ? ')' : '/';
  uint32_t depth = 0;
  for (size_t i = at; i + 1 < text.size(); ++i) {
    const bool opens = text[i] == first && text[i + 1] == '*';
    const bool closes = text[i] == '*' && text[i + 1] == last;
    if (!opens && !closes) continue;
    depth = opens ? depth + 1 : depth - 1;
    ++i;
    if (depth == 0) return i + 1;
  }
  return text.size();
}

// `text`: what stands between two tokens, `begin` its place.
void add_comments(std::string_view text, size_t begin, std::vector<Comment>& out) {
  for (size_t i = 0; i < text.size();) {
    std::string_view rest = text.substr(i);
    size_t end = i + 1;
    std::string_view inside;
    if (rest.starts_with("//")) {
      end = std::min(text.find('\n', i), text.size());
      inside = text.substr(i + 2, end - i - 2);
    } else if (rest.starts_with("(*") || rest.starts_with("/*")) {
      end = end_of(text, i);
      inside = text.substr(i + 2, std::max<size_t>(end - i, 4) - 4);
    } else if (rest.starts_with("{")) {
      end = std::min(text.find('}', i), text.size());
    }
    std::string words = words_of(inside);
    if (!words.empty()) out.push_back({begin + i, std::move(words)});
    i = end;
  }
}

std::vector<Comment> comments_of(std::string_view text) {
  base::Diagnostics unheard;
  std::vector<Comment> out;
  size_t end = 0;
  for (const Token& token : frontend::lex(text, {0}, unheard).tokens) {
    const bool last = token.kind == frontend::TokenKind::kEnd;
    const size_t begin = last ? text.size() : token.begin;
    add_comments(text.substr(end, begin - end), end, out);
    end = begin + token.length;
    if (last) break;
  }
  return out;
}

// One comment, or several: blank lines part those of an element, and what cannot stand between the
// marks of a comment is one for each line (network/element_text.h).
void add_whole(std::string_view text, std::map<std::string, uint32_t>& out) {
  const std::string all = words_of(text);
  ++out[all];
  for (const std::string_view border : {"\n\n", "\n"}) {
    for (std::string_view rest = text; !rest.empty();) {
      const size_t end = std::min(rest.find(border), rest.size());
      std::string words = words_of(rest.substr(0, end));
      if (!words.empty() && words != all) ++out[std::move(words)];
      rest.remove_prefix(std::min(end + border.size(), rest.size()));
    }
  }
}

// How often each comment stands there.
std::map<std::string, uint32_t> comments_in(Node root) {
  std::map<std::string, uint32_t> out;
  std::vector<Node> todo = {root};
  while (!todo.empty()) {
    const Node node = todo.back();
    todo.pop_back();
    if (node.type() == pugi::node_pcdata || node.type() == pugi::node_cdata) {
      for (Comment& each : comments_of(node.value())) ++out[std::move(each.words)];
      continue;
    }
    bool whole = false;
    for (const char* name : {"documentation", "Documentation", "content", "Content"}) {
      whole = whole || xml::is(node, name);
    }
    if (whole) {
      add_whole(xml::text_of(node), out);
      continue;
    }
    for (Node child : node.children()) todo.push_back(child);
  }
  return out;
}

bool is_in_test(const frontend::Tree& tree, base::SourcePos at) {
  for (const frontend::PouDecl& test : tree.tests) {
    if (test.span.begin <= at && at < test.span.end) return true;
  }
  return false;
}

}  // namespace

void report_lost_comments(const ExportInput& input, Node root, base::Diagnostics& diagnostics) {
  std::map<std::string, uint32_t> there = comments_in(root);
  for (uint32_t file = 0; file < input.sources.file_count(); ++file) {
    if (!input.sources.is_source(file)) continue;
    base::SourceSpan first;
    uint32_t count = 0;
    std::string lines;
    for (const Comment& comment : comments_of(input.sources.text(file))) {
      auto found = there.find(comment.words);
      const base::SourcePos at = {input.sources.begin(file).offset +
                                  static_cast<uint32_t>(comment.begin)};
      if (found != there.end() && found->second > 0) {
        --found->second;
        continue;
      }
      if (is_in_test(input.tree, at)) continue;
      if (count++ == 0) first = {at, {at.offset + 2}};
      if (count > 10) continue;
      lines += (lines.empty() ? "" : ", ") + std::to_string(input.sources.locate(at).line);
    }
    if (count == 0) continue;
    if (count > 10) lines += " ...";
    diagnostics.add(base::DiagnosticCode::kXmlLeftOut, first,
                    std::to_string(count) + " comment(s) are left out, in line(s) " + lines +
                        ": XML has no place for them",
                    "put them in front of a POU, or after a variable, or into a body");
  }
}

}  // namespace plcopen
