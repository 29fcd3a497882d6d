#include "adapters/twincat/archive.h"

#include <charconv>
#include <set>
#include <system_error>

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
  struct Finder : pugi::xml_tree_walker {
    bool for_each(xml::Node& node) override {
      if (!xml::is(node, "o") || xml::attribute(node, "t") != type) return true;
      ++count;
      found = node;
      return count < 2;
    }
    std::string_view type;
    xml::Node found;
    int count = 0;
  } finder;
  finder.type = type;
  archive.traverse(finder);
  return finder.count == 1 ? finder.found : xml::Node();
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
  const std::string_view type = xml::attribute(node, "t");
  if (!node) return {};
  return {node, xml::is(node, "o") && !type.empty() ? type : "?"};
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
  const xml::Node flags = member(object, "Flags");
  if (!flags) return 0;
  const std::string text = member_text(flags, "Flags");
  uint32_t bits = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), bits);
  return error == std::errc() && end == text.data() + text.size() ? bits : kUnreadable;
}

ArchiveProblem archive_problem(xml::Node object) {
  struct Walker : pugi::xml_tree_walker {
    bool for_each(xml::Node& node) override {
      const bool list = xml::is(node, "l2");
      if (!list && !xml::is(node, "o")) return true;
      std::set<std::string_view> names;
      for (xml::Node below : xml::children(node)) {
        const std::string_view name = xml::attribute(below, "n");
        const bool text = xml::is(below, "v");
        if (list && (xml::is(below, "o") || xml::is(below, "n") ||
                     (text && xml::attribute(node, "cet") == "String"))) {
          continue;
        }
        if (!list && !name.empty() && names.insert(name).second) continue;
        problem = {below, list ? "a list holds what is no object"
                               : "a member has no name, or that of another one"};
        return false;
      }
      return true;
    }
    ArchiveProblem problem;
  } walker;
  object.traverse(walker);
  return walker.problem;
}

}  // namespace twincat
