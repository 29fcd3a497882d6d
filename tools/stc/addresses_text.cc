#include "tools/stc/addresses_text.h"

#include <algorithm>
#include <tuple>
#include <unordered_set>
#include <vector>

#include "ir/bytecode/located_paths.h"
#include "ir/bytecode/symbols.h"
#include "ir/types/address_text.h"
#include "ir/types/shared_bytes.h"

namespace stc {
namespace {

struct AddressLine {
  ir::DirectAddress address;
  std::string path;
  std::string type;
};

// Bits of bytes that several variables share have no row in the process image.
void add_shared_bits(const ir::Image& image, std::vector<AddressLine>& lines) {
  for (const ir::Member& global : image.types[image.globals].members) {
    if (!ir::is_shared(image.types, global)) continue;
    const std::vector<ir::Member>& members = image.types[global.type].members;
    for (size_t i = 0; i < members.size(); ++i) {
      if (!ir::is_shared_bit(members[i])) continue;
      lines.push_back({ir::shared_address(image.types, global, i), members[i].name, "BOOL"});
    }
  }
}

const char* open_text(ir::DirectArea area) {
  if (area == ir::DirectArea::kInput) return "  AT %I*";
  return area == ir::DirectArea::kOutput ? "  AT %Q*" : "  AT %M*";
}

}  // namespace

std::string addresses_text(const ir::Image& image) {
  std::unordered_set<std::string> open;
  for (const ir::LocatedPath& row : ir::located_paths(image)) open.insert(row.path);
  std::vector<AddressLine> lines;
  for (const ir::IoBinding& row : image.io) {
    ir::Symbol symbol;
    symbol.data = row.data;
    symbol.type = row.type;
    lines.push_back({row.address, ir::path_of(image, symbol), image.types.text(row.type)});
  }
  add_shared_bits(image, lines);
  std::ranges::sort(lines, [](const AddressLine& a, const AddressLine& b) {
    return std::tuple(a.address.area, a.address.bit_offset, a.address.bit_size, a.path) <
           std::tuple(b.address.area, b.address.bit_offset, b.address.bit_size, b.path);
  });
  std::string out;
  for (const AddressLine& line : lines) {
    out += ir::address_text(line.address) + "  " + line.path + " : " + line.type;
    if (open.contains(line.path)) out += open_text(line.address.area);
    out += "\n";
  }
  return out;
}

}  // namespace stc
