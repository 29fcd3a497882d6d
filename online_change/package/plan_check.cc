#include "online_change/package/plan_check.h"

#include <algorithm>
#include <cstring>

#include "base/limits.h"
#include "ir/bytecode/renames.h"
#include "ir/types/stamps.h"
#include "online_change/diff/type_diff.h"
#include "online_change/diff/union_bytes.h"
#include "online_change/diff/value_conversion.h"
#include "online_change/package/package.h"

namespace online_change {
namespace {

bool is_area(const ir::Image& image, Node node) {
  return image.types[node.type].kind == ir::Kind::kGlobals;
}

}  // namespace

PlanCheck::PlanCheck(const Plan& plan, const ir::Image& old_image, const ir::Image& new_image,
                     const ir::Image& code)
    : plan_(plan),
      old_(old_image),
      new_(new_image),
      code_(code),
      old_areas_(old_image),
      new_areas_(new_image),
      old_data_(old_image),
      new_data_(new_image),
      fit_(old_areas_, new_image) {}

base::Status PlanCheck::run() {
  bool good = check_calls() && check_forms();
  good = good && check_targets();
  for (uint32_t id = 0; good && id < new_.instances.size(); ++id) {
    if (new_.instances[id].live) good = check_area(id);
  }
  if (good && check_reached()) return base::Ok{};
  return base::Error{base::Refusal::kBadPackage, "change package: " + why_};
}

// Nearly always in order, so that a number for each step is enough.
void PlanCheck::reach(const Target& first, uint32_t count) {
  uint32_t& reached = reached_[first.step];
  if (first.index > reached) {
    uint32_t& early = reached_early_[{first.step, first.index}];
    early = std::max(early, count);
    return;
  }
  reached = std::max(reached, first.index + count);
  for (auto at = reached_early_.lower_bound({first.step, 0});
       at != reached_early_.end() && at->first.first == first.step && at->first.second <= reached;
       at = reached_early_.erase(at)) {
    reached = std::max(reached, at->first.second + at->second);
  }
}

bool PlanCheck::check_reached() {
  for (size_t i = 0; i < plan_.steps.size(); ++i) {
    const UpdateStep& step = plan_.steps[i];
    const bool single = step.as<ConvertedValues>() != nullptr ||
                        step.as<EnteredStep>() != nullptr || step.as<GivenValue>() != nullptr;
    if (!single || reached_[i] == step.count) continue;
    return fail(step.place(reached_[i]), "is made, but no variable is there");
  }
  return true;
}

bool PlanCheck::fail(uint32_t at, const char* what) {
  std::string path = new_areas_.path_at(at);
  why_ = (path.empty() ? "offset " + std::to_string(at) : "`" + path + "`") + " " + what;
  return false;
}

bool PlanCheck::check_forms() {
  uint64_t bytes = 0;
  for (const UpdateStep& step : plan_.steps) {
    if (!check_form(step)) return false;
    bytes += step.total();
  }
  // Each byte of data memory is written at most once, so more is a double target for certain.
  if (bytes <= new_.data_capacity) return true;
  why_ = "writes more bytes than there are";
  return false;
}

bool PlanCheck::check_form(const UpdateStep& step) {
  if (step.size == 0 || step.count == 0) return fail(step.to, "is written by an empty step");
  if (step.count > 1 && step.to_stride < step.size) {
    return fail(step.to, "is written twice");
  }
  if (step.to + step.hull() > new_.data_capacity) return fail(step.to, "ends outside of memory");
  if (step.fate != kNoFate && step.fate >= plan_.fates.size()) {
    return fail(step.to, "has no row in the fate report");
  }
  if (const auto* given = step.as<GivenValue>()) {
    const bool right = step.count == 1 && given->made.empty() && given->call < plan_.calls.size() &&
                       new_.types.contains(given->type);
    return right || fail(step.to, "has a migration step of another form");
  }
  const auto* gathered = step.as<GatheredBits>();
  if (gathered != nullptr && !check_gather(step, *gathered)) return false;
  const base::Bytes* const bytes = step.bytes();
  if (bytes != nullptr && !bytes->empty() && bytes->size() != step.total()) {
    return fail(step.to, "is initialised with too few or too many bytes");
  }
  const bool entered = step.as<EnteredStep>() != nullptr;
  if (entered && step.count != 1) return fail(step.to, "is several steps");
  const auto* converted = step.as<ConvertedValues>();
  if (converted == nullptr) return true;
  if (!converted->known.empty()) {
    return fail(step.to, "is converted to what only a controller knows");
  }
  return (old_.types.contains(converted->old_type) && new_.types.contains(converted->new_type)) ||
         fail(step.to, "has no known type");
}

bool PlanCheck::check_targets() {
  for (const UpdateStep& step : plan_.steps) {
    if (!check_places(step)) return false;
  }
  reached_.resize(plan_.steps.size());
  values_.emplace(plan_.steps);
  const std::optional<uint32_t> twice = values_->overlap();
  return !twice || fail(*twice, "is written twice");
}

// Bytes of one area each, into the variable.
bool PlanCheck::check_gather(const UpdateStep& step, const GatheredBits& gathered) {
  if (step.count != 1 || gathered.row >= plan_.gathers.size()) {
    return fail(step.to, "has a step of another form that gathers bytes");
  }
  for (const GatheredPart& part : plan_.gathers[gathered.row]) {
    const uint32_t size = std::max(part.size, 1u);
    const std::optional<uint32_t> id = old_areas_.instance_at(part.from);
    const bool from = id && uint64_t{part.from} + size <=
                                uint64_t{old_areas_.begin(*id)} + old_areas_.capacity(*id);
    if (!from) return fail(step.to, "is read from outside of any area");
    if (uint64_t{part.within} + size > step.size) return fail(step.to, "is written outside of it");
  }
  return true;
}

// Every pattern of bits is a value of the node's type, or it is a BOOL that one bit makes.
bool PlanCheck::check_gathered(Node node, const Target& target, uint32_t depth) {
  if (node.in_out) return fail(node.begin, "is no variable that has bits at an address");
  if (takes_any_bits(new_.types, node.type)) {
    const Gather& parts = parts_of(target);
    // For a value that no part writes as a whole the initial bytes count.
    return (is_initialised(node.begin, size_of(node), target) && !parts.empty()) ||
           fail(node.begin, "is initialised with something else than its initial value");
  }
  if (has_parts(node)) {
    return for_each_part(node, [&](Node part) { return check_node(part, depth + 1); });
  }
  if (new_.types[node.type].kind != ir::Kind::kBool) {
    return fail(node.begin, "is no variable that has bits at an address");
  }
  const uint32_t within = node.begin - target.to;
  for (const GatheredPart& part : parts_of(target)) {
    if (within - part.within >= std::max(part.size, 1u)) continue;
    const bool bit = part.size == 0 && part.to_mask == GatheredPart::kBool;
    if (!bit) return fail(node.begin, "is a BOOL that gets other bytes than 0 and 1");
  }
  return check_initial(node, target);
}

// All values of a step lie in one area, and come from one area.
bool PlanCheck::check_places(const UpdateStep& step) {
  std::optional<uint32_t> id = new_areas_.instance_at(step.to);
  if (!id || step.to + step.hull() > uint64_t{new_areas_.begin(*id)} + new_areas_.capacity(*id)) {
    return fail(step.to, "is written outside of any area");
  }
  if (step.early() && old_areas_.owns(step.to, static_cast<uint32_t>(step.hull()))) {
    return fail(step.to, "is initialised early, but the running version uses these bytes");
  }
  const std::optional<CopiedValues> source = step.source();
  if (!source) return true;  // check_calls() and check_gather() have seen what they read
  const auto* converted = step.as<ConvertedValues>();
  const uint64_t size = converted == nullptr ? step.size : old_.layouts[converted->old_type].size;
  const uint64_t end = source->from + uint64_t{source->from_stride} * (step.count - 1) + size;
  if (end > old_.data_capacity) return fail(step.to, "is read outside of memory");
  id = old_areas_.instance_at(source->from);
  if (!id || end > uint64_t{old_areas_.begin(*id)} + old_areas_.capacity(*id)) {
    return fail(step.to, "is read from outside of any area");
  }
  return true;
}

uint32_t PlanCheck::source_of(const Target& target) const {
  const CopiedValues source = step_of(target).source().value_or(CopiedValues{});
  return source.from + source.from_stride * target.index;
}

const Gather& PlanCheck::parts_of(const Target& target) const {
  return plan_.gathers[step_of(target).as<GatheredBits>()->row];
}

uint32_t PlanCheck::size_of(Node node) const {
  if (node.in_out) return 4;
  return new_.layouts[node.type].size;
}

bool PlanCheck::has_parts(Node node) const {
  bool array = new_.types[node.type].kind == ir::Kind::kArray;
  return !node.in_out && (array || has_own_parts(new_.types, node.type));
}

template <class Visit>
bool PlanCheck::for_each_part(Node node, Visit visit) const {
  const ir::Type& type = new_.types[node.type];
  const ir::TypeLayout& layout = new_.layouts[node.type];
  if (type.kind != ir::Kind::kArray) {
    for (uint32_t i = 0; i < type.members.size(); ++i) {
      bool in_out = type.members[i].section == ir::Section::kInOut;
      if (!visit(Node{type.members[i].type, node.begin + layout.member_offsets[i], in_out})) {
        return false;
      }
    }
    return true;
  }
  uint32_t stride = new_.layouts[type.base].size;
  for (uint32_t done = 0; stride != 0 && done + stride <= layout.size; done += stride) {
    if (!visit(Node{type.base, node.begin + done, false})) return false;
  }
  return true;
}

bool PlanCheck::check_area(uint32_t id) {
  const ir::TypeId type = new_.instances[id].type;
  stamp_at_ = 0;
  for (size_t i = 0; id != 0 && i < new_.types[type].members.size(); ++i) {
    if (new_.types[type].members[i].section != ir::Section::kStamp) continue;
    stamp_at_ = new_.instances[id].data + new_.layouts[type].member_offsets[i];
  }
  Node area{new_.instances[id].type, new_areas_.begin(id), false};
  uint32_t used = new_areas_.used(id);
  const std::optional<Target> first = first_behind(area.begin);
  bool touched = first && first->to < uint64_t{area.begin} + used;
  uint32_t from = area.begin;
  if (touched && step_of(*first).as<CopiedValues>() != nullptr && first->to == area.begin &&
      first->size >= used) {
    touched = false;  // moved as a whole
    from = source_of(*first);
  }
  if (!touched) {
    Fit fit = fit_.area_at(from, area.type);
    if (fit == Fit::kYes) return true;
    if (fit == Fit::kYesButSlots && old_data_.equal(from, new_data_, area.begin, used)) return true;
  }
  return for_each_part(area, [&](Node part) { return check_node(part, 0); });
}

bool PlanCheck::check_node(Node node, uint32_t depth) {
  if (depth > base::kMaxTypeDepth || is_area(new_, node)) {
    return fail(node.begin, "is nested too deeply");
  }
  uint64_t end = uint64_t{node.begin} + size_of(node);
  const std::optional<Target> first = first_behind(node.begin);
  if (!first || first->to >= end) return check_carried(node, node.begin, depth);
  if (first->to <= node.begin && first->end() >= end) return check_written(node, *first, depth);
  if (!has_parts(node)) return check_grown_union(node);
  if (new_.types[node.type].kind == ir::Kind::kArray) return check_elements(node, depth);
  return for_each_part(node, [&](Node part) { return check_node(part, depth + 1); });
}

bool PlanCheck::check_elements(Node array, uint32_t depth) {
  ir::TypeId element = new_.types[array.type].base;
  uint32_t stride = new_.layouts[element].size;
  uint32_t count = stride == 0 ? 0 : size_of(array) / stride;
  for (uint32_t i = 0; i < count;) {
    Node node{element, array.begin + i * stride, false};
    uint32_t run = converted_run(node, count - i);
    if (run == 0 && !check_node(node, depth + 1)) return false;
    i += std::max(run, 1u);
  }
  return true;
}

uint32_t PlanCheck::converted_run(Node first, uint32_t most) {
  const std::optional<Target> found = first_behind(first.begin);
  if (!found || found->to != first.begin || has_parts(first)) return 0;
  const UpdateStep& step = step_of(*found);
  uint32_t run = std::min(most, step.count - found->index);
  const auto* how = step.as<ConvertedValues>();
  bool right = how != nullptr && how->new_type == first.type && step.size == size_of(first) &&
               (run == 1 || step.to_stride == step.size) &&
               how->from_stride == old_.layouts[how->old_type].size &&
               classify(old_.types, how->old_type, new_.types, how->new_type) != Conversion::kNone;
  if (!right || !old_areas_.is_array_of(source_of(*found), how->old_type, run)) return 0;
  reach(*found, run);
  return run;
}

bool PlanCheck::check_written(Node node, const Target& target, uint32_t depth) {
  switch (step_of(target).kind()) {
    case StepKind::kInitialise:
      return check_initial(node, target);
    case StepKind::kConvert:
      return check_conversion(node, target, depth);
    case StepKind::kEnter:
      return check_entered(node, target);
    case StepKind::kMigrate:
      return check_migrated(node, target);
    case StepKind::kGather:
      return check_gathered(node, target, depth);
    case StepKind::kCopy:
      return check_carried(node, source_of(target) + (node.begin - target.to), depth);
  }
  return fail(node.begin, "has a step of unknown kind");
}

bool PlanCheck::is_initialised(uint32_t begin, uint32_t size, const Target& target) const {
  const base::Bytes* const bytes = step_of(target).bytes();
  if (bytes == nullptr) return false;
  if (bytes->empty()) return new_data_.is_zero(begin, size);
  base::Bytes wanted(size);
  new_data_.read(begin, wanted);
  const uint8_t* const made =
      bytes->data() + size_t{target.index} * step_of(target).size + (begin - target.to);
  constexpr uint32_t kOld = ir::kOldStamp;
  return std::memcmp(wanted.data(), made, size) == 0 ||
         (begin == stamp_at_ && size == sizeof kOld && std::memcmp(&kOld, made, size) == 0);
}

bool PlanCheck::check_initial(Node node, const Target& target) {
  return is_initialised(node.begin, size_of(node), target) ||
         fail(node.begin, "is initialised with something else than its initial value");
}

bool PlanCheck::check_grown_union(Node node) {
  const std::optional<Target> front = first_behind(node.begin);
  const bool copied = front && front->to <= node.begin;
  const uint64_t behind = copied ? front->end() : front->to;
  const uint32_t from = copied ? source_of(*front) + (node.begin - front->to) : node.begin;
  const std::optional<Node> source = old_areas_.leaf_at(from);
  const uint64_t end = uint64_t{node.begin} + size_of(node);
  const std::optional<Target> rest = first_behind(static_cast<uint32_t>(behind));
  const bool right =
      !node.in_out && source && !source->in_out && source->begin == from &&
      (!copied || step_of(*front).as<CopiedValues>() != nullptr) &&
      keeps_union_bytes(old_, source->type, new_, node.type) &&
      behind == uint64_t{node.begin} + old_.layouts[source->type].size && rest &&
      rest->to <= behind && rest->end() >= end && step_of(*rest).as<InitialValues>() != nullptr &&
      is_initialised(static_cast<uint32_t>(behind), static_cast<uint32_t>(end - behind), *rest);
  return right || fail(node.begin, "is written in part only");
}

bool PlanCheck::check_conversion(Node node, const Target& target, uint32_t depth) {
  if (has_parts(node)) {
    return for_each_part(node, [&](Node part) { return check_node(part, depth + 1); });
  }
  const auto& how = *step_of(target).as<ConvertedValues>();
  uint32_t from = source_of(target);
  std::optional<Node> source = old_areas_.leaf_at(from);
  bool right = source && !source->in_out && source->begin == from && source->type == how.old_type &&
               !node.in_out && node.type == how.new_type && node.begin == target.to &&
               size_of(node) == target.size &&
               classify(old_.types, how.old_type, new_.types, how.new_type) != Conversion::kNone;
  if (right) reach(target);
  return right || fail(node.begin, "is converted between other types than its own");
}

bool PlanCheck::check_carried(Node node, uint32_t from, uint32_t depth) {
  if (depth > base::kMaxTypeDepth) return fail(node.begin, "is nested too deeply");
  Fit fit = fit_.value_at(from, node);
  if (fit == Fit::kYes) return true;
  if (fit == Fit::kYesButSlots && old_data_.equal(from, new_data_, node.begin, size_of(node))) {
    return true;
  }
  if (!has_parts(node)) {
    return fail(node.begin, fit == Fit::kNo ? "is neither kept nor written"
                                            : "would keep the ID of another instance");
  }
  return for_each_part(node, [&](Node part) {
    return check_carried(part, from + (part.begin - node.begin), depth + 1);
  });
}

base::Status check_package(const Package& package, const ir::Image& old_image,
                           const ir::Image& new_image) {
  const ir::OldUnderNewNames old(old_image, new_image);
  base::Status forward = PlanCheck(package.forward, old.image(), new_image, new_image).run();
  if (!forward) return forward;
  base::Status inverse = PlanCheck(package.inverse, new_image, old.image(), new_image).run();
  if (inverse) return inverse;
  return base::Error{inverse.error().refusal, inverse.error().text + " (on the way back)"};
}

}  // namespace online_change
