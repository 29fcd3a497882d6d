#include "online_change/apply/kept_data.h"

#include <algorithm>
#include <cstring>
#include <string_view>

#include "base/name_case.h"
#include "ir/types/handle.h"
#include "online_change/apply/used_data.h"

namespace online_change {
namespace {

// Between two looks at the deadline.
constexpr uint32_t kKeptPiece = 64u << 10;

constexpr std::string_view kReinit = ".FB_Reinit";

// References that start code binds begin with such a value; other values may look like one.
bool holds_unbound(const base::Bytes& bytes) {
  constexpr uint64_t kNumber = 0x0fffffff;
  for (size_t at = 0; at + sizeof(uint64_t) <= bytes.size(); ++at) {
    uint64_t value;
    std::memcpy(&value, bytes.data() + at, sizeof value);
    if ((value & ~kNumber) == ir::unbound_handle(0)) return true;
  }
  return false;
}

bool is_reinit(const ir::LinkedPou& pou) {
  const std::string_view name = pou.name;
  return name.size() > kReinit.size() &&
         base::same_name(name.substr(name.size() - kReinit.size()), kReinit);
}

}  // namespace

KeptData::KeptData(const ir::Image& running) : extents_(used_extents(running)) {
  bytes_.resize(total_bytes(extents_));
}

bool KeptData::keep(const uint8_t* memory, const Interrupted& interrupted) {
  uint8_t* to = bytes_.data();
  holds_ = false;
  for (const ir::Extent& extent : extents_) {
    for (uint32_t done = 0; done < extent.size; done += kKeptPiece) {
      if (interrupted && interrupted()) return false;
      const uint32_t size = std::min(extent.size - done, kKeptPiece);
      std::memcpy(to, memory + extent.offset + done, size);
      to += size;
    }
  }
  return holds_ = true;
}

void KeptData::put_back(uint8_t* memory) {
  holds_ = false;
  const uint8_t* from = bytes_.data();
  for (const ir::Extent& extent : extents_) {
    std::memcpy(memory + extent.offset, from, extent.size);
    from += extent.size;
  }
}

bool start_code_runs(const Plan& plan, const ir::Image& new_image, const Leaving& leaving) {
  if (!leaving.at_undo.empty()) return true;
  bool starts = false;
  for (const ir::ImageTask& task : new_image.tasks) starts |= task.once;
  if (!starts) return false;
  for (const ir::LinkedPou& pou : new_image.pous) {
    if (is_reinit(pou)) return true;
  }
  for (const UpdateStep& step : plan.steps) {
    const auto* initial = step.as<InitialValues>();
    if (initial != nullptr && holds_unbound(initial->bytes)) return true;
  }
  return false;
}

}  // namespace online_change
