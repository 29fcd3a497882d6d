// Who owns a byte of data memory: the areas of an image's live instances (row 0:
// the globals), and the variables inside them. Borrows the image.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "ir/bytecode/image.h"

namespace online_change {

// A part of the memory map that one type describes: an area, or a value in it.
struct Node {
  ir::TypeId type;
  uint32_t begin = 0;   // in data memory
  bool in_out = false;  // the address slot of an in-out of that type
};

class Areas {
 public:
  explicit Areas(const ir::Image& image);

  const ir::Image& image() const { return image_; }
  uint32_t begin(uint32_t id) const { return image_.instances[id].data; }
  uint32_t used(uint32_t id) const;      // bytes that variables take, holes included
  uint32_t capacity(uint32_t id) const;  // with slack
  // The instance in whose area `offset` lies.
  std::optional<uint32_t> instance_at(uint32_t offset) const;
  // Is a byte of [offset, offset + size) part of a variable of a live instance?
  bool owns(uint32_t offset, uint32_t size) const;

  // The member or element of `node` that covers `offset`; nullopt in holes and at
  // scalars. `path`, when given, is extended by ".name" or "[1,2]".
  std::optional<Node> child_at(Node node, uint32_t offset, std::string* path = nullptr) const;
  // Path of the scalar or string at `offset`; "" when there is none.
  std::string path_at(uint32_t offset) const;
  std::optional<Node> leaf_at(uint32_t offset) const;
  // Are there `count` neighbouring elements of exactly that type in one array?
  bool is_array_of(uint32_t offset, ir::TypeId element, uint32_t count) const;

 private:
  struct Place {  // of a member, by offset
    uint32_t begin = 0;
    uint32_t size = 0;
    uint32_t member = 0;
  };
  const std::vector<Place>& places(ir::TypeId type) const;
  std::optional<Node> descend(uint32_t offset, std::string* path) const;

  const ir::Image& image_;
  std::vector<uint32_t> by_offset_;  // live instances, by their area
  mutable std::unordered_map<ir::TypeId, std::vector<Place>> places_;
};

// A structure whose members can be looked at one by one. What lies on top of each other (a
// union) is one value as far as changes are concerned.
bool has_own_parts(const ir::TypeTable& types, ir::TypeId type);

// Bytes of a member inside its owner: the slot for in-outs and function blocks.
uint32_t member_size(const ir::Image& image, const ir::Member& member);

}  // namespace online_change
