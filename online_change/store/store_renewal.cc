// What the store does about storage that has failed, or that somebody has removed: what is dead
// gets a new file, and until then status shows it.
#include "online_change/store/store.h"

namespace online_change {

base::Status Store::restore(const ImageToStore& image) {
  std::lock_guard slots_lock(slots_mutex_);
  std::lock_guard lock(mutex_);
  if (!names_locked(image.digest)) return base::Ok{};
  const size_t slot = control_.boots == image.digest ? control_.slot : control_.trial_slot;
  if (in_slot_[slot] == image.digest && !slots_[slot].dead) return base::Ok{};
  base::Status written = write_slot(slot, image);
  if (written.ok()) in_slot_[slot] = image.digest;
  if (written.ok()) written_[slot] = true;
  show_slots();
  return written;
}

void Store::check_slots_locked() {
  slots_.check();
  for (size_t i = 0; i < slots_.count(); ++i) {
    if (slots_.valid(i)) continue;
    in_slot_[i].reset();
    written_[i] = false;
  }
  show_slots();
}

bool Store::needs_slot(size_t slot) const {
  const std::optional<base::Digest>& image = in_slot_[slot];
  const std::optional<size_t> newest = newest_retained();
  return image && (names_locked(*image) || (newest && in_copy_[*newest]->image == image));
}

// Renews dead slots that hold no program that is needed; restore() writes the others.
base::Status Store::renew_slots_locked() {
  base::Status renewed = base::Ok{};
  for (size_t i = 0; i < slots_.count() && renewed.ok(); ++i) {
    if (!slots_[i].dead || slots_.unread(i) || needs_slot(i)) continue;
    in_slot_[i].reset();
    slots_.reject(i);
    renewed = slots_.renew(i);
  }
  show_slots();
  return renewed;
}

bool Store::needs_copy(size_t copy) const {
  return newest_retained() == copy || newest_accepted() == copy;
}

base::Status Store::renew_retained_locked() {
  base::Status renewed = base::Ok{};
  for (size_t i = 0; i < retained_.count() && renewed.ok(); ++i) {
    const bool needed = retained_.valid(i) && needs_copy(i);
    if (!retained_[i].dead || retained_.unread(i) || needed) continue;
    in_copy_[i].reset();
    retained_.reject(i);
    renewed = retained_.renew(i);
  }
  show_retained();
  return renewed;
}

base::Status Store::renew_journals() {
  std::lock_guard lock(journal_mutex_);
  base::Status renewed = journal_.renew();
  const base::Status traps = traps_.renew();
  show_journals();
  return renewed.ok() ? traps : renewed;
}

void Store::look() {
  {
    const std::unique_lock slots_lock(slots_mutex_, std::try_to_lock);
    std::lock_guard lock(mutex_);
    control_copies_.check();
    show_control();
    if (slots_lock.owns_lock()) check_slots_locked();
    retained_.check();
    show_retained();
  }
  std::lock_guard lock(journal_mutex_);
  journal_.check();
  traps_.check();
  show_journals();
}

base::Status Store::renew() {
  base::Status all = base::Ok{};
  const auto keep = [&](const base::Status& renewed) {
    if (all.ok()) all = renewed;
  };
  {
    const std::unique_lock slots_lock(slots_mutex_, std::try_to_lock);
    std::lock_guard lock(mutex_);
    keep(settle_locked());
    if (slots_lock.owns_lock()) keep(renew_slots_locked());
    keep(renew_retained_locked());
  }
  keep(renew_journals());
  return all;
}

void Store::show(Shown kind, std::string complaint) const {
  std::lock_guard lock(shown_mutex_);
  shown_[kind] = std::move(complaint);
}

void Store::show_control() const {
  show(kControl, control_copies_.complaint());
  std::lock_guard lock(shown_mutex_);
  shown_boots_ = control_.boots;
}

void Store::show_retained() const { show(kRetained, retained_.complaint()); }

void Store::show_journals() const {
  show(kJournal, journal_.complaint());
  show(kTraps, traps_.complaint());
}

void Store::show_slots() const {
  show(kSlots, slots_.complaint());
  show_boots();
}

void Store::show_boots() const {
  const bool lost = has_control_ && !boots_valid();
  const bool trial_lost = control_.trial && in_slot_[control_.trial_slot] != control_.trial_digest;
  std::string text;
  if (lost) {
    text = "the program that boots next, " + base::short_hex(control_.boots) +
           ", is not stored: a power cut would leave nothing to boot";
  } else if (trial_lost) {
    text = "the program on trial, " + base::short_hex(control_.trial_digest) + ", is not stored";
  }
  show(kBoots, std::move(text));
}

base::Digest Store::boots() const {
  std::lock_guard lock(shown_mutex_);
  return shown_boots_;
}

std::vector<std::string> Store::complaints() const {
  std::lock_guard lock(shown_mutex_);
  std::vector<std::string> out;
  for (const std::string& text : shown_) {
    if (!text.empty()) out.push_back(text);
  }
  return out;
}

}  // namespace online_change
