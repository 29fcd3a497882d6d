#include "online_change/store/store.h"

#include <algorithm>

#include "ir/bytecode/image.h"
#include "ir/bytecode/image_sections.h"

namespace online_change {
namespace {

constexpr uint64_t kSpareParts = 16;  // of an image, for the edits that come: one more

base::Error failed(std::string text) { return {base::Refusal::kStorageFailed, std::move(text)}; }

std::optional<StoredImage> image_of(base::Bytes payload) {
  if (payload.size() < kDigestBytes) return std::nullopt;
  StoredImage image;
  std::copy_n(payload.begin(), kDigestBytes, image.digest.begin());
  payload.erase(payload.begin(), payload.begin() + kDigestBytes);
  image.bytes = std::move(payload);
  return image;
}

uint64_t retain_payload_bytes(uint64_t values) { return encode(RetainRecord{}).size() + values; }

}  // namespace

Store::Store(vm::Storage& storage, StoreSizes sizes)
    : storage_(storage),
      sizes_(sizes),
      control_copies_(storage, RecordKind::kControl, {"control_0", "control_1"}),
      slots_(storage, RecordKind::kImage, {"slot_a", "slot_b"}),
      retained_(storage, RecordKind::kRetain, {"retain_0", "retain_1", "retain_2"}),
      journal_(storage, kJournalFile, sizes.journal_entries),
      traps_(storage, kTrapsFile, sizes.trap_entries) {
  recover_control();
  recover_images();
  recover_retained();
  journal_.recover();
  traps_.recover();
  show_control();
  show_slots();
  show_retained();
  show_journals();
}

// --- recovery ---------------------------------------------------------------------

void Store::recover_control() {
  control_copies_.recover(encode(ControlRecord{}).size());
  std::optional<ControlRecord> records[2];
  for (size_t i = 0; i < 2; ++i) {
    if (!control_copies_.valid(i)) continue;
    records[i] = decode_control(control_copies_.take_payload(i));
    if (!records[i]) control_copies_.reject(i);
  }
  const std::optional<size_t> newest = control_copies_.newest([](size_t) { return true; });
  has_control_ = newest.has_value();
  if (newest) control_ = *records[*newest];
  // The first record ever goes into the first copy, and then into the second one: when that has
  // never been written, there is nothing that could have been lost.
  const bool never = control_copies_[1].record.state == RecordState::kEmpty;
  recovered_.virgin = !newest && never;
  if (recovered_.virgin) recovered_.nothing = "no program was ever stored there";
  if (!newest && !never) recovered_.nothing = "both control records are damaged or unreadable";
  if (has_control_ && control_.trial) recovered_.trial_lost = control_.trial_digest;
}

void Store::recover_images() {
  slots_.recover(kDigestBytes + sizes_.image_bytes);
  for (size_t i = 0; i < 2; ++i) {
    if (!slots_.valid(i)) continue;
    std::optional<StoredImage> image = image_of(slots_.take_payload(i));
    if (!image) {
      slots_.reject(i);
      continue;
    }
    in_slot_[i] = image->digest;
    const bool boots = has_control_ && control_.slot == i && control_.boots == image->digest;
    if (!boots) recovered_.held.push_back(*image);
    (boots ? recovered_.boots : recovered_.other) = std::move(*image);
  }
  if (!has_control_ || recovered_.boots) return;
  recovered_.nothing = std::string("the program that boots, ") + base::short_hex(control_.boots) +
                       " in " + slots_[control_.slot].name + ", is damaged or unreadable";
}

void Store::recover_retained() {
  retained_.recover(retain_payload_bytes(sizes_.retain_bytes));
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
  const std::optional<size_t> newest = newest_retained();
  const std::optional<size_t> before = retained_before();
  if (newest) recovered_.newest = std::move(records[*newest]);
  if (before) recovered_.before = std::move(records[*before]);
  if (has_control_ && !newest) {
    recovered_.alarms.push_back("no record of the retained values can be used");
  }
}

bool Store::in_a_slot(const base::Digest& image) const {
  return in_slot_[0] == image || in_slot_[1] == image;
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

// --- the program that boots -------------------------------------------------------

void Store::reject_boots() {
  std::lock_guard lock(mutex_);
  if (boots_valid()) in_slot_[control_.slot].reset();
  show_boots();
}

base::Status Store::write_control(const ControlRecord& next) {
  control_copies_.check();
  const std::optional<size_t> copy = control_copies_.victim([](size_t) { return false; });
  if (!copy) return failed("the control record cannot be written: " + control_copies_.complaint());
  base::Status written = control_copies_.write(*copy, encode(next));
  if (written.ok()) control_ = next;
  has_control_ |= written.ok();
  show_control();
  show_boots();
  if (!written.ok()) return failed("the control record: " + written.error().text);
  return written;
}

// With slots_mutex_; what was in the slot is forgotten already.
base::Status Store::write_slot(size_t slot, const ImageToStore& image) {
  const uint64_t bytes = kDigestBytes + image.bytes.size();
  base::Status room = slots_.reserve(slot, bytes, bytes / kSpareParts);
  if (!room.ok()) return room;
  // What the image's own digest is of is not hashed again.
  const base::ByteSpan sealed = ir::sealed_part(image.bytes);
  const base::ByteSpan head = image.bytes.first(image.bytes.size() - sealed.size());
  base::Bytes first(image.digest.begin(), image.digest.end());
  first.insert(first.end(), head.begin(), head.end());
  return slots_.write(slot, {first, sealed, ir::digest(image.bytes)});
}

base::Status Store::write_image(size_t slot, const ImageToStore& image, uint64_t retain_bytes) {
  retained_.check();
  for (size_t i = 0; i < retained_.count(); ++i) {
    base::Status room = retained_.reserve(i, retain_payload_bytes(retain_bytes));
    if (!room.ok()) return room;
  }
  const bool whole = slots_.whole(slot);
  if (whole && written_[slot] && in_slot_[slot] == image.digest) return base::Ok{};
  const bool aside = whole && aside_ != nullptr && aside_->data() == image.bytes.data() &&
                     aside_->size() == image.bytes.size();
  aside_.reset();
  if (!aside) {
    in_slot_[slot].reset();
    written_[slot] = false;
    base::Status written = write_slot(slot, image);
    show_slots();
    if (!written.ok()) return written;
  }
  in_slot_[slot] = image.digest;
  written_[slot] = true;
  return base::Ok{};
}

void Store::lay_aside(std::shared_ptr<const base::Bytes> image) {
  std::lock_guard slots_lock(slots_mutex_);
  size_t slot = 0;
  {
    std::lock_guard lock(mutex_);
    aside_.reset();
    if (!may_begin_trial().ok()) return;
    slot = 1 - control_.slot;
    in_slot_[slot].reset();
    written_[slot] = false;
  }
  const base::Status written = write_slot(slot, {ir::digest(*image), *image});
  std::lock_guard lock(mutex_);
  show_slots();
  if (written.ok()) aside_ = std::move(image);
}

void Store::forget_aside() {
  std::lock_guard slots_lock(slots_mutex_);
  std::lock_guard lock(mutex_);
  aside_.reset();
}

// Without a program that boots: not the one whose layout the retained values have.
size_t Store::free_slot() const {
  if (boots_valid()) return 1 - control_.slot;
  for (size_t slot : {size_t{0}, size_t{1}}) {
    if (!in_slot_[slot]) return slot;
  }
  const std::optional<size_t> newest = newest_retained();
  if (!newest) return has_control_ ? control_.slot : 0;
  return in_slot_[0] == in_copy_[*newest]->image ? 1 : 0;
}

base::Status Store::install(const ImageToStore& image, uint64_t retain_bytes) {
  std::lock_guard slots_lock(slots_mutex_);
  std::lock_guard lock(mutex_);
  if (boots_valid() && control_.boots == image.digest) return end_trial_locked();
  if (boots_valid() && !retained_fits_locked()) {
    return failed("the retained values are those of another program still");
  }
  const size_t slot = free_slot();
  base::Status stored = write_image(slot, image, retain_bytes);
  if (!stored.ok()) return stored;
  stored = write_control({image.digest, static_cast<uint8_t>(slot), false, 0, {}});
  if (!stored.ok()) return stored;
  return settle_locked();
}

base::Status Store::may_begin_trial() const {
  if (!boots_valid()) return failed("no program is stored that the change could be undone to");
  if (control_.trial) return base::Error{base::Refusal::kChangePending, "a trial is not over"};
  if (!retained_fits_locked()) {
    return failed("the retained values are those of another program still");
  }
  return base::Ok{};
}

base::Status Store::begin_trial(const ImageToStore& image, uint64_t retain_bytes) {
  std::lock_guard slots_lock(slots_mutex_);
  std::lock_guard lock(mutex_);
  check_slots_locked();
  if (base::Status may = may_begin_trial(); !may.ok()) return may;
  base::Status stored = write_image(1 - control_.slot, image, retain_bytes);
  if (!stored.ok()) return stored;
  ControlRecord next = control_;
  next.trial = true;
  next.tries_left = 1;
  next.trial_digest = image.digest;
  return write_control(next);
}

base::Status Store::end_trial() {
  std::lock_guard lock(mutex_);
  return end_trial_locked();
}

base::Status Store::end_trial_locked() {
  if (!control_.trial) return base::Ok{};
  ControlRecord next = control_;
  next.trial = false;
  next.tries_left = 0;
  next.trial_digest = {};
  return write_control(next);
}

base::Status Store::accept() {
  std::lock_guard slots_lock(slots_mutex_);
  std::lock_guard lock(mutex_);
  if (!control_.trial) {
    return base::Error{base::Refusal::kNothingToUndo, "there is no change in trial to accept"};
  }
  check_slots_locked();
  const size_t slot = 1 - control_.slot;
  if (in_slot_[slot] != control_.trial_digest) {
    return failed("the program on trial is not stored any more: " + slots_[slot].why);
  }
  return write_control(
      {control_.trial_digest, static_cast<uint8_t>(1 - control_.slot), false, 0, {}});
}

base::Status Store::settle() {
  std::lock_guard lock(mutex_);
  base::Status ended = end_trial_locked();
  return ended.ok() ? settle_locked() : ended;
}

base::Status Store::settle_locked() {
  base::Status settled = base::Ok{};
  for (size_t i = 0; has_control_ && settled.ok() && i < control_copies_.count(); ++i) {
    const bool whole = control_copies_.whole(0) && control_copies_.whole(1);
    if (!whole) settled = write_control(control_);
  }
  return settled;
}

// --- retained values --------------------------------------------------------------

bool Store::retained_fits_locked() const {
  const std::optional<size_t> newest = newest_retained();
  if (!newest) return true;
  return in_copy_[*newest]->image == control_.boots && !in_copy_[*newest]->trial;
}

bool Store::keeps_retained() const {
  std::lock_guard lock(mutex_);
  return saved_copy_ && retained_.valid(*saved_copy_);
}

bool Store::names_locked(const base::Digest& image) const {
  return has_control_ && (control_.boots == image || control_.is_trial(image));
}

bool Store::names(const base::Digest& image) const {
  std::lock_guard lock(mutex_);
  return names_locked(image);
}

bool Store::retained_fits() const {
  std::lock_guard lock(mutex_);
  return retained_fits_locked();
}

base::Status Store::save_retained(const base::Digest& image, uint64_t cycle,
                                  base::ByteSpan values) {
  std::lock_guard lock(mutex_);
  const bool trial = control_.is_trial(image);
  if (!trial && !(boots_valid() && control_.boots == image)) {
    return failed("the retained values are of a program that is not stored");
  }
  retained_.check();
  // What a lost trial goes back to stays until the trial is over and newer values are durable.
  const std::optional<size_t> newest = newest_retained();
  const bool on_trial = control_.trial || (newest && in_copy_[*newest]->image != control_.boots);
  const std::optional<size_t> before = newest_accepted();
  const std::optional<size_t> copy =
      retained_.victim([&](size_t i) { return on_trial && before == i; });
  if (!copy) return failed("no copy of the retained values is left: " + retained_.complaint());
  base::Status room = retained_.reserve(*copy, retain_payload_bytes(values.size()));
  if (!room.ok()) return room;
  if (!retained_[*copy].dead) in_copy_[*copy].reset();
  base::Status written = retained_.write(
      *copy, encode(RetainRecord{image, trial, cycle, base::Bytes(values.begin(), values.end())}));
  if (written.ok()) in_copy_[*copy] = RetainHead{image, trial};
  if (written.ok()) saved_copy_ = copy;
  show_retained();
  return written;
}

// --- journal ----------------------------------------------------------------------

void Store::note(JournalEntry entry) {
  std::lock_guard lock(journal_mutex_);
  (void)journal_.add(std::move(entry)).ok();  // complaints() has the error
  show_journals();
}

void Store::note_trap(JournalEntry entry) {
  std::lock_guard lock(journal_mutex_);
  (void)traps_.add(std::move(entry)).ok();
  show_journals();
}

std::vector<JournalEntry> Store::history() const {
  std::lock_guard lock(journal_mutex_);
  return by_time(journal_.entries(), traps_.entries());
}

}  // namespace online_change
