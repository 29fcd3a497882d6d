#include "online_change/store/store.h"

#include <algorithm>

#include "base/check.h"
#include "ir/bytecode/image.h"
#include "ir/bytecode/image_sections.h"

namespace online_change {
namespace {

constexpr uint64_t kSpareParts = 16;  // of an image, for the edits that come: one more

std::vector<std::string> names_of(std::span<const char* const> names) {
  return {names.begin(), names.end()};
}

std::optional<StoredImage> image_of(base::Bytes payload) {
  if (payload.size() < kDigestBytes) return std::nullopt;
  StoredImage image;
  std::copy_n(payload.begin(), kDigestBytes, image.digest.begin());
  payload.erase(payload.begin(), payload.begin() + kDigestBytes);
  image.bytes = std::move(payload);
  return image;
}

ControlRecord accepted_in(size_t slot, const base::Digest& image) {
  ControlRecord out;
  out.boots = image;
  out.slot = static_cast<uint8_t>(slot);
  return out;
}

}  // namespace

base::Error Store::failed(std::string text) {
  return {base::Refusal::kStorageFailed, std::move(text)};
}

Store::Store(vm::Storage& storage, StoreSizes sizes)
    : storage_(storage),
      sizes_(sizes),
      control_copies_(storage, RecordKind::kControl, names_of(kControlFiles)),
      slots_(storage, RecordKind::kImage, names_of(kSlotFiles)),
      retained_(storage, RecordKind::kRetain, names_of(kRetainFiles)),
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
  control_copies_.recover(kMostControlBytes);
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
  recovered_.resumes = has_control_ && control_.trial && control_.resumes;
}

void Store::recover_images() {
  slots_.recover(kDigestBytes + sizes_.image_bytes);
  for (size_t i = 0; i < slots_.count(); ++i) {
    if (!slots_.valid(i)) continue;
    std::optional<StoredImage> image = image_of(slots_.take_payload(i));
    if (!image) {
      slots_.reject(i);
      continue;
    }
    in_slot_[i] = image->digest;
    const bool boots = has_control_ && control_.slot == i && control_.boots == image->digest;
    if (boots) {
      recovered_.boots = std::move(*image);
    } else {
      recovered_.held.push_back(std::move(*image));
    }
  }
  if (!has_control_ || recovered_.boots) return;
  recovered_.nothing = std::string("the program that boots, ") + base::short_hex(control_.boots) +
                       " in " + slots_[control_.slot].name + ", is damaged or unreadable";
}

// --- the program that boots -------------------------------------------------------

void Store::reject_boots() {
  std::lock_guard lock(mutex_);
  if (boots_valid()) in_slot_[control_.slot].reset();
  show_boots();
}

base::Status Store::write_control(const ControlRecord& next) {
  base::check(next.slot < kImageSlots && next.trial_slot < kImageSlots, "a slot is one of three");
  base::check(!next.trial || next.slot != next.trial_slot,
              "what boots and what is on trial lie in two slots");
  // What stood in the record before may be damaged since.
  const auto lies_in = [&](uint32_t slot, const base::Digest& image) {
    return !in_slot_[slot] || in_slot_[slot] == image;
  };
  const bool same_boots = next.slot == control_.slot && next.boots == control_.boots;
  base::dcheck(same_boots || lies_in(next.slot, next.boots),
               "what boots is in the slot that the control record names");
  const bool same_trial =
      next.trial_slot == control_.trial_slot && next.trial_digest == control_.trial_digest;
  base::dcheck(!next.trial || same_trial || lies_in(next.trial_slot, next.trial_digest),
               "what is on trial is in the slot that the control record names");
  base::dcheck(next.trial || (next.tries_left == 0 && !next.resumes), "without a trial, no tries");
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
    base::Status room = retained_.reserve(i, retain_record_bytes(retain_bytes));
    if (!room.ok()) return room;
  }
  const bool whole = slots_.whole(slot);
  if (whole && written_[slot] && in_slot_[slot] == image.digest) return base::Ok{};
  const bool aside = whole && aside_ != nullptr && aside_slot_ == slot &&
                     aside_->data() == image.bytes.data() && aside_->size() == image.bytes.size();
  aside_.reset();
  if (!aside) {
    in_slot_[slot].reset();
    written_[slot] = false;
    base::Status written = write_slot(slot, image);
    show_slots();
    if (!written.ok()) return written;
  }
  base::dcheck(slots_.whole(slot), "an image that was written is in a whole slot");
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
    slot = free_trial_slot();
    in_slot_[slot].reset();
    written_[slot] = false;
  }
  const base::Status written = write_slot(slot, {ir::digest(*image), *image});
  std::lock_guard lock(mutex_);
  show_slots();
  if (!written.ok()) return;
  aside_ = std::move(image);
  aside_slot_ = slot;
}

void Store::forget_aside() {
  std::lock_guard slots_lock(slots_mutex_);
  std::lock_guard lock(mutex_);
  aside_.reset();
}

// Without a program that boots: not the one whose layout the retained values have.
size_t Store::free_slot() const {
  if (boots_valid()) return free_trial_slot();
  for (size_t slot = 0; slot < kImageSlots; ++slot) {
    if (!in_slot_[slot]) return slot;
  }
  const std::optional<size_t> newest = newest_retained();
  if (!newest) return has_control_ ? control_.slot : 0;
  return in_slot_[0] == in_copy_[*newest]->image ? 1 : 0;
}

// Neither what boots nor what is on trial lies there, nor, as may_begin_trial() says, what a
// retained record needs. Rather one that is not dead.
size_t Store::free_trial_slot() const {
  std::optional<size_t> free;
  for (size_t slot = 0; slot < kImageSlots; ++slot) {
    const bool taken = slot == control_.slot || (control_.trial && slot == control_.trial_slot);
    if (taken) continue;
    if (!free || (slots_[*free].dead && !slots_[slot].dead)) free = slot;
  }
  base::check(free.has_value(), "of three slots, one is free");
  return *free;
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
  stored = write_control(accepted_in(slot, image.digest));
  if (!stored.ok()) return stored;
  return settle_locked();
}

base::Status Store::may_begin_trial() const {
  if (!boots_valid()) return failed("no program is stored that the change could be undone to");
  if (retained_fits_locked()) return base::Ok{};
  return failed("the retained values are those of another program still");
}

// The way back to an edit below: it is in the free slot still, so that nothing is written there.
bool Store::rests_in_free_slot(const base::Digest& image) const {
  const size_t slot = free_trial_slot();
  return boots_valid() && control_.trial && slots_.whole(slot) && written_[slot] &&
         in_slot_[slot] == image;
}

// What another process has written there is compared first.
void Store::look_into_free_slot(const ImageToStore& image) {
  if (!boots_valid() || !control_.trial) return;
  const size_t slot = free_trial_slot();
  if (written_[slot] || in_slot_[slot] != image.digest || !slots_.whole(slot)) return;
  const Record record = read_record(storage_, slots_[slot].name, RecordKind::kImage);
  if (record.state != RecordState::kValid) return;
  const std::optional<StoredImage> stored = image_of(record.payload);
  written_[slot] = stored && stored->digest == image.digest &&
                   std::ranges::equal(stored->bytes, image.bytes);
}

base::Status Store::begin_trial(const ImageToStore& image, uint64_t retain_bytes, bool resumes) {
  std::lock_guard slots_lock(slots_mutex_);
  std::lock_guard lock(mutex_);
  check_slots_locked();
  look_into_free_slot(image);
  base::Status may = may_begin_trial();
  if (!may.ok() && !rests_in_free_slot(image.digest)) return may;
  const size_t slot = free_trial_slot();
  base::Status stored = write_image(slot, image, retain_bytes);
  if (!stored.ok()) return stored;
  ControlRecord next = control_;
  next.trial_slot = static_cast<uint8_t>(slot);
  next.resumes = resumes;
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
  next.resumes = false;
  return write_control(next);
}

base::Status Store::accept() {
  std::lock_guard slots_lock(slots_mutex_);
  std::lock_guard lock(mutex_);
  if (!control_.trial) {
    return base::Error{base::Refusal::kNothingToUndo, "there is no change in trial to accept"};
  }
  check_slots_locked();
  // The values may be of an edit that was undone: what that has dropped would be gone.
  if (!retained_fits_locked()) return failed("the retained values are of another program still");
  const size_t slot = control_.trial_slot;
  if (in_slot_[slot] != control_.trial_digest) {
    return failed("the program on trial is not stored any more: " + slots_[slot].why);
  }
  return write_control(accepted_in(slot, control_.trial_digest));
}

// The control record is written last: until then a boot finds what was accepted before, with the
// values that belong to it. The new ones go after the newest, which are those of the trial.
base::Status Store::accept_below(const ImageToStore& image, uint64_t cycle,
                                 base::ByteSpan values) {
  std::lock_guard slots_lock(slots_mutex_);
  std::lock_guard lock(mutex_);
  if (!control_.trial) {
    return base::Error{base::Refusal::kNothingToUndo, "there is no change in trial to accept"};
  }
  check_slots_locked();
  const std::optional<size_t> newest = newest_retained();
  const bool of_trial = newest && in_copy_[*newest]->image == control_.trial_digest;
  if (!of_trial) return failed("the retained values are those of another program still");
  const size_t slot = free_trial_slot();
  base::Status stored = write_image(slot, image, values.size());
  if (!stored.ok()) return stored;
  const std::optional<size_t> before = newest_accepted();
  const std::optional<size_t> copy = retained_.victim([&](size_t i) { return before == i; });
  if (!copy) return failed("no copy of the retained values is left: " + retained_.complaint());
  stored = write_retained(
      *copy, {image.digest, false, cycle, base::Bytes(values.begin(), values.end())}, true);
  if (!stored.ok()) return stored;
  ControlRecord next = control_;
  next.boots = image.digest;
  next.slot = static_cast<uint8_t>(slot);
  return write_control(next);
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

// --- what is stored --------------------------------------------------------------

bool Store::in_a_slot(const base::Digest& image) const {
  return std::find(std::begin(in_slot_), std::end(in_slot_), image) != std::end(in_slot_);
}

bool Store::names_locked(const base::Digest& image) const {
  return has_control_ && (control_.boots == image || control_.is_trial(image));
}

bool Store::tries(const base::Digest& image) const {
  std::lock_guard lock(mutex_);
  return control_.is_trial(image);
}

bool Store::names(const base::Digest& image) const {
  std::lock_guard lock(mutex_);
  return names_locked(image);
}

// --- journal ----------------------------------------------------------------------

void Store::note(JournalEntry entry) {
  if (!tell_ || tell_(entry)) keep(std::move(entry));
}

void Store::keep(JournalEntry entry) {
  const Kept kept = event_row(entry.event).kept;
  if (kept == Kept::kMemory) return;
  std::lock_guard lock(journal_mutex_);
  Journal& ring = kept == Kept::kOften ? traps_ : journal_;
  (void)ring.add(std::move(entry)).ok();  // complaints() has the error
  show_journals();
}

std::vector<JournalEntry> Store::history() const {
  std::lock_guard lock(journal_mutex_);
  return by_time(journal_.entries(), traps_.entries());
}

}  // namespace online_change
