// A disk in memory: it knows which sectors are written and not synced, can say what a power cut
// might leave (any of them, in any order, torn), and fails when it is told to. A sync that fails
// loses what it should have written and never speaks of it again, as operating systems do; reads
// see it all the same, until a later process syncs the file.
#pragma once

#include <cstdint>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "vm/runtime/ports.h"

namespace sim {

inline constexpr uint64_t kSector = 512;

// What happens to one call; kShort writes a part of what it was given.
enum class Failure : uint8_t { kNone, kError, kShort };

struct Tear {  // the dirty sector of that number holds `bytes` of its newest content only
  size_t number = ~size_t{0};
  uint32_t bytes = 0;
};

class SimStorage : public vm::Storage {
 public:
  base::Status open(std::string_view name, uint64_t size) override;
  base::Result<uint64_t> size(std::string_view name) override;
  base::Result<base::Bytes> read(std::string_view name, uint64_t offset, uint64_t size) override;
  base::Status write(std::string_view name, uint64_t offset, base::ByteSpan bytes) override;
  base::Status sync(std::string_view name) override;
  base::Status replace(std::string_view name, uint64_t size,
                       std::span<const Piece> pieces) override;
  base::Status check(std::string_view name) override;

  // Before each call that can change something.
  std::function<void()> before_call;
  // Asked for every call, also reads: {open, read, write, sync, rename}; of
  // replace() open, write, sync, rename and sync.
  std::function<Failure(std::string_view call)> fails;
  uint64_t full_at = ~uint64_t{0};  // bytes of all files together that the disk has room for

  // --- after a power cut ---
  // Dirty sectors, each with every content that it had since it was synced; and files that were
  // replaced while their folder was not synced.
  struct Dirty {
    size_t file = 0;
    uint64_t sector = 0;                // kWhole: the file
    std::vector<base::Bytes> contents;  // oldest first
  };
  static constexpr uint64_t kWhole = ~uint64_t{0};
  const std::vector<Dirty>& dirty() const { return dirty_; }
  // For each dirty sector: 0 the old content, n the n-th new one.
  using Choice = std::vector<uint8_t>;
  // The disk as it is then, whole again: nothing dirty, no failures, no hooks.
  SimStorage after_cut(const Choice& choice, Tear tear = {}) const;
  // The machine runs on, the process does not: what is dirty stays so.
  SimStorage after_kill() const;

  // --- damage ---
  std::vector<std::string> names() const;
  base::Bytes& content(size_t file) { return files_[file].cache; }
  // The file as `content` was made to be, durable.
  void settle(size_t file) { files_[file].disk = files_[file].cache; }
  // Somebody removes it, durably; who has opened it can go on.
  void remove(std::string_view name);

 private:
  enum class Presence : uint8_t { kThere, kRemoved, kAbsent };
  struct File {
    std::string name;
    base::Bytes disk;   // what is durable
    base::Bytes cache;  // what a read sees
    Presence presence = Presence::kThere;
    bool known = true;  // to this process: it has created or synced it
  };
  File* find(std::string_view name);
  size_t make(std::string_view name);
  void settle_names();
  void forget_process();
  uint64_t used() const;
  base::Status call(std::string_view what, std::string_view name);
  void put(size_t file, uint64_t sector, const uint8_t* bytes, uint64_t begin, uint64_t end);
  bool failing(std::string_view call, Failure& how);

  std::vector<File> files_;
  std::vector<Dirty> dirty_;
  bool names_settled_ = true;
};

}  // namespace sim
