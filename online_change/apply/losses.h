// Live values that a change would not carry over exactly.
#pragma once

#include <vector>

#include "online_change/apply/change.h"
#include "online_change/apply/transfer.h"
#include "online_change/diff/areas.h"

namespace online_change {

// A value as a report shows it: a large one by its beginning.
std::string shortened(std::string value);
LiveLoss describe(const Loss& loss, const Transfer& transfer, const Areas& new_areas,
                  const uint8_t* memory);
// A reference of the old version at `at` whose target the change drops.
LiveLoss describe_broken(const Areas& old_areas, uint32_t at, ir::TypeId type,
                         std::span<const uint8_t> memory);
// The same at the boundary, where only its place in the new version is known.
LiveLoss broken_at(const Areas& new_areas, uint32_t at);
// Values that go (dropped), and values of variables that keep their name but get a type
// without a rule from the old one.
// Describes them as long as `rows` has fewer than `most`; returns how many there are.
uint64_t values_without_place(const Plan& plan, const ir::Image& old_image,
                              std::span<const uint8_t> memory, size_t most,
                              std::vector<LiveLoss>& rows);
// "`Main.x` is 300; as the new type it saturates to 127", and how many more.
base::Error would_lose(const LiveLoss& first, uint64_t more);

}  // namespace online_change
