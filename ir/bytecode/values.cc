// Values of variables as text and back, and the state of a whole program.
#include <algorithm>
#include <bit>

#include "base/limits.h"
#include "ir/bytecode/value_ranges.h"
#include "ir/types/handle.h"
#include "ir/types/inside.h"
#include "ir/types/shared_bytes.h"
#include "ir/types/value_text.h"

namespace ir {
namespace {

using Memory = std::span<const uint8_t>;

uint64_t load_bits(const TypeTable& types, TypeId type, const uint8_t* at) {
  const Scalar scalar = types.scalar(type);
  const uint32_t size = scalar_size(scalar);
  uint64_t bits = 0;
  std::memcpy(&bits, at, size);
  const uint32_t unused = 64 - 8 * size;
  return is_signed(scalar) ? static_cast<uint64_t>(static_cast<int64_t>(bits << unused) >> unused)
                           : bits;
}

// Bytes of a string up to its NUL, or to its capacity.
std::string_view string_bytes(const Type& type, const uint8_t* at) {
  const uint32_t unit = type.kind == Kind::kWstring ? 2 : 1;
  uint32_t length = 0;
  while (length < type.capacity && (at[length * unit] != 0 || at[length * unit + unit - 1] != 0)) {
    ++length;
  }
  return {reinterpret_cast<const char*>(at), size_t{length} * unit};
}

class Formatter {
 public:
  Formatter(const Image& image, Memory memory, size_t max_bytes)
      : image_(image), memory_(memory), max_bytes_(max_bytes) {}

  std::string text(TypeId id, uint32_t data, uint32_t depth) {
    const Type& type = image_.types[id];
    if (depth > base::kMaxNesting || !inside(id, data)) return "?";
    if (type.kind == Kind::kString) return string_text(string_bytes(type, &memory_[data]));
    if (type.kind == Kind::kWstring) return wstring_text(string_bytes(type, &memory_[data]));
    if (type.kind == Kind::kArray) return array(type, data, depth);
    if (image_.types.has_members(id)) return members(id, data, depth);
    const uint64_t bits = load_bits(image_.types, id, &memory_[data]);
    if (is_reference(type.kind)) return reference(bits, type.base);
    return scalar_text(image_.types, id, bits);
  }

  std::string bit(uint32_t data, uint8_t mask) const {
    if (data >= memory_.size()) return "?";
    return (memory_[data] & mask) != 0 ? "TRUE" : "FALSE";
  }

 private:
  // By the variable that it names, so that the text stays when that moves.
  std::string reference(uint64_t handle, TypeId target) const {
    const uint32_t segment = handle_segment(handle);
    const uint32_t id = segment_id(segment);
    if (handle == 0) return "NULL";
    if (id >= image_.instances.size()) return "ref";
    const Instance& row = image_.instances[id];
    if (!row.live || area_segment(id, row.generation) != segment) return "ref";
    return reference_text(image_.instance_path(id),
                          handle_text(image_.types, image_.layouts, row.type, handle, target));
  }

  bool inside(TypeId id, uint32_t data) const {
    return uint64_t{data} + image_.layouts[id].size <= memory_.size();
  }

  // Text of a part that may be an instance's slot.
  std::string part(TypeId id, uint32_t data, uint32_t depth) {
    if (!image_.types.is_instance(id)) return text(id, data, depth);
    const uint32_t instance = initial_id(image_, data);
    if (instance == 0 || instance >= image_.instances.size()) return "?";
    return text(id, image_.instances[instance].data, depth);
  }

  std::string array(const Type& type, uint32_t data, uint32_t depth) {
    uint64_t count = 1;
    for (const Dimension& dim : type.dims) count *= dim.count();
    std::string out = "[";
    for (uint64_t i = 0; i < count && out.size() <= max_bytes_; ++i) {
      if (i != 0) out += ", ";
      out += part(type.base, data + static_cast<uint32_t>(i * image_.layouts[type.base].size),
                  depth + 1);
    }
    return out + "]";
  }

  std::string members(TypeId id, uint32_t data, uint32_t depth) {
    const Type& type = image_.types[id];
    std::string out = "(";
    for (size_t i = 0; i < type.members.size() && out.size() <= max_bytes_; ++i) {
      if (!is_listed(type.members[i])) continue;
      if (out.size() > 1) out += ", ";
      const uint32_t at = data + image_.layouts[id].member_offsets[i];
      const uint8_t mask = bit_mask_of(image_.types, id, type.members[i]);
      out += type.members[i].name + " := " +
             (mask == 0 ? part(type.members[i].type, at, depth + 1) : bit(at, mask));
    }
    return out + ")";
  }

  const Image& image_;
  Memory memory_;
  size_t max_bytes_;
};

base::Result<base::Bytes> string_value(const Type& type, std::string_view text) {
  const bool wide = type.kind == Kind::kWstring;
  base::Result<std::string> parsed = wide ? parse_wstring(text) : parse_string(text);
  if (!parsed) return parsed.error();
  const size_t unit = wide ? 2 : 1;
  const size_t length = parsed.value().size() / unit;
  if (length > type.capacity) {
    return base::Error{base::Refusal::kBadValue, "text of " + std::to_string(length) +
                                                     " characters, the variable holds " +
                                                     std::to_string(type.capacity)};
  }
  base::Bytes bytes(parsed.value().begin(), parsed.value().end());
  bytes.resize((size_t{type.capacity} + 1) * unit);
  return bytes;
}

void add_leaf_value(const Image& image, const Symbol& symbol, Memory memory,
                    base::ByteWriter& out) {
  const Type& type = image.types[symbol.type];
  const uint8_t* at = &memory[symbol.data];
  if (type.kind == Kind::kString || type.kind == Kind::kWstring) {
    out.text(string_bytes(type, at));
  } else {
    out.raw({at, scalar_size(image.types.scalar(symbol.type))});
  }
}

}  // namespace

std::string format_value(const Image& image, const Symbol& symbol,
                         std::span<const uint8_t> memory) {
  return format_value(image, symbol, memory, SIZE_MAX);
}

std::string format_value(const Image& image, const Symbol& symbol, std::span<const uint8_t> memory,
                         size_t max_bytes) {
  Formatter formatter(image, memory, max_bytes);
  if (symbol.bit_mask != 0) return formatter.bit(symbol.data, symbol.bit_mask);
  return formatter.text(symbol.type, symbol.data, 0);
}

base::Result<base::Bytes> parse_value(const Image& image, const Symbol& symbol,
                                      std::string_view text) {
  if (symbol.bit_mask == 0) return parse_value(image, symbol.type, text);
  base::Result<base::Bytes> bit = parse_value(image, image.types.elementary(Kind::kBool), text);
  if (bit.ok() && (*bit)[0] != 0) (*bit)[0] = symbol.bit_mask;
  return bit;
}

base::Result<base::Bytes> parse_value(const Image& image, TypeId id, std::string_view text) {
  const Type& type = image.types[id];
  if (type.kind == Kind::kString || type.kind == Kind::kWstring) return string_value(type, text);
  if (!image.types.is_scalar(id)) {
    return base::Error{base::Refusal::kBadValue, "a value of `" + image.types.text(id) +
                                                     "` has no literal; name one of its parts"};
  }
  base::Result<uint64_t> bits = parse_scalar(image.types, id, text);
  if (!bits) return bits.error();
  base::ByteWriter out;
  out.u64(bits.value());
  base::Bytes bytes = out.take();
  bytes.resize(scalar_size(image.types.scalar(id)));
  return bytes;
}

std::string state_text(const Image& image, std::span<const uint8_t> memory) {
  std::string out;
  for_each_leaf(image, [&](const std::string& path, const Symbol& symbol) {
    out += path + "=" + format_value(image, symbol, memory) + "\n";
  });
  return out;
}

base::Digest state_hash(const Image& image, std::span<const uint8_t> memory) {
  base::ByteWriter out;
  for_each_leaf(image, [&](const std::string& path, const Symbol& symbol) {
    out.text(path);
    add_leaf_value(image, symbol, memory, out);
  });
  return base::sha256(out.bytes());
}

}  // namespace ir
