// Steps of charts are variables (docs/adr/0009-sfc.md), and mostly changes know no more of them.
// But a step that goes can have its token taken over by one that was there before: its rule
// names it, `{renamed from := 'Old'}`, though it has a place of its own (case 38).
#pragma once

#include <cstdint>

#include "ir/bytecode/image.h"

namespace online_change {

bool is_step(const ir::Image& image, ir::TypeId type);

// The step of `old_type` that goes and is taken over by step `member` of `new_type`; -1: none.
// The old image has the new one's names.
int32_t step_taken_over(const ir::Image& old_image, ir::TypeId old_type, const ir::Image& new_image,
                        ir::TypeId new_type, const ir::Member& member);
// The step of `new_type` that takes over step `number` of `old_type`; -1: none.
int32_t taker_of_step(const ir::Image& old_image, ir::TypeId old_type, const ir::Image& new_image,
                      ir::TypeId new_type, uint32_t number);

}  // namespace online_change
