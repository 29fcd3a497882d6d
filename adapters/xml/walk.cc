#include <algorithm>

#include "adapters/xml/document.h"
#include "base/name_case.h"
#include "frontend/lex/characters.h"

namespace xml {

std::string_view local_name(std::string_view name) {
  const size_t colon = name.rfind(':');
  return colon == std::string_view::npos ? name : name.substr(colon + 1);
}

std::string_view local_name(Node node) { return local_name(std::string_view(node.name())); }

bool is(Node node, std::string_view name) {
  return node.type() == pugi::node_element && local_name(node) == name;
}

Node child(Node node, std::string_view name) {
  for (Node below : node) {
    if (is(below, name)) return below;
  }
  return {};
}

Node find(Node node, std::initializer_list<std::string_view> names) {
  for (std::string_view name : names) node = child(node, name);
  return node;
}

std::vector<Node> children(Node node) {
  std::vector<Node> out;
  for (Node below : node) {
    if (below.type() == pugi::node_element) out.push_back(below);
  }
  return out;
}

std::vector<Node> children(Node node, std::string_view name) {
  std::vector<Node> out;
  for (Node below : node) {
    if (is(below, name)) out.push_back(below);
  }
  return out;
}

Node first_element(Node node) {
  for (Node below : node) {
    if (below.type() == pugi::node_element) return below;
  }
  return {};
}

std::string_view attribute(Node node, std::string_view name) {
  for (pugi::xml_attribute each : node.attributes()) {
    if (local_name(std::string_view(each.name())) == name) return each.value();
  }
  return {};
}

std::optional<bool> boolean(std::string_view text) {
  if (base::same_name(text, "true") || text == "1") return true;
  if (base::same_name(text, "false") || text == "0") return false;
  return std::nullopt;
}

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && frontend::is_space(text.front())) text.remove_prefix(1);
  while (!text.empty() && frontend::is_space(text.back())) text.remove_suffix(1);
  return text;
}

namespace {

bool ends_line(Node node) {
  return is(node, "p") || is(node, "br") || is(node, "div") || is(node, "li");
}

// Depth is limited by Document.
void append_text(Node node, std::string& out) {
  for (Node below : node) {
    if (below.type() == pugi::node_pcdata || below.type() == pugi::node_cdata) {
      out += below.value();
    } else if (below.type() == pugi::node_element) {
      if (ends_line(below) && !out.empty() && out.back() != '\n' && !is(below, "br")) out += '\n';
      append_text(below, out);
      if (ends_line(below)) out += '\n';
    }
  }
}

}  // namespace

std::string text_of(Node node) {
  std::string all;
  append_text(node, all);
  std::string_view text = all;
  for (;;) {  // empty lines in front; what stands in front of the first word stays
    const size_t end = text.find('\n');
    if (end == std::string_view::npos || !trimmed(text.substr(0, end)).empty()) break;
    text.remove_prefix(end + 1);
  }
  while (!text.empty() && frontend::is_space(text.back())) text.remove_suffix(1);
  return std::string(text);
}

bool is_name(std::string_view text) {
  return !text.empty() && frontend::is_name_start(text.front()) &&
         std::all_of(text.begin(), text.end(), frontend::is_name_part);
}

std::string as_name(std::string_view text) {
  std::string out(text);
  for (char& c : out) {
    if (!frontend::is_name_part(c)) c = '_';
  }
  return is_name(out) ? out : "_" + out;
}

std::string comment(std::string_view text, std::string_view indent) {
  std::string inside;
  for (char c : trimmed(text)) {
    const char last = inside.empty() ? ' ' : inside.back();
    if ((c == ')' && last == '*') || (c == '*' && (last == '(' || last == '/')) ||
        (c == '/' && last == '*')) {
      inside += ' ';
    }
    inside += c;
  }
  if (inside.empty()) return {};
  return indented("(* " + inside + " *)", indent);
}

std::string indented(std::string_view text, std::string_view indent) {
  std::string out;
  while (!text.empty()) {
    const size_t end = text.find('\n');
    std::string_view line = text.substr(0, end);
    while (!line.empty() && frontend::is_space(line.back())) line.remove_suffix(1);
    if (!line.empty()) {
      out += indent;
      out += line;
    }
    out += '\n';
    text = end == std::string_view::npos ? std::string_view() : text.substr(end + 1);
  }
  return out;
}

std::string shown(Node node) {
  std::string out = "<" + std::string(local_name(node));
  for (const char* name : {"name", "localId", "typeName", "label"}) {
    std::string_view value = attribute(node, name);
    if (value.empty()) continue;
    return out + " " + name + "=\"" + std::string(value.substr(0, 60)) + "\">";
  }
  return out + ">";
}

}  // namespace xml
