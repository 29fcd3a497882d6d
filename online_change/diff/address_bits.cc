#include "online_change/diff/address_bits.h"

#include <algorithm>
#include <cstring>
#include <tuple>

#include "ir/types/location.h"
#include "ir/types/natural_layout.h"
#include "ir/types/shared_bytes.h"
#include "online_change/diff/areas.h"

namespace online_change {
namespace {

using ir::TypeId;

bool keeps_bytes(const ir::DirectAddress& address) {
  return address.area == ir::DirectArea::kMarker || address.area == ir::DirectArea::kOutput;
}

// Finds the runs of one variable. No type contains itself.
class RunFinder {
 public:
  explicit RunFinder(const ir::Image& image)
      : image_(image), natural_(ir::natural_layouts(image.types)) {}

  void add(const ir::IoBinding& row, std::vector<AddressRun>& out) {
    out_ = &out;
    area_ = row.address.area;
    const uint64_t bools = ir::located_bools(image_.types, row.type, row.address);
    for (uint64_t i = 0; i < bools; ++i) {
      out.push_back({area_, row.address.bit_offset + i, 1, row.data + static_cast<uint32_t>(i),
                     true});
    }
    if (bools == 0) bytes(row.type, row.address.bit_offset, row.data);
  }

 private:
  void bytes(TypeId id, uint64_t bit, uint32_t data) {
    const ir::Type& type = image_.types[id];
    if (type.kind == ir::Kind::kArray) {
      const uint32_t stride = image_.layouts[type.base].size;
      const uint32_t step = natural_[type.base].size;
      if (image_.types.is_scalar(type.base)) return run(bit, image_.layouts[id].size, data);
      for (uint64_t i = 0; i < type.element_count(); ++i) {
        bytes(type.base, bit + i * step * 8, data + static_cast<uint32_t>(i * stride));
      }
    } else if (has_own_parts(image_.types, id)) {
      for (size_t i = 0; i < type.members.size(); ++i) {
        bytes(type.members[i].type, bit + uint64_t{natural_[id].member_offsets[i]} * 8,
              data + image_.layouts[id].member_offsets[i]);
      }
    } else {
      run(bit, std::min(image_.layouts[id].size, natural_[id].size), data);
    }
  }

  void run(uint64_t bit, uint32_t size, uint32_t data) {
    AddressRun* last = out_->empty() ? nullptr : &out_->back();
    if (last != nullptr && !last->alone && last->end() == bit &&
        last->data + last->bits / 8 == data) {
      last->bits += uint64_t{size} * 8;
    } else {
      out_->push_back({area_, bit, uint64_t{size} * 8, data, false});
    }
  }

  const ir::Image& image_;
  ir::Layouts natural_;
  ir::DirectArea area_ = ir::DirectArea::kNone;
  std::vector<AddressRun>* out_ = nullptr;
};

uint8_t mask_of(uint64_t bit) { return static_cast<uint8_t>(1u << bit % 8); }

// Where a bit is: in which byte of data memory, or after the first of the run.
uint32_t byte_of(const AddressRun& run, uint64_t bit) {
  return run.alone ? 0 : static_cast<uint32_t>((bit - run.bit) / 8);
}

void add_shared(const AddressRun& from, const AddressRun& to, uint32_t within, Gather& out) {
  const uint64_t begin = std::max(from.bit, to.bit);
  const uint64_t end = std::min(from.end(), to.end());
  if (!from.alone && !to.alone) {
    out.push_back({from.data + byte_of(from, begin), within + byte_of(to, begin),
                   static_cast<uint32_t>((end - begin) / 8)});
    return;
  }
  out.push_back({from.data + byte_of(from, begin), within + byte_of(to, begin), 0,
                 from.alone ? GatheredPart::kBool : mask_of(begin),
                 to.alone ? GatheredPart::kBool : mask_of(begin)});
}

// Sorted, and views of bytes that are known left out.
std::vector<AddressRun> disjoint(std::vector<AddressRun> all) {
  std::stable_sort(all.begin(), all.end(), [](const AddressRun& a, const AddressRun& b) {
    return std::tuple(a.area, a.bit) < std::tuple(b.area, b.bit);
  });
  std::vector<AddressRun> out;
  for (AddressRun run : all) {
    const bool meets = !out.empty() && out.back().area == run.area;
    const uint64_t end = meets ? out.back().end() : 0;
    if (run.bit < end) {
      const uint64_t bytes = (end - run.bit + 7) / 8;
      if (run.alone || bytes * 8 >= run.bits) continue;
      run.bit += bytes * 8;
      run.bits -= bytes * 8;
      run.data += static_cast<uint32_t>(bytes);
    }
    out.push_back(run);
  }
  return out;
}

}  // namespace

bool takes_any_bits(const ir::TypeTable& types, TypeId id) {
  const ir::Type& type = types[id];
  if (type.kind == ir::Kind::kArray) return takes_any_bits(types, type.base);
  if (ir::is_structure(type.kind)) {
    return std::all_of(type.members.begin(), type.members.end(), [&](const ir::Member& member) {
      return takes_any_bits(types, member.type);
    });
  }
  if (type.kind == ir::Kind::kString || type.kind == ir::Kind::kWstring) return true;
  return ir::is_elementary(type.kind) && type.kind != ir::Kind::kBool;
}

std::vector<AddressedVariable> addressed_variables(const ir::Image& image) {
  std::vector<AddressedVariable> out;
  if (std::none_of(image.io.begin(), image.io.end(),
                   [](const ir::IoBinding& row) { return keeps_bytes(row.address); })) {
    return out;
  }
  const Areas areas(image);
  // The variables of shared bytes, by place.
  const ir::Type& globals = image.types[image.globals];
  const uint32_t begin = areas.begin(0);
  for (size_t i = 0; i < globals.members.size(); ++i) {
    const ir::Member& member = globals.members[i];
    if (!ir::is_shared(image.types, member)) continue;
    out.push_back({begin + image.layouts[image.globals].member_offsets[i],
                   image.layouts[member.type].size, member.name, {},
                   takes_any_bits(image.types, member.type)});
  }
  std::sort(out.begin(), out.end(),
            [](const auto& a, const auto& b) { return a.data < b.data; });
  const auto shared = static_cast<ptrdiff_t>(out.size());
  RunFinder finder(image);
  for (const ir::IoBinding& row : image.io) {
    if (!keeps_bytes(row.address)) continue;
    const auto around = std::partition_point(
        out.begin(), out.begin() + shared, [&](const AddressedVariable& one) {
          return uint64_t{one.data} + one.size <= row.data;
        });
    if (around != out.begin() + shared && around->data <= row.data) {
      finder.add(row, around->runs);
      continue;
    }
    AddressedVariable variable{row.data, image.layouts[row.type].size, "", {}, false};
    finder.add(row, variable.runs);
    if (const auto id = areas.instance_at(row.data)) {
      variable.path = image.instance_path(*id);
      areas.child_at({image.instances[*id].type, areas.begin(*id), false}, row.data,
                     &variable.path);
    }
    const bool bits = !variable.runs.empty() && variable.runs[0].alone;
    variable.any_bits = bits || takes_any_bits(image.types, row.type);
    out.push_back(std::move(variable));
  }
  for (auto one = out.begin(); one != out.begin() + shared; ++one) {
    one->runs = disjoint(std::move(one->runs));
  }
  return out;
}

void TakenBits::add(Range range) {
  auto next = ranges_.upper_bound(range.begin);
  if (next != ranges_.begin() && std::prev(next)->second >= range.begin) {
    range.begin = (--next)->first;
  }
  while (next != ranges_.end() && next->first <= range.end) {
    range.end = std::max(range.end, next->second);
    next = ranges_.erase(next);
  }
  ranges_.emplace(range.begin, range.end);
}

void TakenBits::add(const Gather& parts) {
  for (const GatheredPart& part : parts) {
    const bool bit = part.size == 0 && part.from_mask != GatheredPart::kBool;
    if (bit && (bits_[part.from] |= part.from_mask) != 0xff) continue;
    add({part.from, uint64_t{part.from} + std::max(part.size, 1u)});
  }
}

bool TakenBits::all(uint64_t begin, uint64_t end) const {
  const auto behind = ranges_.upper_bound(begin);
  return behind != ranges_.begin() && std::prev(behind)->second >= end;
}

AddressBits::AddressBits(const std::vector<AddressedVariable>& variables) {
  std::vector<AddressRun> all;
  for (const AddressedVariable& variable : variables) {
    all.insert(all.end(), variable.runs.begin(), variable.runs.end());
  }
  runs_ = disjoint(std::move(all));
}

Gather AddressBits::parts_of(const AddressedVariable& variable) const {
  Gather out;
  for (const AddressRun& to : variable.runs) {
    auto next = std::partition_point(runs_.begin(), runs_.end(), [&](const AddressRun& from) {
      return std::tuple(from.area, from.end()) <= std::tuple(to.area, to.bit);
    });
    for (; next != runs_.end() && next->area == to.area && next->bit < to.end(); ++next) {
      add_shared(*next, to, to.data - variable.data, out);
    }
  }
  return out;
}

void gather(const Gather& parts, const uint8_t* memory, uint32_t first, std::span<uint8_t> out) {
  const uint64_t end = uint64_t{first} + out.size();
  for (const GatheredPart& part : parts) {
    const uint64_t begin = std::max(part.within, first);
    const uint64_t behind = std::min(uint64_t{part.within} + std::max(part.size, 1u), end);
    if (begin >= behind) continue;
    uint8_t* to = out.data() + (begin - first);
    if (part.size != 0) {
      std::memcpy(to, memory + part.from + (begin - part.within), behind - begin);
      continue;
    }
    const uint8_t source = memory[part.from];
    const bool on = part.from_mask == GatheredPart::kBool ? source != 0
                                                          : (source & part.from_mask) != 0;
    if (part.to_mask == GatheredPart::kBool) {
      *to = on ? 1 : 0;
    } else {
      *to = static_cast<uint8_t>(on ? *to | part.to_mask : *to & ~part.to_mask);
    }
  }
}

}  // namespace online_change
