#include "online_change/apply/losses.h"

#include <algorithm>
#include <utility>

#include "ir/bytecode/symbols.h"
#include "ir/types/address_text.h"
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

LiveLoss lost_value(const FateRow& row, std::string path, const ir::Image& old_image,
                    std::span<const uint8_t> memory) {
  base::Result<ir::Symbol> symbol = ir::find_symbol(old_image, path);
  std::string value = symbol.ok() ? value_text(old_image, *symbol, memory) : row.old_type;
  if (row.fate == Fate::kDropped) return {std::move(path), std::move(value), "", "is dropped"};
  return {std::move(path), std::move(value), "its initial value", "has no conversion"};
}

}  // namespace

std::string shortened(std::string value) {
  if (value.size() <= kShownBytes) return value;
  size_t end = kShownBytes;
  while (end > 0 && (static_cast<uint8_t>(value[end]) & 0xc0) == 0x80) --end;  // UTF-8
  return value.substr(0, end) + "...";
}

LiveLoss describe(const Loss& loss, const Transfer& transfer, const Areas& new_areas,
                  const uint8_t* memory) {
  const UpdateStep& step = transfer.plan().steps[loss.step];
  const uint8_t* source = memory + step.from + size_t{loss.index} * step.from_stride;
  base::Bytes converted(step.size);
  transfer.conversions().convert(step, loss.index, source, converted);
  LiveLoss row;
  row.path = new_areas.path_at(step.to + loss.index * step.to_stride);
  row.old_value = transfer.conversions().old_text(step, source);
  row.new_value = transfer.conversions().new_text(step, converted.data());
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
          "is written by nobody any more (" + ir::address_text(output.address) +
              ") and stays so"};
}

void describe_lost(const Plan& plan, const LostPlaces& places, const ir::Image& old_image,
                   std::span<const uint8_t> memory, size_t most, std::vector<LiveLoss>& rows) {
  for (const LostPlaces::Row& place : places.rows) {
    for (const uint32_t id : places.groups[place.group]) {
      if (rows.size() >= most) return;
      std::string path = id == 0 ? place.inside : old_image.instance_path(id) + place.inside;
      rows.push_back(lost_value(plan.fates[place.fate], std::move(path), old_image, memory));
    }
  }
}

void put_initial_last(std::span<LiveLoss> rows, const ir::Image& old_image) {
  base::Result<vm::Memory> initial = vm::Memory::reserve();
  if (!initial.ok()) return;
  vm::write_initial_data(old_image, initial->data());
  std::stable_partition(rows.begin(), rows.end(), [&](const LiveLoss& row) {
    base::Result<ir::Symbol> symbol = ir::find_symbol(old_image, row.path);
    return !symbol.ok() || value_text(old_image, *symbol, initial->view()) != row.old_value;
  });
}

base::Error would_lose(const LiveLoss& first, uint64_t more) {
  std::string text = "`" + first.path + "` is " + first.old_value + "; it " + first.what;
  if (!first.new_value.empty()) text += " and would become " + first.new_value;
  if (more != 0) text += " (and " + std::to_string(more) + " more)";
  return {base::Refusal::kWouldLose, text + "; allow it with --allow-loss, or change the program"};
}

}  // namespace online_change
