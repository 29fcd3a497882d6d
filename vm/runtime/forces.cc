#include "vm/runtime/forces.h"

#include <algorithm>

#include "vm/runtime/renamed_paths.h"

namespace vm {
namespace {

// Bytes that stand for the same value in the other image; empty when there are none.
base::Bytes carry_over(const ir::Image& from, const Force& force, const ir::Image& to,
                       const ir::Symbol& symbol) {
  bool same_type = from.types.text(force.symbol.type) == to.types.text(symbol.type) &&
                   force.symbol.bit_mask == symbol.bit_mask;
  if (same_type && from.types[force.symbol.type].kind != ir::Kind::kEnum) return force.value;
  std::string text = value_text(from, force);
  // A whole REAL is what an integer may be, too.
  const auto is_real = [](const ir::Type& type) {
    return type.kind == ir::Kind::kReal || type.kind == ir::Kind::kLreal;
  };
  const bool to_whole = is_real(from.types[force.symbol.type]) && !is_real(to.types[symbol.type]);
  if (to_whole && text.ends_with(".0")) text.resize(text.size() - 2);
  base::Result<base::Bytes> value = ir::parse_value(to, symbol, text);
  return value.ok() ? *value : base::Bytes{};
}

bool share_inputs(const Force& a, const Force& b, const ProcessImage& process_image) {
  if (!a.symbol.input || !b.symbol.input) return false;
  const size_t bytes = process_image.input_bytes();
  base::Bytes inputs(bytes), of_a(bytes), of_b(bytes);
  process_image.mark_inputs(a.symbol.data, a.value, inputs, of_a);
  process_image.mark_inputs(b.symbol.data, b.value, inputs, of_b);
  for (size_t i = 0; i < bytes; ++i) {
    if ((of_a[i] & of_b[i]) != 0) return true;
  }
  return false;
}

}  // namespace

std::string value_text(const ir::Image& image, const Force& force) {
  ir::Symbol alone = force.symbol;
  alone.data = 0;
  return ir::format_value(image, alone, force.value);
}

bool overlap(const Force& a, const Force& b, const ProcessImage& process_image) {
  if (share_inputs(a, b, process_image)) return true;
  const bool bits = a.symbol.bit_mask != 0 && b.symbol.bit_mask != 0;
  if (bits && (a.symbol.bit_mask & b.symbol.bit_mask) == 0) return false;
  return a.symbol.data < b.symbol.data + b.value.size() &&
         b.symbol.data < a.symbol.data + a.value.size();
}

std::string hold_text(const std::string& reason) {
  return reason.empty() ? "everywhere" : "at the boundaries of cycles: " + reason;
}

ForcedSet ForcedSet::make(const ir::VerifiedImage& image, const CodeTable& own,
                          std::vector<Force> forces, const TierOptions& tier) {
  ForcedSet set;
  set.forces = std::move(forces);
  std::vector<ForcedVariable> variables;
  for (const Force& force : set.forces) {
    const auto size = static_cast<uint32_t>(force.value.size());
    variables.push_back(
        {{force.symbol.data, size, force.symbol.type}, force.value, force.symbol.bit_mask});
  }
  const auto is_input = [](const Force& force) { return force.symbol.input; };
  if (std::any_of(set.forces.begin(), set.forces.end(), is_input)) {
    const ProcessImage process_image(image.image());
    set.inputs.resize(process_image.input_bytes());
    set.input_mask.resize(process_image.input_bytes());
    for (const Force& force : set.forces) {
      if (!force.symbol.input) continue;
      process_image.mark_inputs(force.symbol.data, force.value, set.inputs, set.input_mask);
    }
  }
  set.code = ForcedCode::make(image, own, variables, tier);
  set.made_of = own.number.value;
  for (size_t i = 0; i < set.forces.size(); ++i) {
    set.forces[i].reason = set.code == nullptr ? std::string() : set.code->reason(i);
  }
  return set;
}

ForcedSet ForcedSet::adopt(const ir::VerifiedImage& image, const CodeTable& own,
                           const ir::Image& from, const std::vector<Force>& rows,
                           const TierOptions& tier, ForceList back) {
  if (rows.empty() && back == nullptr) return {};
  const ir::Image& to = image.image();
  const RenamedPaths paths(from, to);
  const ProcessImage process_image(to);
  std::vector<Force> forces;
  std::vector<Force> ended;
  const auto is_free = [&](const Force& force) {
    const auto meets = [&](const Force& other) { return overlap(force, other, process_image); };
    return std::none_of(forces.begin(), forces.end(), meets);
  };
  for (const Force& row : rows) {
    Force force = row;
    Force before = row;
    force.path = paths.find(row);
    base::Result<ir::Symbol> symbol = ir::find_symbol(image.names(), force.path);
    base::Bytes value;
    if (symbol.ok() && !symbol->constant) value = carry_over(from, force, to, *symbol);
    force = {force.path, symbol.ok() ? *symbol : ir::Symbol(), std::move(value)};
    if (force.value.empty() || !is_free(force)) {
      ended.push_back(std::move(before));
    } else {
      forces.push_back(std::move(force));
    }
  }
  if (back != nullptr) {
    for (Force force : *back) {
      if (is_free(force)) forces.push_back(std::move(force));
    }
  }
  ForcedSet set = make(image, own, std::move(forces), tier);
  if (!ended.empty()) set.moved.ended = std::make_shared<std::vector<Force>>(std::move(ended));
  set.moved.back = std::move(back);
  return set;
}

}  // namespace vm
