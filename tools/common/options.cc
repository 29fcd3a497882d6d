#include "tools/common/options.h"

#include <charconv>

namespace tools {

std::string_view long_name(const OptionRow& row) {
  const std::string_view name = row.name;
  return name.substr(0, name.find('|'));
}

std::string_view short_name(const OptionRow& row) {
  const std::string_view name = row.name;
  const size_t bar = name.find('|');
  return bar == std::string_view::npos ? std::string_view() : name.substr(bar + 1);
}

std::vector<std::string_view> words_of(std::string_view list) {
  std::vector<std::string_view> words;
  while (!list.empty()) {
    const size_t bar = list.find('|');
    words.push_back(list.substr(0, bar));
    list.remove_prefix(bar == std::string_view::npos ? list.size() : bar + 1);
  }
  return words;
}

std::string Options::text(std::string_view name, std::string_view otherwise) const {
  auto found = values_.find(std::string(name));
  return found == values_.end() ? std::string(otherwise) : found->second.back();
}

std::vector<std::string> Options::all(std::string_view name) const {
  auto found = values_.find(std::string(name));
  return found == values_.end() ? std::vector<std::string>{} : found->second;
}

base::Result<uint64_t> Options::number(std::string_view name, uint64_t otherwise) const {
  auto found = values_.find(std::string(name));
  if (found == values_.end()) return otherwise;
  const std::string& text = found->second.back();
  uint64_t value = 0;
  auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (code != std::errc() || end != text.data() + text.size()) {
    return base::Error{base::Refusal::kUsage,
                       std::string(name) + " needs a whole number, not `" + text + "`"};
  }
  return value;
}

}  // namespace tools
