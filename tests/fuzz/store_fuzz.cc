// Files of a controller with any content: it boots, or says why not, and takes a new program.
//
// An input is a script of changes to a good disk, 5 bytes {file, what, where, value} each.
// Checksums are put right where an odd `what` asks for it, so that the decoders behind them are
// reached.
#include <algorithm>
#include <cstdio>
#include <cstring>
#include <optional>

#include "base/check.h"
#include "base/crc32c.h"
#include "base/hash.h"
#include "base/sha256.h"
#include "online_change/package/package.h"
#include "online_change/store/boot.h"
#include "tests/unit/bytecode/sample_objects.h"
#include "tests/unit/store/sim_storage.h"

namespace {

using namespace online_change;

constexpr size_t kStep = 5;
constexpr StoreSizes kSizes{512, 64, 8, 4};

ir::VerifiedImage sample_program(const char* name = "sample") {
  ir::Image program = sample::busy_image();
  program.name = name;
  base::Result<ir::VerifiedImage> image = ir::verify(ir::encode(program));
  base::check(image.ok(), "the sample is sound");
  return *image;
}

// A trial that goes on after the power loss (D4), in the middle of everything.
sim::SimStorage good_disk() {
  sim::SimStorage disk;
  Store store(disk, kSizes);
  const ir::VerifiedImage image = sample_program();
  base::Result<Boot> booted = boot(store, image, "fuzz", 1);
  base::check(booted.ok(), "the sample boots");
  for (int i = 0; i < 3; ++i) {
    base::check(store.save_retained(image.digest(), 1, booted->retained).ok(), "saved");
  }
  const ir::VerifiedImage edited = sample_program("edited");
  base::Result<Package> package = make_package(image.encoded(), edited.encoded());
  base::check(package.ok(), "the sample can be changed");
  const uint64_t retained = booted->retained.size();
  StoredEdit edit;
  edit.name = "E1";
  edit.who = "fuzz";
  edit.from = image.digest();
  edit.to = edited.digest();
  edit.package = encode(*package);
  edit.retained = booted->retained;
  base::check(store.keep_edits({edit}).ok(), "kept");
  const StoredImage trial{edited.digest(), edited.encoded()};
  base::check(store.begin_trial(trial, retained, true).ok(), "on trial");
  base::check(store.save_retained(edited.digest(), 2, booted->retained).ok(), "saved");
  Store later(disk, kSizes);
  booted = boot(later, std::nullopt, "fuzz", 1);
  base::check(booted.ok() && booted->edits.size() == 1, "the trial goes on");
  return disk;
}

// The header's hash and checksum fit what they are of.
void repair(base::Bytes& content) {
  constexpr size_t kVersionAt = 8;
  constexpr uint8_t kInParts = 2;
  constexpr size_t kLengthAt = 24;
  constexpr size_t kHashAt = 32;
  constexpr size_t kFirstLengthAt = 64;
  if (content.size() < 512) return;
  uint64_t length = 0;
  std::memcpy(&length, content.data() + kLengthAt, 8);
  length = std::min<uint64_t>(length, content.size() - 512);
  const base::ByteSpan payload = base::ByteSpan(content).subspan(512, length);
  base::Digest hash = base::sha256(payload);
  if (content[kVersionAt] == kInParts) {
    uint64_t first = 0;
    std::memcpy(&first, content.data() + kFirstLengthAt, 8);
    first = std::min(first, length);
    hash = base::sha256(base::sha256(payload.first(first)), base::sha256(payload.subspan(first)));
  }
  std::memcpy(content.data() + kHashAt, hash.data(), hash.size());
  for (size_t at = 0; at + 512 <= content.size(); at += 512) {
    const uint32_t checksum = base::crc32c(base::ByteSpan(content).subspan(at, 508));
    std::memcpy(content.data() + at + 508, &checksum, 4);
    if (at == 0 && std::memcmp(content.data(), "SCRECORD", 8) == 0) break;
  }
}

void change(base::Bytes& content, const uint8_t* step) {
  const size_t where = (step[2] | size_t{step[3]} << 8) % (content.size() + 1);
  switch (step[1] / 2 % 5) {
    case 0:
      if (where < content.size()) content[where] = step[4];
      break;
    case 1:
      if (where < content.size()) content[where] ^= static_cast<uint8_t>(1u << step[4] % 8);
      break;
    case 2:
      content.resize(where);
      break;
    case 3:
      std::fill(content.begin() + static_cast<std::ptrdiff_t>(where), content.end(), step[4]);
      break;
    default:  // of the header: sequence and length
      if (content.size() >= 512) content[16 + step[2] % 16] = step[4];
  }
  if (step[1] % 2 != 0) repair(content);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  static const sim::SimStorage good = good_disk();
  static const ir::VerifiedImage image = sample_program();
  sim::SimStorage disk = good;
  const size_t files = disk.names().size();
  for (size_t at = 0; at + kStep <= size && at < 12 * kStep; at += kStep) {
    change(disk.content(data[at] % files), data + at);
  }
  for (size_t file = 0; file < files; ++file) disk.settle(file);
  Store store(disk, kSizes);
  base::Result<Boot> booted = boot(store, std::nullopt, "fuzz", 2);
  if (!booted.ok()) {
    base::check(!booted.error().text.empty(), "a reason is given");
    booted = boot(store, image, "fuzz", 3);
    if (!booted.ok()) return 0;  // the disk takes nothing any more
  }
  const base::Result<std::vector<JournalEntry>> entries = read_journal(disk, kJournalFile);
  base::check(entries.ok(), "the journal can be read");
  for (const JournalEntry& entry : *entries) {
    base::check(event_name(entry.event) != nullptr, "an event has a name");
  }
  Store again(disk, kSizes);
  base::Result<Boot> second = boot(again, std::nullopt, "fuzz", 4);
  if (!second.ok()) std::fprintf(stderr, "%s\n", base::to_string(second.error()).c_str());
  base::check(second.ok() && second->image.digest() == booted->image.digest(),
              "what booted once boots again");
  return 0;
}
