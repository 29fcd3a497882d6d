#include "tools/stvm/unit_table.h"

#include <utility>

#include "vm/runtime/protocol.h"

namespace stvm {
namespace {

constexpr uint8_t kNoSlot = 2;  // of a number that no POU has

std::vector<uint64_t> instance_counts(const ir::Image& image) {
  std::vector<uint64_t> counts(image.pous.size());
  for (uint32_t id = 1; id < image.instances.size(); ++id) {
    const ir::Instance& row = image.instances[id];
    if (row.live && row.pou < counts.size()) ++counts[row.pou];
  }
  return counts;
}

uint64_t row_bytes(const UnitRow& row) {
  return row.name.size() + row.who.size() + row.event.size() + 160;
}

}  // namespace

UnitTable::UnitTable(const vm::Controller& controller, Since started)
    : controller_(controller), started_(std::make_shared<const Since>(std::move(started))) {
  const std::vector<ir::LinkedPou>& pous = controller_.image().pous;
  for (uint32_t pou = 0; pou < pous.size(); ++pou) {
    slots_.push_back(pous[pou].name.empty() ? kNoSlot : view(pou).slot);
  }
}

vm::CodeSlots::View UnitTable::view(uint32_t pou) const {
  const vm::CodeTable& code = *controller_.generation().first_code();
  return controller_.code_slots().view(pou, code.pous[pou].code);
}

void UnitTable::note(Since now) {
  const auto since = std::make_shared<const Since>(std::move(now));
  const std::vector<ir::LinkedPou>& pous = controller_.image().pous;
  slots_.resize(pous.size(), kNoSlot);
  for (uint32_t pou = 0; pou < pous.size(); ++pou) {
    if (pous[pou].name.empty()) {
      slots_[pou] = kNoSlot;
      exchanged_.erase(pou);
      continue;
    }
    const vm::CodeSlots::View there = view(pou);
    if (std::exchange(slots_[pou], there.slot) == there.slot) continue;
    exchanged_[pou] = {since, there.other.value_or(vm::SlotLabel{}).version};
  }
  exchanged_.erase(exchanged_.lower_bound(static_cast<uint32_t>(pous.size())), exchanged_.end());
}

OtherSlot UnitTable::what_lies_there(const vm::SlotLabel& label, const Exchanged* exchanged,
                                     const ir::VerifiedImage* staged,
                                     const ir::VerifiedImage* before) {
  const auto is_of = [&](const ir::VerifiedImage* version) {
    return version != nullptr && label.version == vm::SlotLabel::start_of(version->digest());
  };
  if (is_of(staged)) return OtherSlot::kStaged;
  if (is_of(before)) return OtherSlot::kBefore;
  // Written since by a change that was not made.
  if (exchanged == nullptr || exchanged->other != label.version) return OtherSlot::kLeft;
  return exchanged->since->event == "undone" ? OtherSlot::kUndone : OtherSlot::kBefore;
}

UnitRow UnitTable::row(uint32_t pou, const ir::VerifiedImage* staged,
                       const ir::VerifiedImage* before) const {
  const auto found = exchanged_.find(pou);
  const Exchanged* const exchanged = found == exchanged_.end() ? nullptr : &found->second;
  const Since& since = exchanged == nullptr ? *started_ : *exchanged->since;
  const vm::CodeSlots::View there = view(pou);
  UnitRow row;
  row.name = controller_.image().pous[pou].name;
  row.unit = controller_.image().pous[pou].identity;
  row.slot = there.slot;
  row.cycle = since.cycle;
  row.time_ns = since.time_ns;
  row.who = since.who;
  row.event = since.event;
  if (!there.other) return row;
  row.other = what_lies_there(*there.other, exchanged, staged, before);
  row.other_unit = vm::SlotLabel::digest_of(there.other->unit);
  row.other_version = vm::SlotLabel::digest_of(there.other->version);
  return row;
}

UnitPage UnitTable::page(uint64_t first, const ir::VerifiedImage* staged,
                         const ir::VerifiedImage* before) const {
  const std::vector<ir::LinkedPou>& pous = controller_.image().pous;
  const std::vector<uint64_t> counts = instance_counts(controller_.image());
  UnitPage page;
  uint64_t bytes = 0;
  for (uint64_t pou = first; pou < pous.size(); ++pou) {
    if (bytes > vm::kChunkBytes) {
      page.next = pou;
      break;
    }
    if (pous[pou].name.empty()) continue;
    page.rows.push_back(row(static_cast<uint32_t>(pou), staged, before));
    page.rows.back().instances = counts[pou];
    bytes += row_bytes(page.rows.back());
  }
  return page;
}

}  // namespace stvm
