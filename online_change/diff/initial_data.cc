#include "online_change/diff/initial_data.h"

#include <algorithm>
#include <cstring>

namespace online_change {
namespace {

uint64_t end_of(const ir::DataRun& run) { return uint64_t{run.offset} + run.bytes.size(); }

}  // namespace

size_t InitialData::first_run(uint32_t offset) const {
  auto found = std::partition_point(runs_.begin(), runs_.end(),
                                    [&](const ir::DataRun& run) { return end_of(run) <= offset; });
  return static_cast<size_t>(found - runs_.begin());
}

bool InitialData::has_run(uint32_t offset, uint32_t size) const {
  size_t at = first_run(offset);
  return at < runs_.size() && runs_[at].offset < uint64_t{offset} + size;
}

void InitialData::read(uint32_t offset, std::span<uint8_t> out) const {
  std::fill(out.begin(), out.end(), uint8_t{0});
  uint64_t end = uint64_t{offset} + out.size();
  for (size_t i = first_run(offset); i < runs_.size() && runs_[i].offset < end; ++i) {
    uint64_t from = std::max<uint64_t>(runs_[i].offset, offset);
    uint64_t until = std::min(end_of(runs_[i]), end);
    std::memcpy(out.data() + (from - offset), runs_[i].bytes.data() + (from - runs_[i].offset),
                until - from);
  }
}

bool InitialData::is_zero(uint32_t offset, uint32_t size) const {
  if (!has_run(offset, size)) return true;
  base::Bytes bytes(size);
  read(offset, bytes);
  return std::all_of(bytes.begin(), bytes.end(), [](uint8_t byte) { return byte == 0; });
}

bool InitialData::equal(uint32_t offset, const InitialData& other, uint32_t other_offset,
                        uint32_t size) const {
  return equal_bytes(offset, other, other_offset, size) == size;
}

uint32_t InitialData::equal_bytes(uint32_t offset, const InitialData& other, uint32_t other_offset,
                                  uint32_t size) const {
  constexpr uint32_t kChunk = 256;
  uint8_t mine[kChunk];
  uint8_t theirs[kChunk];
  if (!has_run(offset, size) && !other.has_run(other_offset, size)) return size;
  for (uint32_t done = 0; done < size;) {
    const uint32_t n = std::min(kChunk, size - done);
    read(offset + done, {mine, n});
    other.read(other_offset + done, {theirs, n});
    if (std::memcmp(mine, theirs, n) != 0) {
      return done + static_cast<uint32_t>(std::mismatch(mine, mine + n, theirs).first - mine);
    }
    done += n;
  }
  return size;
}

uint32_t InitialData::word(uint32_t offset) const {
  uint8_t bytes[4];
  read(offset, bytes);
  uint32_t value = 0;
  std::memcpy(&value, bytes, sizeof value);
  return value;
}

}  // namespace online_change
