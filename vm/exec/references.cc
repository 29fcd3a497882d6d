#include "vm/exec/references.h"

#include <algorithm>

#include "base/limits.h"
#include "ir/bytecode/regions.h"
#include "ir/types/natural_layout.h"

namespace vm {
namespace {

constexpr int32_t kOnePast = 1;  // ir/types/reach.h

// Does a slot have a byte in [begin, end), which lies in the reach?
bool touches_slot(const ReferenceHome& home, uint64_t begin, uint64_t end) {
  if (!home.reach.has_slots) return false;
  const uint32_t* const last = home.slots + home.slot_count;
  const uint32_t* const next = std::partition_point(
      home.slots, last, [begin](uint64_t at) { return at + ir::kSlotBytes <= begin; });
  return next != last && *next < end;
}

const AreaEntry* area_at(const Context& ctx, uint32_t address) {
  const std::vector<uint32_t>& order = ctx.generation->areas_by_data();
  const std::vector<AreaEntry>& areas = ctx.generation->areas();
  auto behind = std::partition_point(order.begin(), order.end(),
                                     [&](uint32_t id) { return areas[id].data <= address; });
  while (behind != order.begin()) {  // areas without bytes may share an offset
    const AreaEntry& area = areas[*--behind];
    if (address - area.data < area.capacity) return &area;
    if (area.capacity != 0) return nullptr;
  }
  return nullptr;
}

const Exposure* exposure_of(const Context& ctx, uint32_t segment) {
  const Exposure* const first = ctx.exposures;
  const Exposure* const end = first + ctx.exposure_count;
  const Exposure* const found = std::find_if(
      first, end, [segment](const Exposure& local) { return local.segment == segment; });
  return found == end ? nullptr : found;
}

// The slot of the variable in the frame of `pou` that covers `offset`; nullptr when none can be
// exposed.
const ir::FrameSlot* slot_at(const ir::Image& image, uint32_t pou, uint32_t offset,
                             uint32_t& size) {
  const std::vector<ir::FrameSlot>& slots = image.pous[pou].slots;
  const auto behind = std::partition_point(slots.begin(), slots.end(),
                                           [&](const auto& slot) { return slot.offset <= offset; });
  if (behind == slots.begin()) return nullptr;
  const ir::FrameSlot& slot = *(behind - 1);
  if (!slot.aggregate && slot.cls >= ir::Class::kA) return nullptr;
  size = slot.aggregate ? ir::region_size(image.types, image.layouts, slot.region)
                        : ir::class_size(slot.cls);
  return offset - slot.offset < size ? &slot : nullptr;
}

// The one with that begin; where a new one belongs otherwise. Sorted by depth.
Exposure* find_exposure(Context& ctx, uint32_t depth, uint32_t begin) {
  Exposure* at = ctx.exposures + ctx.exposure_count;
  while (at != ctx.exposures && (at - 1)->depth > depth) --at;
  Exposure* const behind = at;
  for (; at != ctx.exposures && (at - 1)->depth == depth; --at) {
    if ((at - 1)->begin == begin) return at - 1;
  }
  return behind;
}

// Numbers begin again after 2^21, and those of outer calls are still in use then.
uint32_t next_exposed_segment(Context& ctx) {
  uint32_t segment = 0;
  do {
    segment = ir::exposed_segment(ctx.task, ++ctx.exposures_made);
  } while (exposure_of(ctx, segment) != nullptr);
  return segment;
}

std::optional<uint64_t> expose(Context& ctx, uint32_t depth, uint32_t pou, uint32_t frame,
                               uint32_t address) {
  uint32_t size = 0;
  const ir::FrameSlot* slot = slot_at(ctx.generation->image(), pou, address - frame, size);
  if (slot == nullptr) return ir::make_handle(0, address);
  const uint32_t begin = frame + slot->offset;
  Exposure* const end = ctx.exposures + ctx.exposure_count;
  Exposure* const at = find_exposure(ctx, depth, begin);
  if (at == end || at->depth != depth || at->begin != begin) {
    if (ctx.exposure_count == base::kMaxExposures) return std::nullopt;
    const uint32_t segment = next_exposed_segment(ctx);
    std::move_backward(at, end, end + 1);
    *at = {segment, begin, size, depth};
    ++ctx.exposure_count;
    find_deepest_exposed(ctx);
  }
  return ir::make_handle(at->segment, address - begin);
}

KnownReach known_reach(const ReferenceHome& home, uint64_t handle) {
  const bool slots = home.reach.has_slots && home.slot_count != 0;
  const auto whole = static_cast<uint32_t>(ir::with_away(0, ir::kWhole) >> 32);
  const uint32_t mark = ir::handle_away(handle) == ir::kWhole ? whole : 0;
  return {home.reach.begin, ir::handle_segment(handle) | mark, home.reach.size(),
          slots ? 0 : home.data};
}

std::span<const ir::Reach> reaches_of(const Context& ctx, const AreaEntry& area) {
  return {ctx.generation->area_reaches().data() + area.first_reach, area.reach_count};
}

// Null: the segment names no live area.
const AreaEntry* area_of(const Context& ctx, uint32_t segment) {
  const uint32_t id = (segment & ir::kSegmentIdMask) - 1;
  const std::vector<AreaEntry>& areas = ctx.generation->areas();
  return id < areas.size() && areas[id].segment == segment ? &areas[id] : nullptr;
}

// The area of a handle that is inside of its variable; null: it is not, or names no area.
const AreaEntry* area_inside(const Context& ctx, uint64_t handle) {
  return area_of(ctx, static_cast<uint32_t>(handle >> 32));
}

// The instance whose area the handle names from its first byte on; 0: none.
uint32_t instance_of(const Context& ctx, uint64_t handle) {
  const AreaEntry* const area = area_of(ctx, ir::handle_segment(handle));
  const bool first = ir::handle_offset(handle) == 0 && ir::is_inside(handle);
  return area != nullptr && first ? ir::segment_id(area->segment) : 0;
}

}  // namespace

std::optional<ReferenceHome> find_home(const Context& ctx, uint64_t handle) {
  const uint32_t segment = ir::handle_segment(handle);
  if (const AreaEntry* const area = area_of(ctx, segment)) {
    return ReferenceHome{area->data, ir::reach_of(reaches_of(ctx, *area), area->used, handle),
                         ctx.generation->area_slots().data() + area->first_slot, area->slot_count};
  }
  if ((segment & ir::kExposedBit) == 0) return std::nullopt;
  const Exposure* const local = exposure_of(ctx, segment);
  if (local == nullptr) return std::nullopt;
  const ir::Reach whole[] = {{0, local->size, false}};
  return ReferenceHome{local->begin, ir::reach_of(whole, local->size, handle), nullptr, 0};
}

uint64_t move_handle(const Context& ctx, uint64_t handle, uint64_t way, KnownReach& known) {
  if (ir::is_far(way)) return ir::lost(handle);
  const auto bytes = static_cast<uint32_t>(way);
  const uint32_t from = ir::handle_offset(handle);
  if (const AreaEntry* const area = area_inside(ctx, handle)) {
    const ir::Reach reach = ir::reach_at(reaches_of(ctx, *area), from);
    if (reach.holds(from) && reach.holds(from + bytes)) {
      known = {reach.begin, area->segment, reach.size(), reach.has_slots ? 0 : area->data};
      return ir::move_offset(handle, bytes);
    }
  }
  const std::optional<ReferenceHome> home = find_home(ctx, handle);
  if (!home) return ir::move_offset(handle, bytes);
  known = known_reach(*home, handle);
  return ir::moved_from(home->reach, handle, bytes);
}

// Areas come first: most references name one, and each time another one.
uint32_t resolve_bytes(const Context& ctx, uint64_t handle, uint32_t size, KnownReach& known) {
  if (const AreaEntry* const area = area_inside(ctx, handle)) {
    const uint32_t place = ir::handle_offset(handle);
    const ir::Reach reach = ir::reach_at(reaches_of(ctx, *area), place);
    if (reach.covers(place, size) && !reach.has_slots) {
      known = {reach.begin, area->segment, reach.size(), area->data};
      return area->data + place;
    }
  }
  const std::optional<ReferenceHome> home = find_home(ctx, handle);
  const uint32_t offset = ir::handle_offset(handle);
  if (!home || !home->reach.covers(offset, size)) return 0;
  if (touches_slot(*home, offset, uint64_t{offset} + size)) return 0;
  known = known_reach(*home, handle);
  return home->data + offset;
}

uint64_t resolve_for_code(Context* ctx, uint64_t handle, uint64_t size_and_bytes, uint64_t site) {
  KnownReach& known = ctx->reaches[site];
  const auto bytes = static_cast<int32_t>(size_and_bytes);
  if (bytes != 0) handle = move_handle(*ctx, handle, static_cast<uint64_t>(bytes), known);
  return resolve_bytes(*ctx, handle, static_cast<uint32_t>(size_and_bytes >> 32), known);
}

uint64_t move_for_code(Context* ctx, uint64_t handle, uint64_t bytes, uint64_t site) {
  return move_handle(*ctx, handle, bytes, ctx->reaches[site]);
}

uint64_t reach_for_code(Context* ctx, uint64_t handle, uint64_t, uint64_t site) {
  KnownReach& known = ctx->reaches[site];
  const int32_t away = ir::handle_away(handle);
  const std::optional<ReferenceHome> home = find_home(*ctx, handle);
  if (home && (away == 0 || away == kOnePast)) {
    known = known_reach(*home, handle);
    const uint32_t distance = ir::handle_offset(handle) - known.begin;
    const bool in_order = known.begin + known.size < uint64_t{1} << 31;  // its handles are
    if (known.home != 0 && known.size != 0 && distance <= known.size && in_order) return distance;
  }
  constexpr uint64_t kFar = uint64_t{1} << 32;
  const uint64_t begin = handle - kFar;
  known = {static_cast<uint32_t>(begin), static_cast<uint32_t>(begin >> 32), 0, 0};
  return kFar;
}

bool has_left(const Context& ctx, uint64_t handle, uint32_t size) {
  const std::optional<ReferenceHome> home = find_home(ctx, handle);
  if (!home) return false;
  if (home->reach.size() == 0) return ir::handle_away(handle) == ir::kLost;
  return !home->reach.covers(ir::handle_offset(handle), size);
}

uint32_t find_instance(const Context* ctx, uint64_t handle, uint32_t type) {
  const uint32_t id = instance_of(*ctx, handle);
  const bool right =
      id != 0 && ctx->generation->image().types.is_a(ir::TypeId(ctx->generation->areas()[id].type),
                                                     ir::TypeId(type));
  return right ? id : 0;
}

VirtualCallee find_target(const Context* ctx, uint64_t handle, uint32_t prototype) {
  const uint32_t id = instance_of(*ctx, handle);
  if (id == 0) return {};
  const uint32_t pou = ctx->generation->target_of(ctx->generation->areas()[id].type, prototype);
  return pou == kNoTarget ? VirtualCallee{} : VirtualCallee{id, pou};
}

// Locals hold no slots.
uint32_t resolve_exactly(const Context& ctx, uint64_t handle, uint32_t type) {
  const ir::Image& image = ctx.generation->image();
  if (image.types.is_instance(ir::TypeId(type))) {
    const uint32_t id = find_instance(&ctx, handle, type);
    return id == 0 ? 0 : ctx.generation->areas()[id].data;
  }
  const AreaEntry* const area = area_of(ctx, ir::handle_segment(handle));
  if (area == nullptr || !ir::is_inside(handle)) return 0;
  const uint32_t offset = ir::handle_offset(handle);
  const bool found = ir::has_region_at(image.types, image.layouts, {ir::TypeId(area->type), 0},
                                       offset, {ir::TypeId(type), 0});
  return found ? area->data + offset : 0;
}

uint64_t resolve_string(const Context& ctx, uint64_t handle, uint32_t capacity, uint32_t unit) {
  const std::optional<ReferenceHome> home = find_home(ctx, handle);
  const uint32_t offset = ir::handle_offset(handle);
  if (!home || !home->reach.covers(offset, 1)) return 0;
  if (touches_slot(*home, offset, uint64_t{offset} + 1)) return 0;
  const uint32_t* const last = home->slots + home->slot_count;
  const uint32_t* const next = std::lower_bound(home->slots, last, offset);
  const uint32_t end = next == last ? home->reach.end : std::min(home->reach.end, *next);
  const uint32_t units = (end - offset) / unit;
  if (units == 0) return 0;
  return (home->data + offset) | uint64_t{std::min(capacity, units - 1)} << 32;
}

std::optional<uint64_t> handle_of(Context& ctx, uint32_t frame, uint32_t address) {
  if (const AreaEntry* area = area_at(ctx, address)) {
    return ir::make_handle(area->segment, address - area->data);
  }
  auto depth = static_cast<uint32_t>(ctx.call - ctx.calls_begin);
  uint32_t pou = ctx.pou;
  while (address < frame && depth > 0) {
    const CallRecord& record = ctx.calls_begin[--depth];
    frame = static_cast<uint32_t>(record.frame - ctx.memory);
    pou = record.pou;
  }
  if (address < frame) return ir::make_handle(0, address);
  return expose(ctx, depth, pou, frame, address);
}

uint32_t flat_of(const Context& ctx, uint64_t handle) {
  const uint32_t segment = ir::handle_segment(handle);
  const uint32_t offset = ir::handle_offset(handle);
  if (segment == 0) return offset;
  if (const AreaEntry* const area = area_of(ctx, segment)) return area->data + offset;
  const Exposure* const local = exposure_of(ctx, segment);
  return local == nullptr ? 0 : local->begin + offset;
}

uint64_t unflat(const Context& ctx, uint32_t address) {
  if (const AreaEntry* area = area_at(ctx, address)) {
    return ir::make_handle(area->segment, address - area->data);
  }
  for (uint32_t i = 0; i < ctx.exposure_count; ++i) {
    const Exposure& local = ctx.exposures[i];
    if (address - local.begin < local.size) {
      return ir::make_handle(local.segment, address - local.begin);
    }
  }
  return ir::make_handle(0, address);
}

void find_deepest_exposed(Context& ctx) {
  const bool any = ctx.exposure_count != 0;
  ctx.exposed = any ? ctx.calls_begin + ctx.exposures[ctx.exposure_count - 1].depth : nullptr;
}

void drop_exposed(Context& ctx, uint32_t depth) {
  while (ctx.exposure_count != 0 && ctx.exposures[ctx.exposure_count - 1].depth >= depth) {
    --ctx.exposure_count;
  }
  for (KnownReach& known : ctx.reaches) {
    if ((known.segment & ir::kExposedBit) != 0) known = {};
  }
  find_deepest_exposed(ctx);
}

}  // namespace vm
