#include "adapters/twincat/archive.h"

#include <charconv>

namespace twincat {
namespace {

std::string unquoted(std::string text) {
  if (text.size() >= 2 && text.front() == '"' && text.back() == '"') {
    return text.substr(1, text.size() - 2);
  }
  return text;
}

}  // namespace

xml::Node find_object(xml::Node archive, std::string_view type) {
  return archive.find_node(
      [type](xml::Node node) { return xml::is(node, "o") && xml::attribute(node, "t") == type; });
}

xml::Node member(xml::Node object, std::string_view name) {
  for (xml::Node node : object) {
    if (node.type() != pugi::node_element || xml::attribute(node, "n") != name) continue;
    return xml::is(node, "n") ? xml::Node() : node;
  }
  return {};
}

Item object_member(xml::Node object, std::string_view name) {
  const xml::Node node = member(object, name);
  return {node, xml::is(node, "o") ? xml::attribute(node, "t") : std::string_view()};
}

std::string member_text(xml::Node object, std::string_view name) {
  const xml::Node node = member(object, name);
  return xml::is(node, "v") ? unquoted(node.text().get()) : std::string();
}

bool is_true(xml::Node object, std::string_view name) {
  return member_text(object, name) == "true";
}

std::vector<Item> items(xml::Node object, std::string_view list) {
  const xml::Node node = member(object, list);
  const std::string_view common = xml::attribute(node, "cet");
  std::vector<Item> out;
  for (xml::Node item : xml::children(node)) {
    const std::string_view own = xml::attribute(item, "t");
    const bool none = xml::is(item, "n");
    out.push_back({item, none ? std::string_view() : !own.empty() ? own : common});
    // In a list that says no types.
    if (!none && out.back().type.empty()) out.back().type = "?";
  }
  return out;
}

std::vector<std::string> texts(xml::Node object, std::string_view list) {
  std::vector<std::string> out;
  for (const Item& item : items(object, list)) out.push_back(unquoted(item.node.text().get()));
  return out;
}

uint32_t flags_of(xml::Node object) {
  const std::string text = member_text(member(object, "Flags"), "Flags");
  uint32_t bits = 0;
  std::from_chars(text.data(), text.data() + text.size(), bits);
  return bits;
}

}  // namespace twincat
