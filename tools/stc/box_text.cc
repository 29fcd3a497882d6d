#include "tools/stc/box_text.h"

#include <algorithm>
#include <map>
#include <optional>
#include <string_view>

#include "frontend/network/write.h"

namespace stc {
namespace {

namespace network = frontend::network;

// `t : TON(IN := go, PT := T#1s)`: head `t : TON`, pins by name or number.
struct Box {
  std::string head;
  std::vector<std::pair<std::string, std::string>> pins;
};

std::vector<std::string> split_pins(std::string_view text) {
  std::vector<std::string> out;
  std::string pin;
  int depth = 0;
  char quote = 0;
  for (char c : text) {
    if (quote != 0) {
      if (c == quote) quote = 0;
    } else if (c == '\'' || c == '"') {
      quote = c;
    } else if (c == '(' || c == '[') {
      ++depth;
    } else if (c == ')' || c == ']') {
      --depth;
    }
    if (c == ',' && depth == 0 && quote == 0) {
      out.push_back(std::move(pin));
      pin.clear();
    } else if (c != ' ' || !pin.empty()) {
      pin += c;
    }
  }
  if (!pin.empty()) out.push_back(std::move(pin));
  return out;
}

std::optional<Box> box_of(const std::string& row) {
  const size_t open = row.find('(');
  if (open == std::string::npos || !row.ends_with(')')) return std::nullopt;
  Box box{row.substr(0, open), {}};
  const bool is_box = box.head.find(" : ") != std::string::npos || box.head.starts_with("WIRE ");
  if (!is_box) return std::nullopt;
  size_t number = 0;
  for (const std::string& pin :
       split_pins(std::string_view(row).substr(open + 1, row.size() - open - 2))) {
    ++number;
    const size_t sign = pin.find(" := ");
    if (sign == std::string::npos) {
      box.pins.emplace_back("input " + std::to_string(number), pin);
    } else {
      box.pins.emplace_back(pin.substr(0, sign), pin.substr(sign + 4));
    }
  }
  return box;
}

UnitPart part_of(std::string row, const std::string& prefix) {
  if (row.ends_with(';')) row.pop_back();
  const auto named = [&](const char* kind, std::string name) {
    return UnitPart{kind, prefix + std::move(name), row};
  };
  if (row.starts_with("WIRE ")) return named("block", row.substr(5, row.find(" := ") - 5));
  if (row.starts_with("JMP ")) return named("jump", row.substr(4, row.find(' ', 4) - 4));
  if (row == "RETURN" || row.starts_with("RETURN ")) return named("return", "");
  if (box_of(row)) return named("block", row.substr(0, row.find(" : ")));
  const size_t sign = row.find("= ");
  return named("output", row.substr(0, row.rfind(' ', sign)));
}

}  // namespace

std::vector<UnitPart> box_parts(const network::Network& whole, const std::string& prefix) {
  network::Body body{network::Language::kFbd, {whole}, {}};
  network::Network& only = body.networks[0];
  only.comments.clear();
  only.label = {};
  for (network::Element& element : only.elements) element.comments.clear();
  std::vector<UnitPart> out;
  const std::string text = network::write_fbd(body, 0);
  for (std::string_view rest = text; !rest.empty();) {
    const size_t end = std::min(rest.find('\n'), rest.size());
    if (end != 0) out.push_back(part_of(std::string(rest.substr(0, end)), prefix));
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  return out;
}

std::string differing_pins(const std::string& before, const std::string& after) {
  const std::optional<Box> was = box_of(before);
  const std::optional<Box> is = box_of(after);
  if (!was || !is || was->head != is->head) return {};
  std::map<std::string, std::string> old_pins(was->pins.begin(), was->pins.end());
  std::string out;
  const auto add = [&](const std::string& pin, const std::string& from, const std::string& to) {
    out += (out.empty() ? "" : "; ") + pin + ": " + from + " -> " + to;
  };
  for (const auto& [pin, value] : is->pins) {
    const auto found = old_pins.find(pin);
    if (found == old_pins.end()) {
      add(pin, "none", value);
      continue;
    }
    if (found->second != value) add(pin, found->second, value);
    old_pins.erase(found);
  }
  for (const auto& [pin, value] : old_pins) add(pin, value, "none");
  return out;
}

}  // namespace stc
