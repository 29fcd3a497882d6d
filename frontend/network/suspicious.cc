#include "frontend/network/suspicious.h"

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <utility>

#include "frontend/lex/characters.h"
#include "ir/types/types.h"

namespace frontend::network {
namespace {

using Code = base::DiagnosticCode;

// Which pins make a box work; one of them is enough.
struct PoweredBox {
  std::string_view prefix;
  std::string_view pins[2];
};
constexpr PoweredBox kPoweredBoxes[] = {
    {"TON", {"IN", ""}}, {"TOF", {"IN", ""}}, {"TP", {"IN", ""}},      {"CTUD", {"CU", "CD"}},
    {"CTU", {"CU", ""}}, {"CTD", {"CD", ""}}, {"R_TRIG", {"CLK", ""}}, {"F_TRIG", {"CLK", ""}},
};

// CTU_DINT, TON_LTIME: standard blocks of another type; TON_Special is somebody's own.
bool names_type(std::string_view suffix) {
  for (uint32_t kind = 0; kind < ir::kElementaryCount; ++kind) {
    if (ir::same_name(suffix, ir::elementary_name(static_cast<ir::Kind>(kind)))) return true;
  }
  return false;
}

const PoweredBox* powered_box(std::string_view type) {
  for (const PoweredBox& box : kPoweredBoxes) {
    const size_t size = box.prefix.size();
    if (type.size() < size || !ir::same_name(type.substr(0, size), box.prefix)) continue;
    if (type.size() == size || (type[size] == '_' && names_type(type.substr(size + 1))))
      return &box;
  }
  return nullptr;
}

// Each variable once: at its second coil.
void report_second_coils(const Body& body, base::Diagnostics& diagnostics) {
  struct Coils {
    base::SourceSpan first;
    bool told = false;
  };
  std::map<std::string, Coils> coils;
  for (const PlainCoil& coil : plain_coils(body)) {
    const auto [found, fresh] = coils.emplace(coil.place, Coils{coil.element->operand.span});
    if (fresh || std::exchange(found->second.told, true)) continue;
    base::Diagnostic message{Code::kSecondCoil,
                             coil.element->operand.span,
                             "`" + coil.element->operand.text + "` has a coil before this one, " +
                                 "which has no effect then",
                             "join both conditions in one rung, or use (S) and (R)",
                             {{found->second.first, "its first coil"}}};
    diagnostics.add(std::move(message));
  }
}

using Instances = std::set<std::string>;

bool is_connected(const Element& element, const PoweredBox& box) {
  return std::any_of(element.inputs.begin(), element.inputs.end(), [&](const Input& input) {
    if (input.from.empty()) return false;
    return input.name.empty() || ir::same_name(input.name, box.pins[0]) ||
           ir::same_name(input.name, box.pins[1]);
  });
}

// Instances whose input is given: by a box, or as `t.IN` by a coil or sink.
Instances powered_instances(const Body& body) {
  Instances out;
  for (const Network& network : body.networks) {
    if (network.disabled) continue;
    for (const Element& element : network.elements) {
      if (element.kind == Kind::kCoil || element.kind == Kind::kSink) {
        const std::string place = fixed_place(element.operand.text);
        out.insert(place.substr(0, std::min(place.rfind('.'), place.size())));
      } else if (element.kind == Kind::kBlock) {
        const PoweredBox* const box = powered_box(element.type.text);
        if (box != nullptr && is_connected(element, *box))
          out.insert(fixed_place(element.operand.text));
      }
    }
  }
  return out;
}

void report_boxes_without_power(const Body& body, base::Diagnostics& diagnostics) {
  const Instances powered = powered_instances(body);
  for (const Network& network : body.networks) {
    if (network.disabled) continue;
    for (const Element& element : network.elements) {
      if (element.kind != Kind::kBlock || element.operand.empty()) continue;
      const PoweredBox* const box = powered_box(element.type.text);
      if (box == nullptr || powered.contains(fixed_place(element.operand.text))) continue;
      const std::string pin(box->pins[0]);
      diagnostics.add(Code::kBoxWithoutPower, element.span,
                      "no power gets to `" + pin + "` of `" + element.operand.text +
                          "`, so it never does anything",
                      "connect " + pin);
    }
  }
}

}  // namespace

std::string fixed_place(std::string_view operand) {
  std::string out;
  bool index = false;
  for (const char c : operand) {
    if (c == ' ' || c == '\t') continue;
    if (c == '[') index = true;
    if (c == '^' || c == '(' || (index && is_name_start(c))) return {};
    if (c == ']') index = false;
    out += c;
  }
  return ir::fold_name(out);
}

bool may_skip(const Body& body) {
  for (const Network& network : body.networks) {
    if (network.disabled) continue;
    for (const Element& element : network.elements) {
      if (element.kind == Kind::kJump || element.kind == Kind::kReturn) return true;
    }
  }
  return false;
}

std::vector<PlainCoil> plain_coils(const Body& body) {
  std::vector<PlainCoil> out;
  if (body.language != Language::kLadder || may_skip(body)) return out;
  for (const Network& network : body.networks) {
    if (network.disabled) continue;
    for (const Element& element : network.elements) {
      const bool plain =
          element.modifier == Modifier::kNone || element.modifier == Modifier::kNegated;
      if (element.kind != Kind::kCoil || !plain) continue;
      std::string place = fixed_place(element.operand.text);
      if (!place.empty()) out.push_back({&element, std::move(place)});
    }
  }
  return out;
}

void report_suspicious(const Body& body, base::Diagnostics& diagnostics) {
  report_second_coils(body, diagnostics);
  report_second_writers(body, diagnostics);
  report_boxes_without_power(body, diagnostics);
}

}  // namespace frontend::network
