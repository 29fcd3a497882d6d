// The retained values of a store: three copies, the newest, the newest from before the trial, and
// the one that is written next.
#include <algorithm>

#include "online_change/store/store.h"

namespace online_change {

void Store::recover_retained() {
  retained_.recover(retain_record_bytes(sizes_.retain_bytes));
  std::optional<RetainRecord> records[3];
  for (size_t i = 0; i < 3; ++i) {
    if (!retained_.valid(i)) continue;
    records[i] = decode_retain(retained_.take_payload(i));
    if (!records[i]) {
      retained_.reject(i);
      continue;
    }
    in_copy_[i] = RetainHead{records[i]->image, records[i]->trial};
  }
  // Values are saved of a program that runs. So one did, also where nothing of them can be read.
  for (size_t i = 0; i < 3; ++i) {
    if (!recovered_.virgin || retained_[i].record.state == RecordState::kEmpty) continue;
    recovered_.virgin = false;
    recovered_.nothing = "both control records are empty, and a program ran there";
  }
  const std::optional<size_t> newest = newest_retained();
  const std::optional<size_t> before = retained_before();
  if (newest) recovered_.newest = std::move(records[*newest]);
  if (before) recovered_.before = std::move(records[*before]);
  choose_other();
  if (newest) return;
  const std::optional<base::Digest> kept = retained_program();
  recovered_.no_newest =
      kept ? "those of " + base::short_hex(*kept) + " are stored, but that program is not"
           : "no record of them can be used";
}

void Store::choose_other() {
  for (const StoredImage& image : recovered_.held) {
    const bool of_newest = recovered_.newest && recovered_.newest->image == image.digest;
    if (of_newest || !recovered_.other || control_.is_trial(image.digest)) recovered_.other = image;
    if (of_newest) return;
  }
}

std::optional<size_t> Store::newest_retained() const {
  return retained_.newest([&](size_t i) { return in_copy_[i] && in_a_slot(in_copy_[i]->image); });
}

std::optional<size_t> Store::retained_before() const {
  const std::optional<size_t> newest = newest_retained();
  if (!newest || !in_copy_[*newest]->trial || in_copy_[*newest]->image == control_.boots) {
    return std::nullopt;
  }
  return newest_accepted();
}

std::optional<size_t> Store::newest_accepted() const {
  return retained_.newest([&](size_t i) {
    return in_copy_[i] && !in_copy_[i]->trial && in_copy_[i]->image == control_.boots;
  });
}

bool Store::retained_fits_locked() const {
  const std::optional<size_t> newest = newest_retained();
  if (!newest) return true;
  const RetainHead& head = *in_copy_[*newest];
  if (head.image == control_.boots && !head.trial) return true;
  if (!control_.trial) return false;
  // The next program takes the free slot. One program can lie in two: it was there before.
  const size_t free = free_trial_slot();
  if (in_slot_[free] != head.image) return true;
  for (size_t slot = 0; slot < kImageSlots; ++slot) {
    if (slot != free && in_slot_[slot] == head.image) return true;
  }
  return false;
}

std::optional<base::Bytes> Store::retained_of(const base::Digest& image) const {
  std::lock_guard lock(mutex_);
  const std::optional<size_t> newest = retained_.newest([&](size_t i) {
    return in_copy_[i] && (in_copy_[i]->image == image || in_a_slot(in_copy_[i]->image));
  });
  if (!newest || in_copy_[*newest]->image != image) return std::nullopt;
  const Record record = read_record(storage_, retained_[*newest].name, RecordKind::kRetain);
  std::optional<RetainRecord> found;
  if (record.state == RecordState::kValid) found = decode_retain(record.payload);
  if (!found || found->image != image) return std::nullopt;
  return std::move(found->values);
}

std::optional<base::Digest> Store::retained_program() const {
  std::lock_guard lock(mutex_);
  const std::optional<size_t> newest =
      retained_.newest([&](size_t i) { return in_copy_[i].has_value(); });
  if (!newest) return std::nullopt;
  return in_copy_[*newest]->image;
}

bool Store::keeps_retained() const {
  std::lock_guard lock(mutex_);
  return saved_copy_ && retained_.valid(*saved_copy_);
}

bool Store::retained_fits() const {
  std::lock_guard lock(mutex_);
  return retained_fits_locked();
}

base::Status Store::save_retained(const base::Digest& image, uint64_t cycle,
                                  base::ByteSpan values) {
  std::lock_guard lock(mutex_);
  if (!may_save_retained(image)) {
    return failed("the retained values are of a program that is not stored");
  }
  const bool trial = control_.boots != image;
  retained_.check();
  // What a lost trial goes back to stays until the trial is over and newer values are durable.
  const std::optional<size_t> newest = newest_retained();
  const bool on_trial = control_.trial || (newest && in_copy_[*newest]->image != control_.boots);
  const std::optional<size_t> before = newest_accepted();
  const std::optional<size_t> copy =
      retained_.victim([&](size_t i) { return on_trial && before == i; });
  if (!copy) return failed("no copy of the retained values is left: " + retained_.complaint());
  base::Status written = write_retained(
      *copy, {image, trial, cycle, base::Bytes(values.begin(), values.end())}, false);
  if (written.ok()) saved_copy_ = copy;
  return written;
}

// What rests below the edit that is on trial is in its slot still, around the switch to that one.
bool Store::may_save_retained(const base::Digest& image) const {
  if (control_.boots == image) return boots_valid();
  return control_.is_trial(image) || (control_.trial && in_a_slot(image));
}

base::Status Store::write_retained(size_t copy, const RetainRecord& record, bool older) {
  base::Status room = retained_.reserve(copy, retain_record_bytes(record.values.size()));
  if (!room.ok()) return room;
  if (!retained_[copy].dead) in_copy_[copy].reset();
  const base::Bytes payload = encode(record);
  base::Status written =
      older ? retained_.write_older(copy, payload) : retained_.write(copy, payload);
  if (written.ok()) in_copy_[copy] = RetainHead{record.image, record.trial};
  show_retained();
  return written;
}

}  // namespace online_change
