// Handles at run time: what they name now, and locals that are exposed to them
// (docs/adr/0005-references-are-handles.md). Nothing here allocates.
#pragma once

#include <optional>

#include "ir/types/reach.h"
#include "vm/exec/context.h"

namespace vm {

// Bytes that a handle names: an area or an exposed local, from its beginning.
struct ReferenceHome {
  uint32_t data = 0;
  ir::Reach reach;  // of the variable that the handle was taken from; no bytes: it is lost
  const uint32_t* slots = nullptr;  // offsets that nothing may touch, sorted
  uint32_t slot_count = 0;
};

// What the handle's segment names; nullopt when it is gone or never was.
std::optional<ReferenceHome> find_home(const Context& ctx, uint64_t handle);
// The handle moved by `bytes`, with their sign (ir/types/reach.h). Keeps the variable in `known`.
uint64_t move_handle(const Context& ctx, uint64_t handle, uint64_t bytes, KnownReach& known);
// Data offset of `size` bytes of its variable that hold no slot; 0 when they are not there. Keeps
// the variable in `known`.
uint32_t resolve_bytes(const Context& ctx, uint64_t handle, uint32_t size, KnownReach& known);
// Are there no `size` bytes because the handle has left its variable?
bool has_left(const Context& ctx, uint64_t handle, uint32_t size);
// Data offset of exactly a value of a type with slots, or of the area of an instance; 0: none.
uint32_t resolve_exactly(const Context& ctx, uint64_t handle, uint32_t type);
// {offset, capacity} of a string with units of `unit` bytes; 0: not even an empty one is there.
uint64_t resolve_string(const Context& ctx, uint64_t handle, uint32_t capacity, uint32_t unit);
// ID of the instance of that type; 0: none.
uint32_t find_instance(const Context* ctx, uint64_t handle, uint32_t type);
// What a virtual call on that handle enters; instance 0: nothing, the handle or the row is missing.
struct VirtualCallee {
  uint32_t instance = 0;
  uint32_t pou = 0;
};
VirtualCallee find_target(const Context* ctx, uint64_t handle, uint32_t prototype);

// The handle of data offset `address`, which may lie in a frame of this execution: then the local
// there is exposed. nullopt: there is no room for one more.
std::optional<uint64_t> handle_of(Context& ctx, uint32_t frame, uint32_t address);
uint32_t flat_of(const Context& ctx, uint64_t handle);
uint64_t unflat(const Context& ctx, uint32_t address);

// The locals of POUs at that depth and above are gone.
void drop_exposed(Context& ctx, uint32_t depth);
void find_deepest_exposed(Context& ctx);

}  // namespace vm
