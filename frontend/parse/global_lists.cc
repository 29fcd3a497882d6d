#include "frontend/parse/global_lists.h"

#include <algorithm>
#include <optional>

namespace frontend {
namespace {

bool is_list_file(const Tree& tree, const base::SourceMap& sources, uint32_t file) {
  const auto none = [&](const auto& list) {
    return std::none_of(list.begin(), list.end(), [&](const auto& declaration) {
      return sources.file_of(declaration.name.span.begin) == file;
    });
  };
  return none(tree.pous) && none(tree.types) && none(tree.configs);
}

}  // namespace

std::vector<const VarBlock*> list_heads(const Tree& tree, const base::SourceMap& sources) {
  std::vector<const VarBlock*> out;
  std::optional<uint32_t> asked;  // a file, and
  bool lists_alone = false;       // whether it is a GVL
  for (const VarBlock& block : tree.globals) {
    const uint32_t file = sources.file_of(block.span.begin);
    if (block.goes_on && asked != file) {
      asked = file;
      lists_alone = is_list_file(tree, sources, file);
    }
    const bool same = block.goes_on && lists_alone && !out.empty();
    out.push_back(same ? out.back() : &block);
  }
  return out;
}

std::string_view list_name(const Tree& tree, const base::SourceMap& sources, const VarBlock& head) {
  const Attribute* named = tree.find_attribute(head.attributes, "list");
  if (named != nullptr && !named->value.empty()) return named->value;
  std::string_view file = sources.file_name(sources.file_of(head.span.begin));
  file.remove_prefix(file.find_last_of("/\\") + 1);
  return file.substr(0, file.find('.'));
}

}  // namespace frontend
