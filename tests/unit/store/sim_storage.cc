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
    if (file.name == name && file.presence != Presence::kAbsent) return &file;
  }
  return nullptr;
}

size_t SimStorage::make(std::string_view name) {
  for (size_t i = 0; i < files_.size(); ++i) {
    if (files_[i].name != name) continue;
    if (files_[i].presence != Presence::kThere) files_[i] = {std::string(name), {}, {}};
    return i;
  }
  files_.push_back({std::string(name), {}, {}});
  return files_.size() - 1;
}

uint64_t SimStorage::used() const {
  uint64_t total = 0;
  for (const File& file : files_) total += file.cache.size();
  return total;
}

void SimStorage::remove(std::string_view name) {
  File* file = find(name);
  const auto number = static_cast<size_t>(file - files_.data());
  std::erase_if(dirty_, [&](const Dirty& row) { return row.file == number; });
  file->presence = Presence::kRemoved;
  file->disk.clear();
}

bool SimStorage::failing(std::string_view call, Failure& how) {
  how = fails ? fails(call) : Failure::kNone;
  return how != Failure::kNone;
}

base::Status SimStorage::call(std::string_view what, std::string_view name) {
  if (before_call) before_call();
  Failure how;
  if (failing(what, how)) return error(what, name);
  return base::Ok{};
}

// Files that were replaced: the folder is synced, and the old ones are gone.
void SimStorage::settle_names() {
  for (const Dirty& row : std::vector<Dirty>(dirty_)) {
    if (row.sector != kWhole) continue;
    files_[row.file].disk = row.contents.back();
    std::erase_if(dirty_, [&](const Dirty& other) { return other.file == row.file; });
  }
  names_settled_ = true;
}

base::Status SimStorage::open(std::string_view name, uint64_t size) {
  if (base::Status called = call("open", name); !called.ok()) return called;
  File* file = find(name);
  if (file != nullptr && file->presence == Presence::kRemoved) file = nullptr;
  const uint64_t rounded = (size + kSector - 1) / kSector * kSector;
  const uint64_t before = file == nullptr ? 0 : file->cache.size();
  if (rounded > before && used() + rounded - before > full_at) return error("open", name);
  if (file == nullptr) file = &files_[make(name)];
  if (file->cache.size() < rounded) {
    file->cache.resize(rounded);
    file->disk.resize(rounded);
  }
  if (!names_settled_) settle_names();
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
  found->contents.emplace_back(at, at + kSector);
}

base::Status SimStorage::write(std::string_view name, uint64_t offset, base::ByteSpan bytes) {
  if (before_call) before_call();
  Failure how;
  const bool fails_now = failing("write", how);
  File* file = find(name);
  if (file == nullptr || offset + bytes.size() > file->cache.size()) return error("write", name);
  if (how == Failure::kShort) bytes = bytes.first(bytes.size() / 2);
  if (how == Failure::kError) return error("write", name);
  if (file->presence == Presence::kRemoved) return base::Ok{};
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
    if (row.file != number || row.sector == kWhole) continue;
    // A failing one loses every other sector.
    if (fails_now && count++ % 2 == 0) continue;
    std::memcpy(file->disk.data() + row.sector * kSector, row.contents.back().data(), kSector);
  }
  std::erase_if(dirty_, [&](const Dirty& row) {
    return row.file == number && row.sector != kWhole;
  });
  if (fails_now) return error("sync", name);
  if (!file->known) file->cache = file->disk;
  file->known = true;
  return check(name);
}

base::Status SimStorage::check(std::string_view name) {
  const File* file = find(name);
  if (file == nullptr || file->presence != Presence::kThere) {
    return base::Error{base::Refusal::kFileNotFound, std::string(name) + ": the file was removed"};
  }
  Failure how;
  if (failing("check", how)) return error("check", name);
  return base::Ok{};
}

// The new file is on disk before it has its name; the name when the folder is synced.
base::Status SimStorage::replace(std::string_view name, uint64_t size,
                                 std::span<const Piece> pieces) {
  const uint64_t rounded = (size + kSector - 1) / kSector * kSector;
  base::Bytes content(rounded, 0);
  for (const Piece& piece : pieces) {
    std::copy(piece.bytes.begin(), piece.bytes.end(),
              content.begin() + static_cast<std::ptrdiff_t>(piece.offset));
  }
  for (const char* what : {"open", "write", "sync", "rename"}) {
    if (base::Status called = call(what, name); !called.ok()) return called;
    if (used() + rounded > full_at) return error(what, name);
  }
  const size_t number = make(name);
  files_[number].cache = content;
  files_[number].known = true;
  auto whole = std::find_if(dirty_.begin(), dirty_.end(), [&](const Dirty& row) {
    return row.file == number && row.sector == kWhole;
  });
  if (whole == dirty_.end()) whole = dirty_.insert(dirty_.end(), Dirty{number, kWhole, {}});
  whole->contents.push_back(std::move(content));
  if (base::Status called = call("sync", name); !called.ok()) return called;
  settle_names();
  return base::Ok{};
}

SimStorage SimStorage::after_cut(const Choice& choice, Tear tear) const {
  SimStorage out;
  out.files_.reserve(files_.size());
  for (const File& file : files_) out.files_.push_back({file.name, file.disk, {}, file.presence});
  for (size_t i = 0; i < dirty_.size(); ++i) {
    const Dirty& row = dirty_[i];
    if (row.sector == kWhole) continue;
    uint8_t* const at = out.files_[row.file].disk.data() + row.sector * kSector;
    if (choice[i] != 0) std::memcpy(at, row.contents[choice[i] - 1u].data(), kSector);
    if (i == tear.number) std::memcpy(at, row.contents.back().data(), tear.bytes);
  }
  for (size_t i = 0; i < dirty_.size(); ++i) {
    const Dirty& row = dirty_[i];
    if (row.sector == kWhole && choice[i] != 0) {
      out.files_[row.file].disk = row.contents[choice[i] - 1u];
    }
  }
  for (File& file : out.files_) file.cache = file.disk;
  out.forget_process();
  return out;
}

SimStorage SimStorage::after_kill() const {
  SimStorage out = *this;
  out.before_call = nullptr;
  out.fails = nullptr;
  out.forget_process();
  return out;
}

void SimStorage::forget_process() {
  names_settled_ = false;
  for (File& file : files_) {
    if (file.presence == Presence::kRemoved) file = {file.name, {}, {}, Presence::kAbsent};
    file.known = false;
  }
}

std::vector<std::string> SimStorage::names() const {
  std::vector<std::string> out;
  for (const File& file : files_) out.push_back(file.name);
  return out;
}

}  // namespace sim
