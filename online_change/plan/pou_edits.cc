#include "online_change/plan/pou_edits.h"

#include <algorithm>
#include <iterator>
#include <map>

#include "online_change/plan/type_content.h"

namespace online_change {
namespace {

struct Parameter {
  std::string kind;  // "input"
  std::string name;
  std::string type;     // as people read it
  std::string content;  // of its structures and enumerations too
};

const char* kind_of(ir::Section section) {
  switch (section) {
    case ir::Section::kInput:
      return "input";
    case ir::Section::kOutput:
      return "output";
    case ir::Section::kInOut:
      return "in-out";
    default:
      return nullptr;
  }
}

const char* kind_of(ir::LocalKind kind) {
  switch (kind) {
    case ir::LocalKind::kInput:
      return "input";
    case ir::LocalKind::kOutput:
      return "output";
    case ir::LocalKind::kInOut:
      return "in-out";
    default:
      return "result";
  }
}

std::vector<Parameter> interface_of(const ir::Image& image, const ir::LinkedPou& pou) {
  std::vector<Parameter> out;
  TypeContent content(image.types);
  if (ir::is_body(pou.kind)) {
    for (const ir::Member& member : image.types[pou.self].members) {
      const char* kind = kind_of(member.section);
      if (kind == nullptr) continue;
      out.push_back({kind, member.name, image.types.text(member.type), content.of(member.type)});
    }
    return out;
  }
  for (const ir::FrameSlot& slot : pou.slots) {
    if (slot.kind != ir::SlotKind::kParam) continue;
    const ir::TypeId type = slot.region.type;
    out.push_back({kind_of(slot.local), slot.name, image.types.text(type), content.of(type)});
  }
  return out;
}

// The first difference; "" when callers see the same.
std::string interface_difference(const std::vector<Parameter>& before,
                                 const std::vector<Parameter>& after) {
  auto text = [](const Parameter& p) { return p.kind + " `" + p.name + "`"; };
  for (size_t i = 0; i < std::max(before.size(), after.size()); ++i) {
    if (i >= after.size()) return text(before[i]) + " removed";
    if (i >= before.size()) return text(after[i]) + " added";
    const Parameter& a = before[i];
    const Parameter& b = after[i];
    if (a.kind != b.kind || !ir::same_name(a.name, b.name)) {
      return text(b) + " in the place of " + text(a);
    }
    if (a.type != b.type) return text(b) + " " + a.type + " -> " + b.type;
    if (a.content != b.content) return text(b) + ": " + b.type + " has another content";
  }
  return {};
}

using Pous = std::map<std::string, const ir::LinkedPou*>;  // by folded name

Pous by_name(const ir::Image& image, const std::vector<bool>& left_out) {
  Pous out;
  for (const ir::LinkedPou& pou : image.pous) {
    const auto number = static_cast<size_t>(&pou - image.pous.data());
    if (number < left_out.size() && left_out[number]) continue;
    // A number that a removed POU had, and no other has yet, stays without a name.
    if (!pou.name.empty()) out.emplace(ir::fold_name(pou.name), &pou);
  }
  return out;
}

bool same_parameter(const ir::FrameSlot& a, const ir::FrameSlot& b) {
  const bool parameters = a.kind == ir::SlotKind::kParam && b.kind == ir::SlotKind::kParam;
  if (!parameters) return a.kind != ir::SlotKind::kParam && b.kind != ir::SlotKind::kParam;
  return a.local == b.local && a.region == b.region && a.name == b.name;
}

// Where types are the same: the same POU, with the same code and the same interface.
bool same_pou(const ir::LinkedPou& a, const ir::LinkedPou& b) {
  return a.identity == b.identity && a.name == b.name && a.kind == b.kind && a.self == b.self &&
         (a.slots.is_one_with(b.slots) ||
          std::equal(a.slots.begin(), a.slots.end(), b.slots.begin(), b.slots.end(),
                     same_parameter));
}

// Do the sources say the same of it? Not known of images that were made before that was stored.
bool same_content(const ir::Image& old_image, const ir::LinkedPou& old_pou,
                  const ir::Image& new_image, const ir::LinkedPou& new_pou) {
  if (old_image.contents.empty() || new_image.contents.empty()) return false;
  const auto content_of = [](const ir::Image& image, const ir::LinkedPou& pou) {
    return image.contents[static_cast<size_t>(&pou - image.pous.data())];
  };
  const ir::PouContent before = content_of(old_image, old_pou);
  return before != ir::PouContent{} && before == content_of(new_image, new_pou);
}

// Live instances of each POU.
std::vector<uint64_t> instance_counts(const ir::Image& image) {
  std::vector<uint64_t> counts(image.pous.size());
  for (uint32_t id = 1; id < image.instances.size(); ++id) {
    const ir::Instance& row = image.instances[id];
    if (row.live && row.pou < counts.size()) ++counts[row.pou];
  }
  return counts;
}

}  // namespace

const char* pou_change_name(PouChange change) {
  switch (change) {
    case PouChange::kAdded:
      return "added";
    case PouChange::kRemoved:
      return "removed";
    case PouChange::kBody:
      return "body";
    case PouChange::kInterface:
      return "interface";
    case PouChange::kFollows:
      return "follows";
  }
  base::check(false, "a change that pou_change_name() knows");
  return "";
}

namespace {

// But for POUs that are known to be the same in both.
std::vector<PouEdit> edits_but(const ir::Image& old_image, const ir::Image& new_image,
                               const std::vector<bool>& same) {
  const Pous before = by_name(old_image, same);
  const Pous after = by_name(new_image, same);
  const std::vector<uint64_t> counts = instance_counts(old_image);
  std::vector<PouEdit> edits;
  std::vector<PouEdit> following;
  for (const auto& [name, pou] : after) {
    const auto found = before.find(name);
    if (found == before.end()) {
      edits.push_back({PouChange::kAdded, pou->name, 0, {}});
      continue;
    }
    const ir::LinkedPou& old_pou = *found->second;
    PouEdit edit{PouChange::kBody, pou->name, 0, {}};
    edit.what =
        interface_difference(interface_of(old_image, old_pou), interface_of(new_image, *pou));
    if (!edit.what.empty()) edit.change = PouChange::kInterface;
    if (edit.what.empty() && old_pou.identity == pou->identity) continue;
    if (ir::is_body(pou->kind)) {
      edit.instances = counts[static_cast<size_t>(&old_pou - old_image.pous.data())];
    }
    const bool follows =
        edit.change == PouChange::kBody && same_content(old_image, old_pou, new_image, *pou);
    if (follows) edit.change = PouChange::kFollows;
    (follows ? following : edits).push_back(std::move(edit));
  }
  for (const auto& [name, pou] : before) {
    if (!after.contains(name)) edits.push_back({PouChange::kRemoved, pou->name, 0, {}});
  }
  std::ranges::move(following, std::back_inserter(edits));
  return edits;
}

}  // namespace

std::vector<PouEdit> pou_edits(const ir::Image& old_image, const ir::Image& new_image) {
  return edits_but(old_image, new_image, {});
}

std::vector<PouEdit> pou_edits(const EncodedImage& old_version, const EncodedImage& new_version) {
  const std::vector<ir::LinkedPou>& before = old_version.image.pous;
  const std::vector<ir::LinkedPou>& after = new_version.image.pous;
  std::vector<bool> same;
  if (same_types(old_version, new_version)) {
    same.resize(std::min(before.size(), after.size()));
    for (size_t i = 0; i < same.size(); ++i) same[i] = same_pou(before[i], after[i]);
  }
  return edits_but(old_version.image, new_version.image, same);
}

base::Status check_restricted(const std::vector<PouEdit>& edits) {
  for (const PouEdit& edit : edits) {
    if (edit.change != PouChange::kInterface) continue;
    return base::Error{base::Refusal::kInterfaceEdit, "`" + edit.pou + "`: " + edit.what};
  }
  return base::Ok{};
}

}  // namespace online_change
