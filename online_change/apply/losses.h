// Live values that a change would not carry over exactly.
#pragma once

#include <span>
#include <vector>

#include "online_change/apply/change.h"
#include "online_change/apply/lost_places.h"
#include "online_change/apply/transfer.h"
#include "online_change/diff/areas.h"
#include "vm/load/left_outputs.h"

namespace online_change {

// A value as a report shows it: a large one by its beginning.
std::string shortened(std::string value);
LiveLoss describe(const Loss& loss, const Transfer& transfer, const Areas& new_areas,
                  const uint8_t* memory);
// A reference of the old version at `at` whose target the change drops.
LiveLoss describe_broken(const Areas& old_areas, uint32_t at, ir::TypeId type,
                         std::span<const uint8_t> memory);
// The loss at the boundary, where only its place in the new version is known.
LiveLoss broken_at(const Areas& new_areas, uint32_t at);
// An output that nobody writes any more, and that is not zero (case 67).
bool is_on(const ir::Image& old_image, const vm::LeftOutput& output,
           std::span<const uint8_t> memory);
LiveLoss describe_left(const vm::LeftOutput& output, const ir::Image& old_image,
                       std::span<const uint8_t> memory);
// Why a value of the old version goes, from what the new one has at its path; null: nothing.
const char* why_lost(const ir::Symbol* next);
// Is a variable that becomes a constant what the constant is?
bool is_constant_already(const ir::Image& old_image, const ir::Symbol& before,
                         std::span<const uint8_t> memory, const ir::Image& new_image,
                         const ir::Symbol& next);
// Describes the values at these places as long as `rows` has fewer than `most`; how many there are.
uint64_t describe_lost(const LostPlaces& places, const ir::Image& old_image,
                       const ir::Image& new_image, std::span<const uint8_t> memory, size_t most,
                       std::vector<LiveLoss>& rows);
// People look at the first ones: values that are still as they were at the start come last.
void put_initial_last(std::span<LiveLoss> rows, const ir::Image& old_image);
// "`Main.x` is 300; as the new type it saturates to 127", and how many more.
base::Error would_lose(const LiveLoss& first, uint64_t more);

}  // namespace online_change
