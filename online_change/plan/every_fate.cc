#include "online_change/plan/every_fate.h"

#include <algorithm>
#include <optional>

#include "ir/bytecode/leaf_walk.h"

namespace online_change {
namespace {

// "retyped; and 699 more like it" -> "retyped".
std::string alone(std::string reason) {
  if (!std::string_view(reason).ends_with(kMoreLikeIt)) return reason;
  reason.resize(reason.rfind("; and "));
  return reason;
}

// Is it a variable with a value of its own, not something that has such variables?
bool is_leaf(const ir::NameIndex& names, const std::string& path) {
  const base::Result<ir::Symbol> symbol = ir::find_symbol(names, path);
  const ir::Image& image = names.image();
  return symbol.ok() && image.types[symbol->type].kind != ir::Kind::kArray &&
         !image.types.has_members(symbol->type);
}

}  // namespace

EveryFate::EveryFate(const Plan& plan, const ir::Image& old_image, const ir::Image& new_image)
    : plan_(plan),
      old_(old_image),
      new_(new_image),
      old_names_(old_image),
      new_names_(new_image),
      old_areas_(old_image),
      new_areas_(new_image) {
  for (uint32_t number = 0; number < plan.steps.size(); ++number) {
    const UpdateStep& step = plan.steps[number];
    const std::optional<CopiedValues> source = step.source();
    const auto* gathered = step.as<GatheredBits>();
    for (uint32_t i = 0; i < step.count; ++i) {
      Written value{source ? source->from + i * source->from_stride : 0, step.place(i), step.size,
                    number, i};
      by_target_.push_back(value);
      if (source) by_source_.push_back(value);
      if (gathered == nullptr) continue;
      for (const GatheredPart& part : plan.gathers[gathered->row]) {
        by_source_.push_back(
            {part.from, step.to + part.within, std::max(part.size, 1u), number, i});
      }
    }
  }
  for (const Gather& parts : plan.gathers) taken_.add(parts);
  std::sort(by_target_.begin(), by_target_.end(),
            [](const Written& a, const Written& b) { return a.to < b.to; });
  std::sort(by_source_.begin(), by_source_.end(),
            [](const Written& a, const Written& b) { return a.from < b.from; });
  ir::for_each_leaf_from(new_, 0, [&](const std::string&, const ir::Symbol&) {
    ++new_count_;
    return true;
  });
}

const EveryFate::Written* EveryFate::writes(uint32_t address) const {
  auto next = std::upper_bound(by_target_.begin(), by_target_.end(), address,
                               [](uint32_t at, const Written& value) { return at < value.to; });
  if (next == by_target_.begin()) return nullptr;
  const Written& value = *--next;
  return address - value.to < value.size ? &value : nullptr;
}

const EveryFate::Written* EveryFate::reads(uint32_t address) const {
  auto next = std::upper_bound(by_source_.begin(), by_source_.end(), address,
                               [](uint32_t at, const Written& value) { return at < value.from; });
  if (next == by_source_.begin()) return nullptr;
  const Written& value = *--next;
  const auto* converted = plan_.steps[value.step].as<ConvertedValues>();
  const uint32_t size = converted == nullptr ? value.size : old_.layouts[converted->old_type].size;
  return address - value.from < size ? &value : nullptr;
}

const Gather* EveryFate::gather_of(const UpdateStep& step) const {
  const auto* gathered = step.as<GatheredBits>();
  return gathered == nullptr ? nullptr : &plan_.gathers[gathered->row];
}

// What a gathered byte was, or a bit in it.
std::optional<uint32_t> EveryFate::gathered_from(const Written& value, uint32_t address) const {
  const uint32_t within = address - value.to;
  for (const GatheredPart& part : *gather_of(plan_.steps[value.step])) {
    if (within - part.within < std::max(part.size, 1u)) return part.from + (within - part.within);
  }
  return std::nullopt;
}

std::string EveryFate::reason_of(uint32_t row) const {
  return row == kNoFate ? std::string() : alone(plan_.fates[row].reason);
}

// The variable of the old version that lies there; of several (a union), that of the same name.
void EveryFate::name_old(VariableFate& out, uint32_t address) const {
  base::Result<ir::Symbol> same = ir::find_symbol(old_names_, out.path);
  if (same.ok() && same->data == address) {
    out.old_address = address;
    out.old_type = same->type;
    return;
  }
  const std::optional<Node> leaf = old_areas_.leaf_at(address);
  // A new member of a union is a view of bytes that other members are, too.
  if (!leaf || leaf->begin != address || old_.types.overlaps(leaf->type)) return;
  out.old_address = address;
  out.old_type = leaf->type;
  out.old_path = old_areas_.path_at(address);
}

VariableFate EveryFate::of_new(const std::string& path, const ir::Symbol& symbol) const {
  VariableFate out;
  out.path = path;
  out.new_address = symbol.data;
  out.new_type = symbol.type;
  const Written* const value = writes(symbol.data);
  if (value == nullptr) {
    name_old(out, symbol.data);
    return out;
  }
  out.step = &plan_.steps[value->step];
  out.index = value->index;
  out.gather = gather_of(*out.step);
  const bool has_source = out.step->source().has_value();
  out.fate = out.step->fate != kNoFate             ? plan_.fates[out.step->fate].fate
             : has_source || out.gather != nullptr ? Fate::kMoved
                                                   : Fate::kInitialised;
  out.reason = reason_of(out.step->fate);
  if (has_source) {
    name_old(out, value->from + (symbol.data - value->to));
  } else if (out.gather != nullptr) {
    const base::Result<ir::Symbol> same = ir::find_symbol(old_names_, path);
    const std::optional<uint32_t> from = gathered_from(*value, symbol.data);
    if (from && same.ok() && same->data == *from) name_old(out, *from);
  } else if (is_leaf(old_names_, path)) {
    const base::Result<ir::Symbol> before = ir::find_symbol(old_names_, path);
    out.old_address = before->data;
    out.old_type = before->type;
    out.loses = out.fate == Fate::kInitialised && !before->constant && !before->input;
  }
  return out;
}

// Does the value of an old variable that the new version does not know by its name live on under
// another one? Other members of a union have their bytes too, and are not it.
bool EveryFate::goes_on(const std::string& path, const ir::Symbol& symbol) const {
  const uint32_t address = symbol.data;
  uint32_t to = address;
  if (const Written* value = reads(address)) {
    if (gather_of(plan_.steps[value->step]) != nullptr) {
      return taken_.all(address, uint64_t{address} + old_.layouts[symbol.type].size);
    }
    to = value->to + (address - value->from);
  } else if (writes(address) != nullptr) {
    return false;
  }
  const std::string there = new_areas_.path_at(to);
  if (there.empty() || ir::same_name(there, path)) return !there.empty();
  const std::optional<Node> whole = old_areas_.leaf_at(address);
  if (whole && old_.types.overlaps(whole->type)) {  // is the same member where the union is now?
    const std::string around = old_areas_.path_at(address);
    return path.size() > around.size() && is_leaf(new_names_, there + path.substr(around.size()));
  }
  base::Result<ir::Symbol> before = ir::find_symbol(old_names_, there);
  return !before.ok() || before->data != address;
}

uint64_t EveryFate::visit_from(uint64_t first, const Visit& visit) const {
  uint64_t next = first;
  bool go_on = true;
  if (next < new_count_) {
    ir::for_each_leaf_from(new_, next, [&](const std::string& path, const ir::Symbol& symbol) {
      go_on = visit(of_new(path, symbol));
      ++next;
      return go_on;
    });
  }
  if (!go_on) return next;
  // A member of a union that goes while the union lives on is a view of bytes that stay (case 74).
  const auto is_view = [&](uint32_t address) {
    const std::optional<Node> whole = old_areas_.leaf_at(address);
    if (!whole || !old_.types.overlaps(whole->type)) return false;
    const Written* value = reads(whole->begin);
    if (value == nullptr && writes(whole->begin) != nullptr) return false;
    const uint32_t to = value == nullptr ? whole->begin : value->to + (whole->begin - value->from);
    const std::optional<Node> there = new_areas_.leaf_at(to);
    return there && there->begin == to && new_.types.overlaps(there->type);
  };
  bool more = false;
  ir::for_each_leaf_from(old_, next - new_count_,
                         [&](const std::string& path, const ir::Symbol& symbol) {
                           if (!go_on) {
                             more = true;
                             return false;
                           }
                           ++next;
                           if (is_leaf(new_names_, path) || goes_on(path, symbol)) return true;
                           VariableFate gone;
                           gone.fate = Fate::kDropped;
                           gone.path = path;
                           gone.old_address = symbol.data;
                           gone.old_type = symbol.type;
                           gone.loses = !symbol.constant && !is_view(symbol.data);
                           gone.reason = "removed";
                           go_on = visit(gone);
                           return true;
                         });
  return more ? next : 0;
}

}  // namespace online_change
