#include "vm/runtime/safe_outputs.h"

#include <algorithm>

namespace vm {

SafeOutputs::SafeOutputs(const ir::Image& image)
    : value_(image.output_bytes), held_(image.output_bytes) {
  for (const ir::SafeOutput& row : image.safe) {
    if (row.kind == ir::SafeKind::kValue) {
      put(row, row.value, UINT64_MAX, value_);
      continue;
    }
    put(row, UINT64_MAX, UINT64_MAX, held_);
    if (row.kind == ir::SafeKind::kHoldThenValue) holds_.push_back({row});
  }
}

uint64_t SafeOutputs::take(const ir::SafeOutput& row, std::span<const uint8_t> bytes) {
  const uint32_t byte = row.bit_offset / 8;
  if (row.bits == 1) return bytes[byte] >> (row.bit_offset % 8) & 1u;
  uint64_t bits = 0;
  for (uint32_t i = 0; i < row.bits / 8; ++i) bits |= uint64_t{bytes[byte + i]} << (8 * i);
  return bits;
}

void SafeOutputs::put(const ir::SafeOutput& row, uint64_t value, uint64_t mask,
                      std::span<uint8_t> bytes) {
  const uint32_t byte = row.bit_offset / 8;
  const uint32_t shift = row.bits == 1 ? row.bit_offset % 8 : 0;
  if (row.bits == 1) mask &= 1;
  for (uint32_t i = 0; i < (row.bits + 7) / 8; ++i) {
    const auto changed = static_cast<uint8_t>((mask >> (8 * i) & 0xff) << shift);
    const auto wanted = static_cast<uint8_t>((value >> (8 * i) & 0xff) << shift);
    bytes[byte + i] = static_cast<uint8_t>((bytes[byte + i] & ~changed) | (wanted & changed));
  }
}

void SafeOutputs::apply(std::span<const uint8_t> mask, int64_t now_ns, std::span<uint8_t> outputs) {
  for (size_t i = 0; i < outputs.size(); ++i) {
    const auto changed = static_cast<uint8_t>(mask[i] & ~held_[i]);
    outputs[i] = static_cast<uint8_t>((outputs[i] & ~changed) | (value_[i] & changed));
  }
  for (Hold& hold : holds_) {
    const uint64_t bits = take(hold.row, mask) & ~hold.bits;
    if (bits == 0) continue;
    hold.bits |= bits;
    hold.until_ns = std::max(hold.until_ns, std::max<int64_t>(now_ns + hold.row.hold_ns, 1));
  }
}

bool SafeOutputs::expire(int64_t now_ns, std::span<uint8_t> outputs, std::span<uint8_t> mask) {
  bool any = false;
  for (Hold& hold : holds_) {
    if (hold.until_ns == 0 || hold.until_ns > now_ns) continue;
    put(hold.row, hold.row.value, hold.bits, outputs);
    put(hold.row, UINT64_MAX, hold.bits, mask);
    hold.until_ns = 0;
    hold.bits = 0;
    any = true;
  }
  return any;
}

int64_t SafeOutputs::next_ns() const {
  int64_t next = INT64_MAX;
  for (const Hold& hold : holds_) {
    if (hold.until_ns != 0) next = std::min(next, hold.until_ns);
  }
  return next;
}

void SafeOutputs::forget_holds() {
  for (Hold& hold : holds_) hold = {hold.row};
}

void SafeOutputs::adopt_holds(const SafeOutputs& previous) {
  forget_holds();
  for (Hold& hold : holds_) {
    for (const Hold& old : previous.holds_) {
      const bool same = old.row.bit_offset == hold.row.bit_offset &&
                        old.row.bits == hold.row.bits && old.row.value == hold.row.value &&
                        old.row.hold_ns == hold.row.hold_ns;
      if (same) hold = old;
    }
  }
}

SafeOutputs::AtTheEnd SafeOutputs::at_the_end(const ir::Image& image) {
  AtTheEnd end{base::Bytes(image.output_bytes), base::Bytes(image.output_bytes)};
  for (const ir::SafeOutput& row : image.safe) {
    if (row.kind == ir::SafeKind::kHold) {
      put(row, UINT64_MAX, UINT64_MAX, end.held);
    } else {
      put(row, row.value, UINT64_MAX, end.value);
    }
  }
  return end;
}

}  // namespace vm
