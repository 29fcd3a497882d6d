#include "tests/unit/store/sim_storage.h"

#include <algorithm>
#include <cstring>

namespace sim {
namespace {

base::Error error(std::string_view call, std::string_view name) {
  return {base::Refusal::kFileUnwritable, std::string(name) + ": " + std::string(call) + " failed"};
}

}  // namespace

SimStorage::File* SimStorage::find(std::string_view name) {
  for (File& file : files_) {
    if (file.name == name) return &file;
  }
  return nullptr;
}

bool SimStorage::failing(std::string_view call, Failure& how) {
  how = fails ? fails(call) : Failure::kNone;
  return how != Failure::kNone;
}

base::Status SimStorage::open(std::string_view name, uint64_t size) {
  if (before_call) before_call();
  Failure how;
  if (failing("open", how)) return error("open", name);
  File* file = find(name);
  uint64_t total = 0;
  for (const File& each : files_) total += each.cache.size();
  const uint64_t rounded = (size + kSector - 1) / kSector * kSector;
  const uint64_t before = file == nullptr ? 0 : file->cache.size();
  if (rounded > before && total + rounded - before > full_at) return error("open", name);
  if (file == nullptr) {
    files_.push_back({std::string(name), {}, {}});
    file = &files_.back();
  }
  if (file->cache.size() < rounded) {
    file->cache.resize(rounded);
    file->disk.resize(rounded);
  }
  return base::Ok{};
}

base::Result<uint64_t> SimStorage::size(std::string_view name) {
  File* file = find(name);
  if (file == nullptr) return base::Error{base::Refusal::kFileNotFound, std::string(name)};
  return uint64_t{file->cache.size()};
}

base::Result<base::Bytes> SimStorage::read(std::string_view name, uint64_t offset, uint64_t size) {
  Failure how;
  if (failing("read", how)) return error("read", name);
  File* file = find(name);
  if (file == nullptr) return base::Error{base::Refusal::kFileNotFound, std::string(name)};
  const uint64_t begin = std::min<uint64_t>(offset, file->cache.size());
  const uint64_t end = begin + std::min<uint64_t>(size, file->cache.size() - begin);
  return base::Bytes(file->cache.begin() + static_cast<std::ptrdiff_t>(begin),
                     file->cache.begin() + static_cast<std::ptrdiff_t>(end));
}

void SimStorage::put(size_t file, uint64_t sector, const uint8_t* bytes, uint64_t begin,
                     uint64_t end) {
  uint8_t* const at = files_[file].cache.data() + sector * kSector;
  std::memcpy(at + begin, bytes, end - begin);
  auto same = [&](const Dirty& row) { return row.file == file && row.sector == sector; };
  auto found = std::find_if(dirty_.begin(), dirty_.end(), same);
  if (found == dirty_.end()) found = dirty_.insert(dirty_.end(), Dirty{file, sector, {}});
  std::memcpy(found->contents.emplace_back().data(), at, kSector);
}

base::Status SimStorage::write(std::string_view name, uint64_t offset, base::ByteSpan bytes) {
  if (before_call) before_call();
  Failure how;
  const bool fails_now = failing("write", how);
  File* file = find(name);
  if (file == nullptr || offset + bytes.size() > file->cache.size()) return error("write", name);
  if (how == Failure::kShort) bytes = bytes.first(bytes.size() / 2);
  if (how == Failure::kError) return error("write", name);
  const auto number = static_cast<size_t>(file - files_.data());
  for (uint64_t done = 0; done < bytes.size();) {
    const uint64_t sector = (offset + done) / kSector;
    const uint64_t begin = (offset + done) % kSector;
    const uint64_t end = std::min<uint64_t>(kSector, begin + bytes.size() - done);
    put(number, sector, bytes.data() + done, begin, end);
    done += end - begin;
  }
  return fails_now ? base::Status(error("write", name)) : base::Ok{};
}

base::Status SimStorage::sync(std::string_view name) {
  if (before_call) before_call();
  Failure how;
  const bool fails_now = failing("sync", how);
  File* file = find(name);
  if (file == nullptr) return error("sync", name);
  const auto number = static_cast<size_t>(file - files_.data());
  size_t count = 0;
  for (const Dirty& row : dirty_) {
    if (row.file != number) continue;
    // A failing one loses every other sector.
    if (fails_now && count++ % 2 == 0) continue;
    std::memcpy(file->disk.data() + row.sector * kSector, row.contents.back().data(), kSector);
  }
  std::erase_if(dirty_, [&](const Dirty& row) { return row.file == number; });
  return fails_now ? base::Status(error("sync", name)) : base::Ok{};
}

SimStorage SimStorage::after_cut(const Choice& choice, Tear tear) const {
  SimStorage out;
  out.files_.reserve(files_.size());
  for (const File& file : files_) out.files_.push_back({file.name, file.disk, {}});
  for (size_t i = 0; i < dirty_.size(); ++i) {
    const Dirty& row = dirty_[i];
    uint8_t* const at = out.files_[row.file].disk.data() + row.sector * kSector;
    if (choice[i] != 0) std::memcpy(at, row.contents[choice[i] - 1u].data(), kSector);
    if (i == tear.number) std::memcpy(at, row.contents.back().data(), tear.bytes);
  }
  for (File& file : out.files_) file.cache = file.disk;
  return out;
}

SimStorage SimStorage::after_kill() const {
  SimStorage out = *this;
  out.before_call = nullptr;
  out.fails = nullptr;
  return out;
}

std::vector<std::string> SimStorage::names() const {
  std::vector<std::string> out;
  for (const File& file : files_) out.push_back(file.name);
  return out;
}

}  // namespace sim
