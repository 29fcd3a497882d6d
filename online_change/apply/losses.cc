#include "online_change/apply/losses.h"

#include <algorithm>
#include <utility>

#include "base/visible_text.h"
#include "ir/bytecode/name_index.h"
#include "ir/bytecode/symbols.h"
#include "ir/types/address_text.h"
#include "online_change/apply/live_value.h"
#include "online_change/diff/initial_data.h"
#include "online_change/diff/value_conversion.h"
#include "vm/exec/memory.h"
#include "vm/load/generation.h"

namespace online_change {
namespace {

constexpr const char* kBroken = "leads to what is dropped or retyped";
constexpr size_t kShownBytes = 120;

std::string value_text(const ir::Image& image, const ir::Symbol& symbol,
                       std::span<const uint8_t> memory) {
  return shortened(ir::format_value(image, symbol, memory));
}

constexpr const char* kOutside = "loses its elements outside of the new bounds";
constexpr const char* kConstantNow = "is replaced by a constant";
constexpr const char* kInputNow = "is replaced by an input";

// `next`: what the new version has at the path; null: nothing.
LiveLoss lost_value(std::string path, const ir::Image& old_image, const ir::Symbol& before,
                    const ir::Image& new_image, const ir::Symbol* next,
                    std::span<const uint8_t> memory) {
  LiveLoss out{std::move(path), value_text(old_image, before, memory), "", why_lost(next)};
  if (next != nullptr && next->constant) {
    base::Bytes initial(new_image.layouts[next->type].size);
    InitialData(new_image).read(next->data, initial);
    ir::Symbol alone = *next;
    alone.data = 0;
    out.new_value = value_text(new_image, alone, initial);
  } else if (next != nullptr && !next->input) {
    out.new_value = "its initial value";
  }
  return out;
}

}  // namespace

const char* why_lost(const ir::Symbol* next) {
  if (next == nullptr) return "is dropped";
  if (next->constant) return kConstantNow;
  return next->input ? kInputNow : "has no conversion";
}

bool is_constant_already(const ir::Image& old_image, const ir::Symbol& before,
                         std::span<const uint8_t> memory, const ir::Image& new_image,
                         const ir::Symbol& next) {
  base::Bytes initial(new_image.layouts[next.type].size);
  InitialData(new_image).read(next.data, initial);
  if (ir::same_value_type(old_image.types, old_image.layouts, before.type, new_image.types,
                          new_image.layouts, next.type)) {
    return std::equal(initial.begin(), initial.end(), memory.begin() + before.data);
  }
  if (classify(old_image.types, before.type, new_image.types, next.type) == Conversion::kNone) {
    return false;
  }
  const ConvertedValues how{before.data, 0, before.type, next.type, {}};
  base::Bytes converted(initial.size());
  const char* const loss = Conversions(old_image, new_image)
                               .convert(how, 0, memory.data() + before.data, next.data, converted);
  return loss == nullptr && converted == initial;
}

std::string shortened(std::string value) {
  if (value.size() <= kShownBytes) return value;
  return std::string(base::whole_characters(value, kShownBytes)) + "...";
}

LiveLoss describe(const Loss& loss, const Transfer& transfer, const Areas& new_areas,
                  const uint8_t* memory) {
  const UpdateStep& step = transfer.plan().steps[loss.step];
  const auto& how = *step.as<ConvertedValues>();
  const uint8_t* source = memory + how.from + size_t{loss.index} * how.from_stride;
  const uint32_t to = step.place(loss.index);
  base::Bytes converted(step.size);
  transfer.conversions().convert(how, loss.index, source, to, converted);
  LiveLoss row;
  row.path = new_areas.path_at(to);
  row.old_value = transfer.conversions().old_text(how, source);
  row.new_value = transfer.conversions().new_text(how, converted.data());
  row.what = loss.what;
  return row;
}

LiveLoss describe_broken(const Areas& old_areas, uint32_t at, ir::TypeId type,
                         std::span<const uint8_t> memory) {
  ir::Symbol symbol;
  symbol.data = at;
  symbol.type = type;
  return {old_areas.path_at(at), ir::format_value(old_areas.image(), symbol, memory), "NULL",
          kBroken};
}

LiveLoss broken_at(const Areas& new_areas, uint32_t at) {
  return {new_areas.path_at(at), "a reference", "NULL", kBroken};
}

bool is_on(const ir::Image& old_image, const vm::LeftOutput& output,
           std::span<const uint8_t> memory) {
  const auto value = memory.subspan(output.symbol.data, old_image.layouts[output.symbol.type].size);
  return std::any_of(value.begin(), value.end(), [](uint8_t byte) { return byte != 0; });
}

LiveLoss describe_left(const vm::LeftOutput& output, const ir::Image& old_image,
                       std::span<const uint8_t> memory) {
  return {output.path, value_text(old_image, output.symbol, memory), "",
          "is no longer written (" + ir::address_text(output.address) + ") and keeps its value"};
}

uint64_t describe_lost(const LostPlaces& places, const ir::Image& old_image,
                       const ir::Image& new_image, std::span<const uint8_t> memory, size_t most,
                       std::vector<LiveLoss>& rows) {
  uint64_t count = 0;
  const ir::NamesOnDemand old_names;
  const ir::NamesOnDemand new_names;
  for (const LostPlaces::Row& place : places.rows) {
    const std::vector<uint32_t>& group = places.groups[place.group];
    const uint64_t all = group.size() * place.elements;
    for (uint64_t i = 0; i < all; ++i) {
      if (!place.constant && rows.size() >= most) {
        count += all - i;
        break;
      }
      const uint32_t id = group[i / place.elements];
      std::string path = element_of(place.inside, i % place.elements);
      if (id != 0) path = old_image.instance_path(id) + path;
      const base::Result<ir::Symbol> before = ir::find_symbol(old_names.of(old_image), path);
      const base::Result<ir::Symbol> next = ir::find_symbol(new_names.of(new_image), path);
      const bool lost = !place.constant || !before.ok() || !next.ok() ||
                        !is_constant_already(old_image, *before, memory, new_image, *next);
      if (!lost) continue;
      ++count;
      if (rows.size() >= most || !before.ok()) continue;
      rows.push_back(lost_value(std::move(path), old_image, *before, new_image,
                                place.dropped || !next.ok() ? nullptr : &*next, memory));
      if (place.outside) rows.back().what = kOutside;
    }
  }
  return count;
}

void put_initial_last(std::span<LiveLoss> rows, const ir::Image& old_image) {
  base::Result<vm::Memory> initial = vm::Memory::reserve();
  if (!initial.ok()) return;
  vm::write_initial_data(old_image, initial->data());
  std::vector<LiveLoss> last;
  auto to = rows.begin();
  for (LiveLoss& row : rows) {
    base::Result<ir::Symbol> symbol = ir::find_symbol(old_image, row.path);
    if (symbol.ok() && value_text(old_image, *symbol, initial->view()) == row.old_value) {
      last.push_back(std::move(row));
    } else if (LiveLoss& place = *to++; &place != &row) {
      place = std::move(row);
    }
  }
  std::move(last.begin(), last.end(), to);
}

base::Error would_lose(const LiveLoss& first, uint64_t more) {
  std::string text = "`" + first.path + "` is " + first.old_value + "; it " +
                     (first.what == "inexact" ? "is " : "") + first.what;
  if (!first.new_value.empty()) text += " and would become " + first.new_value;
  if (more != 0) text += " (and " + std::to_string(more) + " more)";
  return {base::Refusal::kWouldLose, text + "; allow it with --allow-loss, or change the program"};
}

}  // namespace online_change
