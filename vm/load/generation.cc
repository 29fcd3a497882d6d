#include "vm/load/generation.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <unordered_map>

#include "base/check.h"
#include "base/limits.h"
#include "ir/bytecode/image_sections.h"
#include "ir/types/handle.h"
#include "ir/types/inside.h"
#include "vm/load/decode.h"
#include "vm/native/program.h"

namespace vm {
namespace {

// Tries are not inside each other more often than there are instructions that begin one.
uint32_t tries_in(const ir::Image& image, const ir::LinkedPou& pou) {
  uint32_t count = 0;
  const ir::Unit* const end = image.code.data() + pou.first_unit + pou.unit_count;
  for (const ir::Unit* unit = end - pou.unit_count; unit < end; ++unit) {
    const ir::Opcode op = unit->opcode();
    if (op == ir::Opcode::TRY) ++count;
    if (ir::opcode_row(op).extended) ++unit;
  }
  return std::min(count, base::kMaxTryDepth);
}

bool same_section(const ir::VerifiedImage& a, const ir::VerifiedImage& b,
                  ir::ImageSection section) {
  const base::ByteSpan x = ir::section_of(a.encoded(), section);
  const base::ByteSpan y = ir::section_of(b.encoded(), section);
  return std::equal(x.begin(), x.end(), y.begin(), y.end());
}

// Do the same units become the same code? What a Decoder that goes by units reads beside them:
// types, their layouts and whose methods there are.
bool decodes_alike(const Generation& a, const Generation& b) {
  const std::vector<ir::LinkedPou>& x = a.image().pous;
  const std::vector<ir::LinkedPou>& y = b.image().pous;
  return a.bools().stay_clean() == b.bools().stay_clean() &&
         (a.image().types.is_one_with(b.image().types) ||
          same_section(a.verified(), b.verified(), ir::ImageSection::kTypes)) &&
         (a.image().layouts.is_one_with(b.image().layouts) ||
          same_section(a.verified(), b.verified(), ir::ImageSection::kLayouts)) &&
         std::equal(x.begin(), x.end(), y.begin(), y.end(),
                    [](const auto& p, const auto& q) { return p.self == q.self; });
}

bool same_units(const ir::Image& a, const ir::Image& b, uint32_t number) {
  const ir::LinkedPou& x = a.pous[number];
  const ir::LinkedPou& y = b.pous[number];
  return x.unit_count == y.unit_count &&
         std::equal(a.code.begin() + x.first_unit, a.code.begin() + x.first_unit + x.unit_count,
                    b.code.begin() + y.first_unit);
}

// Puts `found` after what is in `all`, and says where: the first and how many.
template <class T>
void append(std::vector<T>& all, const std::vector<T>& found, uint32_t& first, uint32_t& count) {
  first = static_cast<uint32_t>(all.size());
  count = static_cast<uint32_t>(found.size());
  all.insert(all.end(), found.begin(), found.end());
}

// Which of the variables hold slots; both lists are sorted.
std::vector<ir::Reach> reaches_with_slots(std::vector<ir::Reach> reaches,
                                          const std::vector<uint32_t>& slots) {
  size_t next = 0;
  for (ir::Reach& one : reaches) {
    while (next < slots.size() && slots[next] < one.begin) ++next;
    one.has_slots = next < slots.size() && slots[next] < one.end;
  }
  return reaches;
}

// Slots and variables are listed once per type.
void add_areas(const ir::Image& image, DataTables& out) {
  ir::SlotFinder finder(image.types, image.layouts);
  std::unordered_map<ir::TypeId, AreaEntry> known;
  out.areas.resize(image.instances.size());
  for (uint32_t id = 0; id < out.areas.size(); ++id) {
    const ir::Instance& row = image.instances[id];
    if (!row.live) continue;
    const ir::TypeLayout& layout = image.layouts[row.type];
    const auto [lists, added] = known.try_emplace(row.type);
    AreaEntry& area = lists->second;
    if (added) {
      const std::vector<uint32_t> slots = finder.inside(row.type);
      append(out.area_slots, slots, area.first_slot, area.slot_count);
      append(out.area_reaches,
             reaches_with_slots(ir::area_reaches(image.types, image.layouts, row.type), slots),
             area.first_reach, area.reach_count);
    }
    area.segment = ir::area_segment(id, row.generation);
    area.data = row.data;
    area.used = layout.used;
    area.capacity = std::max(layout.used, layout.area_capacity);
    area.type = row.type.index;
    out.areas[id] = area;
    out.areas_by_data.push_back(id);
  }
  std::sort(out.areas_by_data.begin(), out.areas_by_data.end(),
            [&](uint32_t a, uint32_t b) { return out.areas[a].data < out.areas[b].data; });
}

// Looked for once per type: a switch looks stamps up, and types have as many members as they like.
void add_stamps(const ir::Image& image, DataTables& out) {
  std::unordered_map<ir::TypeId, uint32_t> known;  // offset in the type; none: no stamp
  for (uint32_t i = 0; i < image.types.size(); ++i) {
    const std::vector<ir::Member>& members = image.types[ir::TypeId(i)].members;
    for (size_t member = 0; member < members.size(); ++member) {
      if (members[member].section != ir::Section::kStamp) continue;
      known[ir::TypeId(i)] = image.layouts[ir::TypeId(i)].member_offsets[member];
    }
  }
  out.stamps.resize(image.instances.size());
  for (uint32_t id = 0; id < out.stamps.size() && !known.empty(); ++id) {
    const auto found = known.find(image.instances[id].type);
    if (found != known.end()) out.stamps[id] = image.instances[id].data + found->second;
  }
}

std::shared_ptr<const DataTables> data_tables(const ir::Image& image) {
  auto out = std::make_shared<DataTables>();
  for (const ir::Instance& row : image.instances) {
    const bool callable = row.live && row.type != image.globals;
    out->instances.push_back(callable ? InstanceEntry{row.data, row.pou} : InstanceEntry{});
  }
  add_areas(image, *out);
  add_stamps(image, *out);
  return out;
}

bool has_native(const TierOptions& tier, uint32_t number) {
  return tier.tier != Tier::kInterpreter && (!tier.alternates || number % 2 == 0);
}

bool have_one_data(const ir::Image& a, const ir::Image& b) {
  return a.types.is_one_with(b.types) && a.layouts.is_one_with(b.layouts) &&
         a.instances.is_one_with(b.instances) && a.globals == b.globals;
}

}  // namespace

void write_initial_data(const ir::Image& image, uint8_t* memory) {
  for (const ir::DataRun& run : image.data) {
    std::memcpy(memory + run.offset, run.bytes.data(), run.bytes.size());
  }
}

void write_retained(const ir::Image& image, base::ByteSpan values, uint8_t* memory) {
  for (const ir::RetainRange& range : image.retain) {
    base::check(range.size <= values.size(), "retained values have the layout of their image");
    std::memcpy(memory + range.data, values.data(), range.size);
    values = values.subspan(range.size);
  }
}

uint64_t CodeNumber::next() {
  static std::atomic<uint64_t> last = 0;
  return last.fetch_add(1, std::memory_order_relaxed) + 1;
}

uint32_t Generation::pool_offset() const {
  return number_ % 2 == 0 ? ir::kConstPoolA : ir::kConstPoolB;
}

void Generation::write_pool(uint8_t* memory) const {
  const base::Bytes& pool = image().pool;
  if (!pool.empty()) std::memcpy(memory + pool_offset(), pool.data(), pool.size());
}

namespace {

// A table of few rows is so large, and its factor so chosen, that hardly any row lies elsewhere
// than at its first place.
constexpr size_t kFewRows = 256;
constexpr uint64_t kMostFactors = 64;

}  // namespace

OverrideTable::OverrideTable(const std::vector<ir::LinkedOverride>& all) {
  const bool few = all.size() <= kFewRows;
  rows.resize(std::bit_ceil((few ? 16 : 4) * all.size() + 1));
  mask = rows.size() - 1;
  size_t least = SIZE_MAX;
  uint64_t best = 0;
  for (uint64_t n = 0; n < (few ? kMostFactors : 1) && least != 0; ++n) {
    factor = 0x9e3779b97f4a7c15u * (2 * n + 1);
    const size_t elsewhere = fill(all);
    if (elsewhere >= least) continue;
    least = elsewhere;
    best = factor;
  }
  if (factor == best) return;
  factor = best;
  fill(all);
}

// How many rows lie elsewhere than at their first place.
size_t OverrideTable::fill(const std::vector<ir::LinkedOverride>& all) {
  std::fill(rows.begin(), rows.end(), OverrideEntry());
  size_t elsewhere = 0;
  for (const ir::LinkedOverride& row : all) {
    const uint64_t key = key_of(row.type.index, row.prototype);
    size_t at = first_place(key);
    if (rows[at].key != ~uint64_t{0}) ++elsewhere;
    while (rows[at].key != ~uint64_t{0}) at = (at + 1) & mask;
    rows[at] = {key, row.target};
  }
  return elsewhere;
}

base::Status Generation::place_code(const Generation* running, const TierOptions& tier,
                                    CodeTable& table) {
  const ir::Image& image = image_.image();
  const Decoder decoder(image, bools_.stay_clean(), tier);
  const bool alike =
      running != nullptr && decoder.goes_by_units() && decodes_alike(*running, *this);
  SlotLabel label{{}, SlotLabel::start_of(image_.digest())};
  std::vector<ir::Unit> code;
  for (uint32_t number = 0; number < image.pous.size(); ++number) {
    const ir::LinkedPou& pou = image.pous[number];
    const bool runs = running != nullptr && number < running->pous().size();
    const ir::Unit* place = runs ? running->pous()[number].code : nullptr;
    if (!alike || !runs || !same_units(running->image(), image, number)) {
      const auto first = image.code.begin() + pou.first_unit;
      decoder.run(pou, {first, first + pou.unit_count}, code);
      label.unit = SlotLabel::start_of(pou.identity);
      base::Result<const ir::Unit*> placed = slots_->place(number, pou.name, code, place, label);
      if (!placed.ok()) return placed.error();
      place = *placed;
      try_depth_ = std::max(try_depth_, tries_in(image, pou));
    }
    table.pous.push_back({place, place, nullptr, pou.frame_size, pou.recursion_depth});
  }
  if (alike) try_depth_ = std::max(try_depth_, running->try_depth_);
  const size_t in_use = running == nullptr ? 0 : running->pous().size();
  slots_->keep_first(static_cast<uint32_t>(std::max(in_use, table.pous.size())));
  return base::Ok{};
}

std::unique_ptr<Generation> Generation::build(ir::VerifiedImage verified, uint32_t number,
                                              uint8_t* memory, const TierOptions& tier) {
  auto slots = std::make_shared<CodeSlots>(UINT64_MAX / 16);
  return *build(std::move(verified), number, memory, std::move(slots), nullptr, tier);
}

base::Result<std::unique_ptr<Generation>> Generation::build(ir::VerifiedImage verified,
                                                            uint32_t number, uint8_t* memory,
                                                            std::shared_ptr<CodeSlots> slots,
                                                            const Generation* running,
                                                            const TierOptions& tier) {
  auto made = std::unique_ptr<Generation>(new Generation(std::move(verified), running));
  const ir::Image& image = made->image();
  made->number_ = number;
  made->slots_ = std::move(slots);
  const auto code = std::make_shared<CodeTable>();
  base::Status placed = made->place_code(running, tier, *code);
  if (!placed.ok()) return placed.error();
  const bool shares = running != nullptr && have_one_data(running->image(), image);
  made->data_ = shares ? running->data_ : data_tables(image);
  for (const ir::LinkedBound& bound : image.bounds) {
    made->bounds_.push_back({bound.low, bound.count, bound.stride});
  }
  for (const ir::Range& range : image.ranges) made->ranges_.push_back({range.low, range.high});
  made->write_pool(memory);
  code->clean_bools = made->bools_.stay_clean();
  const std::shared_ptr<const CodeTable> known = running == nullptr ? nullptr : running->code();
  const bool later =
      tier.making == Making::kBeside && (known == nullptr || known->native == nullptr);
  if (!later && has_native(tier, number)) {
    const bool alike = known != nullptr && known->clean_bools == code->clean_bools;
    code->native = native::Program::make(image, code->clean_bools, code->pous, tier,
                                         known == nullptr ? nullptr : known->native.get(), {},
                                         nullptr, alike ? &running->image() : nullptr);
  }
  made->code_->first = code;
  return made;
}

std::function<void(native::Progress&)> Generation::native_work(const TierOptions& tier,
                                                               std::optional<MadeCode> like) const {
  if (!has_native(tier, number_)) return [](native::Progress&) {};
  return [version = image_, code = code_, slots = slots_, tier,
          like = std::move(like)](native::Progress& progress) {
    if (progress.stop) return;
    const auto table = std::make_shared<CodeTable>(*code->first);
    const native::Program* const known = like ? like->table->native.get() : nullptr;
    const bool alike = known != nullptr && like->table->clean_bools == table->clean_bools;
    table->native =
        native::Program::make(version.image(), table->clean_bools, table->pous, tier, known, {},
                              &progress, alike ? &like->version.image() : nullptr);
    if (table->native == nullptr) return;
    if (progress.stop) {
      progress.stopped = table;
      return;
    }
    code->with_native = table;
    code->newest.store(&code->with_native, std::memory_order_release);
  };
}

}  // namespace vm
