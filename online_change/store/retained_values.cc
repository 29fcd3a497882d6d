#include "online_change/store/retained_values.h"

#include <algorithm>
#include <cstring>
#include <optional>
#include <vector>

#include "base/limits.h"
#include "ir/bytecode/renames.h"
#include "ir/types/handle.h"
#include "online_change/apply/live_value.h"
#include "online_change/diff/address_bits.h"
#include "online_change/diff/instance_match.h"
#include "online_change/diff/migrations.h"
#include "online_change/diff/place_moves.h"
#include "online_change/diff/reference_leaves.h"
#include "online_change/diff/type_diff.h"
#include "online_change/plan/area_steps.h"
#include "online_change/store/retain_map.h"
#include "online_change/store/retained_migrations.h"

namespace online_change {
namespace {

class Carrier {
 public:
  // `out`: what the values of `to` are where nothing is carried over. `code`: the version with the
  // migrations.
  Carrier(const ir::Image& from, base::ByteSpan values, const ir::Image& to, base::Bytes out,
          const ir::VerifiedImage& code)
      : from_(from),
        to_(to),
        code_(code),
        values_(values),
        from_map_(from),
        to_map_(to),
        conversions_(from, to),
        back_(to, from),
        out_(std::move(out)),
        carried_(out_.size(), false),
        given_(values_.size(), false) {}

  // From a trial; `as_changed` is what the change made of the values `before`.
  void go_back_to(base::ByteSpan before, base::ByteSpan as_changed) {
    back_way_ = true;
    before_ = before;
    as_changed_ = as_changed;
  }

  base::Result<CarriedValues> run() {
    using Direction = TypeDiffer::Direction;
    const bool there = !back_way_;
    const Migrations migrations = there ? Migrations(from_, to_, Migrations::Way::kThere)
                                        : Migrations(to_, from_, Migrations::Way::kBack);
    RetainedMigrations migrated(migrations, from_, to_, code_);
    TypeDiffer differ(from_, to_, there ? Direction::kForward : Direction::kBack, false,
                      migrations);
    const InstanceMatch match = match_instances(from_, to_);
    for (uint32_t id : match.new_order) {
      const uint32_t twin = match.old_of_new[id];
      if (twin == kNoInstance) continue;
      const ir::Instance& old_row = from_.instances[twin];
      const ir::Instance& new_row = to_.instances[id];
      const TypeDiff& diff = differ.area(old_row.type, new_row.type);
      if (differ.failed()) {
        return base::Error{base::Refusal::kTooMany,
                           "the types of the retained values differ in too many pieces"};
      }
      for (const DiffOp& op : diff.ops) {
        carry(op, old_row.data, new_row.data);
        if (op.kind == DiffKind::kMigrate) migrated.add(op, id, old_row.data, new_row.data);
      }
      migrated.end_instance();
    }
    keep_addresses();
    follow_references();
    CarriedValues carried;
    carried.alarm = migrated.run(values_, as_changed_, out_);
    carried.values = std::move(out_);
    return carried;
  }

 private:
  void carry(const DiffOp& op, uint32_t old_area, uint32_t new_area) {
    if (op.kind == DiffKind::kSame) {
      const bool dense = op.count == 1 || (op.from_stride == op.size && op.to_stride == op.size);
      const uint32_t count = dense ? 1 : op.count;
      const uint64_t size = dense ? uint64_t{op.size} * op.count : op.size;
      for (uint32_t i = 0; i < count; ++i) {
        copy(uint64_t{old_area} + op.from + uint64_t{i} * op.from_stride,
             uint64_t{new_area} + op.to + uint64_t{i} * op.to_stride, size);
      }
    } else if (op.kind == DiffKind::kConvert) {
      const ConvertedValues how = converted_by(op, old_area);
      for (uint32_t i = 0; i < op.count; ++i) {
        convert(how, i, new_area + op.to + i * op.to_stride, op.size);
      }
    }
  }

  void copy(uint64_t from, uint64_t to, uint64_t size) {
    to_map_.for_each(to, size, [&](uint64_t begin, uint64_t bytes, size_t target) {
      from_map_.for_each(from + (begin - to), bytes, [&](uint64_t at, uint64_t n, size_t source) {
        const size_t put = target + (at - from) - (begin - to);
        std::memcpy(out_.data() + put, values_.data() + source, n);
        std::fill_n(carried_.begin() + static_cast<std::ptrdiff_t>(put), n, true);
        std::fill_n(given_.begin() + static_cast<std::ptrdiff_t>(source), n, true);
      });
    });
  }

  // Value `index`, for the `size` bytes at `to`.
  void convert(const ConvertedValues& how, uint32_t index, uint32_t to, uint32_t size) {
    const uint32_t from = how.from + index * how.from_stride;
    const uint32_t old_size = conversions_.source_size(how);
    const auto source = from_map_.find(from, old_size);
    const auto target = to_map_.find(to, size);
    if (!source || !target) return;
    const base::ByteSpan value = values_.subspan(*source, old_size);
    std::fill_n(given_.begin() + static_cast<std::ptrdiff_t>(*source), old_size, true);
    if (back_way_ && is_as_converted(how, from, before_.subspan(*target, size), value)) return;
    (void)conversions_.convert(how, index, value.data(), to,
                               std::span(out_).subspan(*target, size));
    std::fill_n(carried_.begin() + static_cast<std::ptrdiff_t>(*target), size, true);
  }

  // Did the change make `value` of `before`, and nobody wrote it since?
  bool is_as_converted(const ConvertedValues& how, uint32_t from, base::ByteSpan before,
                       base::ByteSpan value) const {
    ConvertedValues there;
    there.old_type = how.new_type;
    there.new_type = how.old_type;
    base::Bytes converted(value.size());
    (void)back_.convert(there, 0, before.data(), from, converted);
    return std::equal(value.begin(), value.end(), converted.begin());
  }

  // Case 75: what no name has kept at %M and %Q stays at its address.
  void keep_addresses() {
    const std::vector<AddressedVariable> variables = addressed_variables(to_);
    if (variables.empty()) return;
    const AddressBits before(addressed_variables(from_));
    for (const AddressedVariable& variable : variables) {
      if (!variable.any_bits) continue;
      std::vector<size_t> made;
      for (GatheredPart part : before.parts_of(variable)) {
        const uint32_t size = std::max(part.size, 1u);
        const auto source = from_map_.find(part.from, size);
        const auto target = to_map_.find(uint64_t{variable.data} + part.within, size);
        if (!source || !target || given_[*source] || carried_[*target]) continue;
        part.from = static_cast<uint32_t>(*source);
        part.within = 0;
        gather({part}, values_.data(), 0, std::span(out_).subspan(*target, size));
        for (uint32_t i = 0; i < size; ++i) made.push_back(*target + i);
      }
      for (const size_t at : made) carried_[at] = true;
    }
  }

  void follow_references() {
    const PlaceMoves moves(from_, to_,
                           back_way_ ? PlaceMoves::Way::kBack : PlaceMoves::Way::kThere);
    if (moves.trivial()) return;
    for (const ReferenceLeaf& leaf : reference_leaves(to_)) {
      uint64_t handle = 0;
      const std::optional<size_t> at = to_map_.find(leaf.at, sizeof handle);
      if (!at || !carried_[*at]) continue;
      std::memcpy(&handle, out_.data() + *at, sizeof handle);
      if (handle == 0) continue;
      handle = moves.follow(handle, moves.target_in_new(to_, leaf.type)).handle;
      std::memcpy(out_.data() + *at, &handle, sizeof handle);
    }
  }

  const ir::Image& from_;
  const ir::Image& to_;
  const ir::VerifiedImage& code_;
  base::ByteSpan values_;
  RetainMap from_map_;
  RetainMap to_map_;
  Conversions conversions_;
  Conversions back_;
  bool back_way_ = false;
  base::ByteSpan before_;
  base::ByteSpan as_changed_;
  base::Bytes out_;
  std::vector<bool> carried_;  // by byte of out_
  std::vector<bool> given_;    // by byte of values_: a variable has it by its name
};

}  // namespace

base::Bytes initial_retained(const ir::Image& image) {
  const InitialData data(image);
  base::Bytes out;
  for (const ir::RetainRange& range : image.retain) {
    out.resize(out.size() + range.size);
    data.read(range.data, std::span(out).last(range.size));
  }
  return out;
}

base::Result<uint64_t> retained_bytes(const ir::Image& image) {
  uint64_t total = 0;
  for (const ir::RetainRange& range : image.retain) total += range.size;
  if (total <= base::kMaxRetainBytes) return total;
  return base::Error{base::Refusal::kTooLarge, std::to_string(total) +
                                                   " bytes of retained variables, more than " +
                                                   std::to_string(base::kMaxRetainBytes)};
}

void copy_retained(const ir::Image& image, const uint8_t* memory, base::Bytes& out) {
  out.clear();
  for (const ir::RetainRange& range : image.retain) {
    out.insert(out.end(), memory + range.data, memory + range.data + range.size);
  }
}

base::Result<CarriedValues> carry_retained(const ir::VerifiedImage& from, base::ByteSpan values,
                                           const ir::VerifiedImage& to) {
  const ir::OldUnderNewNames old(from.image(), to.image());
  return Carrier(old.image(), values, to.image(), initial_retained(to.image()), to).run();
}

base::Result<CarriedValues> carry_retained_back(const ir::VerifiedImage& from,
                                                base::ByteSpan values, const ir::VerifiedImage& to,
                                                base::ByteSpan before) {
  base::Result<CarriedValues> as_changed = carry_retained(to, before, from);
  if (!as_changed.ok()) return as_changed.error();
  const ir::OldUnderNewNames old(to.image(), from.image());
  Carrier carrier(from.image(), values, old.image(), base::Bytes(before.begin(), before.end()),
                  from);
  carrier.go_back_to(before, as_changed->values);
  return carrier.run();
}

}  // namespace online_change
