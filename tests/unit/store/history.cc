#include "tests/unit/store/history.h"

#include <algorithm>
#include <cstring>
#include <map>

#include "base/hash.h"
#include "ir/bytecode/image_sections.h"

namespace history {

using online_change::RetainRecord;
using online_change::StoredImage;

namespace {

std::map<base::Digest, uint32_t> versions;  // that program() has made

uint32_t version_of(const base::Digest& digest) {
  const auto known = versions.find(digest);
  return known == versions.end() ? 0 : known->second;
}

uint64_t count_of(const RetainRecord& record) {
  uint64_t count = 0;
  if (record.values.size() >= 8) std::memcpy(&count, record.values.data(), 8);
  return count;
}

bool intact(const RetainRecord& record) {
  return record.values == values(version_of(record.image), count_of(record));
}

std::string text(const std::optional<uint32_t>& version) {
  return version ? std::to_string(*version) : "none";
}

}  // namespace

// A later version needs more room.
StoredImage program(uint32_t version) {
  StoredImage image;
  image.bytes.assign(500 + version * 20, static_cast<uint8_t>(version));
  image.digest = base::sha256(ir::sealed_part(image.bytes));
  std::memcpy(image.bytes.data() + 16, image.digest.data(), image.digest.size());  // ir::digest()
  versions[image.digest] = version;
  return image;
}

base::Bytes values(uint32_t version, uint64_t count) {
  base::Bytes out(500 + version * 10, static_cast<uint8_t>(version * 16 + count));
  std::memcpy(out.data(), &count, sizeof count);
  return out;
}

online_change::StoreSizes small() { return {500, 16, kNotes, 2}; }

// --- what is found ------------------------------------------------------------------

std::string History::open() {
  store_ = std::make_unique<online_change::Store>(disk_, small());
  found_ = store_->take_recovered();
  std::string wrong = check_program();
  if (wrong.empty()) wrong = check_trial();
  if (wrong.empty()) wrong = check_values();
  if (wrong.empty()) wrong = check_journal();
  return wrong;
}

std::string History::check_program() const {
  if (!found_.boots) {
    if (found_.nothing.empty()) return "no reason why nothing boots";
    return now_.boots ? "nothing boots: " + found_.nothing : "";
  }
  const uint32_t version = version_of(found_.boots->digest);
  if (found_.boots->bytes != program(version).bytes) return "a mixture boots";
  if (now_.boots == version || now_.boots_next == version) return "";
  return "version " + std::to_string(version) + " boots, not " + text(now_.boots);
}

std::string History::check_trial() const {
  if (!now_.trial_sure) return "";
  const std::optional<uint32_t> lost =
      found_.trial_lost ? std::optional(version_of(*found_.trial_lost)) : std::nullopt;
  return lost == now_.trial ? "" : "lost trial is " + text(lost) + ", not " + text(now_.trial);
}

std::string History::check_values() const {
  if (!found_.newest) return now_.count == 0 ? "" : "the retained values are gone";
  const RetainRecord& newest = *found_.newest;
  if (!intact(newest)) return "a mixture of retained values";
  const uint64_t count = count_of(newest);
  if (count < now_.count || count > now_.count_begun) {
    return "retained values of " + std::to_string(count) + ", not " + std::to_string(now_.count);
  }
  const uint32_t version = version_of(newest.image);
  const bool of_boots = found_.boots && version_of(found_.boots->digest) == version;
  const bool of_other = found_.other && version_of(found_.other->digest) == version;
  if (!of_boots && !of_other) return "nobody knows the layout of the retained values";
  if (of_boots || !newest.trial) return "";
  if (!found_.before) return now_.count_accepted == 0 ? "" : "nothing from before the trial";
  if (!intact(*found_.before)) return "a mixture from before the trial";
  if (found_.before->image != found_.boots->digest) return "before the trial: another program";
  return count_of(*found_.before) >= now_.count_accepted ? "" : "old values from before the trial";
}

std::vector<online_change::JournalEntry> History::written_notes() {
  auto entries = online_change::read_journal(disk_, online_change::kJournalFile);
  return entries.ok() ? std::move(*entries) : std::vector<online_change::JournalEntry>();
}

// All but the oldest, whose place is taken by what is being written.
std::string History::check_journal() {
  const std::vector<online_change::JournalEntry> entries = written_notes();
  uint64_t expected = now_.notes > kNotes - 1 ? now_.notes - (kNotes - 1) + 1 : 1;
  if (now_.notes_begun > kNotes) expected = std::max(expected, now_.notes_begun - kNotes + 1);
  for (const online_change::JournalEntry& entry : entries) {
    if (entry.sequence < expected) continue;
    if (entry.sequence > now_.notes_begun) return "an entry that nobody wrote";
    if (entry.sequence != expected) break;
    if (entry.text != "note " + std::to_string(entry.sequence)) return "a damaged entry";
    ++expected;
  }
  return expected > now_.notes ? "" : "entry " + std::to_string(expected) + " is gone";
}

void History::believe() {
  now_.boots.reset();
  if (found_.boots) now_.boots = version_of(found_.boots->digest);
  now_.boots_next.reset();
  now_.trial.reset();
  now_.below.clear();
  if (found_.trial_lost) now_.trial = version_of(*found_.trial_lost);
  now_.trial_sure = true;
  now_.count = now_.count_begun = found_.newest ? count_of(*found_.newest) : 0;
  now_.count_accepted = 0;
  const bool accepted = found_.newest && !found_.newest->trial;
  if (accepted && found_.boots && found_.newest->image == found_.boots->digest) {
    now_.count_accepted = now_.count;
  }
  if (found_.before) now_.count_accepted = count_of(*found_.before);
  const std::vector<online_change::JournalEntry> entries = written_notes();
  now_.notes = now_.notes_begun = entries.empty() ? 0 : entries.back().sequence;
}

// --- what is done -------------------------------------------------------------------

bool History::install(uint32_t version) {
  now_.boots_next = version;
  if (!store_->install(program(version), values(version, 0).size()).ok()) return false;
  now_.boots = version;
  now_.boots_next.reset();
  return true;
}

bool History::settle() {
  now_.trial_sure = !now_.trial.has_value();
  if (!store_->settle().ok()) return false;
  now_.trial.reset();
  now_.below.clear();
  now_.trial_sure = true;
  return true;
}

bool History::save() {
  const uint32_t version = running();
  const uint64_t count = ++now_.count_begun;
  const base::Bytes bytes = values(version, count);
  if (!store_->save_retained(program(version).digest, count, bytes).ok()) return false;
  now_.count = count;
  if (!now_.trial) now_.count_accepted = count;
  return true;
}

bool History::begin_trial(uint32_t version) {
  if (!store_->retained_fits() && !save()) return false;
  const StoredImage next = program(version);
  auto aside = std::make_shared<base::Bytes>(next.bytes);
  if (version % 2 == 0) store_->lay_aside(aside);  // promises nothing
  // Others of the same name may have been there.
  const bool others = version % 4 == 0;
  if (now_.trial) now_.below.push_back(*now_.trial);
  now_.trial = version;
  now_.trial_sure = false;
  const online_change::ImageToStore image{next.digest, others ? next.bytes : *aside};
  if (!store_->begin_trial(image, values(version, 0).size()).ok()) return false;
  now_.trial_sure = true;
  now_.boots_next.reset();
  return true;
}

// To the edit below, which is stored as what is on trial again.
bool History::undo() {
  if (!now_.below.empty()) {
    if (!store_->retained_fits() && !save()) return false;
    const StoredImage back = program(now_.below.back());
    now_.trial = now_.below.back();
    now_.below.pop_back();
    now_.trial_sure = false;
    if (!store_->begin_trial(back, values(*now_.trial, 0).size()).ok()) return false;
    now_.trial_sure = true;
    now_.boots_next.reset();
    return true;
  }
  now_.trial_sure = false;
  if (!store_->end_trial().ok()) return false;
  now_.trial.reset();
  now_.trial_sure = true;
  now_.boots_next.reset();
  return true;
}

bool History::accept() {
  if (!store_->retained_fits() && !save()) return false;
  now_.boots_next = now_.trial;
  now_.trial_sure = false;
  if (!store_->accept().ok()) return false;
  now_.boots = now_.trial;
  now_.boots_next.reset();
  now_.trial.reset();
  now_.trial_sure = true;
  now_.below.clear();
  now_.count_accepted = 0;  // of this program there are none that are not from the trial
  return true;
}

bool History::accept_oldest() {
  if (!save()) return false;
  const uint32_t version = now_.below.front();
  now_.boots_next = version;
  const base::Bytes before = values(version, now_.count);
  now_.count_accepted = std::min(now_.count_accepted, now_.count);
  if (!store_->accept_below(program(version), now_.count, before).ok()) return false;
  now_.boots = version;
  now_.boots_next.reset();
  now_.below.erase(now_.below.begin());
  now_.count_accepted = now_.count;
  return true;
}

bool History::note() {
  online_change::JournalEntry entry;
  entry.text = "note " + std::to_string(++now_.notes_begun);
  store_->note(entry);
  if (!store_->complaints().empty()) return false;
  now_.notes = now_.notes_begun;
  return true;
}

void History::renew() {
  if (!store_->renew().ok()) return;
  now_.boots_next.reset();
  now_.trial_sure = true;
  now_.notes = now_.notes_begun;
}

// What has failed changes nothing for the controller; on the disk it may have happened.
void History::fault(uint64_t seed) {
  std::mt19937_64 random(seed);
  uint64_t before = random() % 8;
  uint64_t failing = 1 + random() % 5;
  const sim::Failure how = random() % 2 == 0 ? sim::Failure::kError : sim::Failure::kShort;
  disk_.fails = [=](std::string_view) mutable {
    if (before > 0) return --before, sim::Failure::kNone;
    if (failing == 0) return sim::Failure::kNone;
    return --failing, how;
  };
  const Promises promised = now_;
  const bool done = any_operation(random());
  if (random() % 2 == 0) (void)store_->renew().ok();
  disk_.fails = nullptr;
  if (!done) now_.trial = promised.trial;
  if (!done) now_.below = promised.below;
  if (!done) now_.boots = promised.boots;
  if (random() % 3 != 0) renew();
}

// False: storage has failed.
bool History::any_operation(uint64_t seed) {
  std::mt19937_64 random(seed);
  switch (random() % 8) {
    case 0:
    case 1:
    case 2:
      return save();
    case 3:
      return note();
    default:
      if (on_trial() && random() % 3 != 0) {
        if (random() % 2 == 0) return undo();
        return !now_.below.empty() && random() % 2 == 0 ? accept_oldest() : accept();
      }
      // Also back to a version that was there before.
      const uint32_t version = running();
      const bool back = random() % 3 == 0 && version > 1;
      const uint32_t next = back ? version - 1 : std::max(highest_, version) + 1;
      highest_ = std::max(highest_, next);
      return begin_trial(next);
  }
}

void live(History& history, uint64_t seed, uint32_t operations, bool faults) {
  std::mt19937_64 random(seed);
  if (!history.promises().boots && !history.install(1)) return;
  for (uint32_t i = 0; i < operations; ++i) {
    if (faults && random() % 5 == 0) {
      history.fault(random());
    } else if (!history.any_operation(random()) && !faults) {
      return;
    }
  }
}

}  // namespace history
