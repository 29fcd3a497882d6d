// What a controller keeps over a power cut: two programs, which of them boots, the retained values,
// and the journal. Every operation is durable when it returns without an error; a cut at any
// instant before leaves what was before, or what shall be. Programs are bytes and their digest
// here; whether they can run is the verifier's question.
//
// Three slots hold images; the control record says which one boots and which one, if any, is on
// trial. The third one takes the next edit, while the one that it is made on is still on trial. A
// slot is written over only when neither the control record nor a retained record that a boot would
// read needs it: so the layout of the retained values can always be read. Three copies of the
// retained values: the newest, the newest from before the trial, and the one written next.
//
// Storage may fail and be well again: an operation that has failed changes nothing here, and what
// it may have left on the disk is superseded by the next one that does not fail, or by renew().
//
// Thread-safe. Never called by the control thread: every operation waits for the disk.
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "online_change/store/control_record.h"
#include "online_change/store/copies.h"
#include "online_change/store/edits_record.h"
#include "online_change/store/journal.h"
#include "online_change/store/retain_record.h"
#include "online_change/store/trust_record.h"

namespace online_change {

inline constexpr size_t kDigestBytes = sizeof(base::Digest);

// Every folder that was ever used has one of these.
inline constexpr const char* kControlFiles[] = {"control_0", "control_1"};
inline constexpr const char* kSlotFiles[] = {"slot_a", "slot_b", "slot_c"};
inline constexpr const char* kRetainFiles[] = {"retain_0", "retain_1", "retain_2"};
inline constexpr const char* kJournalFile = "journal";
inline constexpr const char* kTrapsFile = "traps";  // Kept::kOften
inline constexpr const char* kBeforeFile = "before";
inline constexpr const char* kEditsFile = "edits";
inline constexpr const char* kTrustFile = "trust";

struct StoreSizes {
  uint64_t image_bytes = 1u << 20;  // to begin with: a longer image makes its slot longer
  uint64_t retain_bytes = 4096;     // likewise
  uint32_t journal_entries = 1024;
  uint32_t trap_entries = 256;
};

struct StoredImage {
  base::Digest digest{};
  base::Bytes bytes;
};

// StoredImage, borrowed. What the image says of itself is its digest: other bytes are found to be
// damaged when they are read.
struct ImageToStore {
  ImageToStore(const base::Digest& sum, base::ByteSpan all) : digest(sum), bytes(all) {}
  ImageToStore(const StoredImage& image)  // NOLINT: as good as borrowed
      : ImageToStore(image.digest, image.bytes) {}
  const base::Digest& digest;
  base::ByteSpan bytes;
};

// What was found at the start.
struct Recovered {
  std::optional<StoredImage> boots;
  // In another slot, if anything: what `newest` is of, else what was on trial, else any.
  std::optional<StoredImage> other;
  std::optional<RetainRecord> newest;  // retained values; of `boots` or `other`
  std::string no_newest;               // why there are none
  std::optional<RetainRecord> before;  // `newest` is of a lost trial: those of `boots` before it
  std::optional<base::Digest> trial_lost;  // unless it resumes
  bool resumes = false;
  std::vector<StoredImage> held;  // what else the slots hold
  bool virgin = false;              // nothing was ever stored here, as far as anybody can tell
  std::string nothing;              // why there is no `boots`
  std::vector<std::string> alarms;  // what is damaged
};

class Store {
 public:
  // Recovers; changes nothing of what is stored. Failing storage gives alarms, not an error.
  explicit Store(vm::Storage& storage, StoreSizes sizes = {});

  // To be taken once.
  Recovered take_recovered() { return std::move(recovered_); }
  // What boots cannot be used, says the verifier: as if its slot were damaged.
  void reject_boots();
  // A lost trial is over, and both control records are whole again.
  base::Status settle();
  // Settles, and a trial goes on.
  base::Status make_whole();

  // Installs this program: it boots from now on, nothing is on trial. `retain_bytes`: of its
  // retained values.
  base::Status install(const ImageToStore& image, uint64_t retain_bytes);
  // Writes an image of which nothing is known yet into the slot that begin_trial() would take,
  // beside whatever else is done, and keeps its bytes until then: begin_trial() of the same bytes
  // (in memory: not of the same digest) need not write it. Where it cannot be, nothing is done.
  void lay_aside(std::shared_ptr<const base::Bytes> image);
  void forget_aside();
  // The program is stored and on trial: what boots stays. What was on trial until now is so no
  // more: this is an edit that was made on top of it, or one below it. retained_fits() must be true
  // (kStorageFailed), but for an edit below that is still stored.
  // `resumes`: it boots, and stays on trial, as long as the edits that lead to it are kept.
  base::Status begin_trial(const ImageToStore& image, uint64_t retain_bytes,
                           bool resumes = false);
  base::Status set_resumes(bool resumes);
  // The edits on trial, oldest first. A cut leaves the ones that were kept before, or these.
  base::Status keep_edits(const std::vector<StoredEdit>& edits);
  base::Result<std::vector<StoredEdit>> edits() const;
  // What a controller with keys must not forget (trust_record.h); an empty one where there never
  // was any. kStorageFailed: it cannot be read, or is damaged.
  base::Status keep_trust(const TrustRecord& record);
  base::Result<TrustRecord> trust() const;
  base::Status end_trial();
  // What is on trial boots from now on.
  base::Status accept();
  // Accepts this program, an edit below the one that is on trial: it boots from now on, and the
  // other stays on trial. `values`: its retained values from before the edits above it, which a
  // lost trial goes back to.
  base::Status accept_below(const ImageToStore& image, uint64_t cycle, base::ByteSpan values);
  // The program that accept() is about to replace by `next`, in a file of its own: a cut leaves the
  // one that was kept before, or this one (X8). Nothing boots from it.
  base::Status keep_before(const ImageToStore& image, const base::Digest& next);
  // kNothingToUndo: there is none of the program that boots. kStorageFailed: it cannot be read, or
  // is damaged.
  base::Result<StoredImage> before() const;
  // The slot that shall hold this program, and does not any more, gets it again.
  base::Status restore(const ImageToStore& image);

  // `image` boots or is on trial, or was so until another edit was.
  base::Status save_retained(const base::Digest& image, uint64_t cycle, base::ByteSpan values);
  // May another trial begin: are the newest ones, if there are any, those of the program that
  // boots, not from its trial? On trial: is their layout not in the slot that is written next?
  bool retained_fits() const;
  // Retained values of this program, where those are the newest whose layout is known once it is
  // there: of what was stored with a program that cannot be read any more, and comes back.
  std::optional<base::Bytes> retained_of(const base::Digest& image) const;
  // The program that the newest of all retained values are of, stored or not.
  std::optional<base::Digest> retained_program() const;
  // Is what save_retained() has written last still stored?
  bool keeps_retained() const;
  // Does the control record name it, as what boots or is on trial?
  bool names(const base::Digest& image) const;

  // Does it name this one as what is on trial?
  bool tries(const base::Digest& image) const;

  // Told of each event before it is kept, by the thread that notes it; false: there were too many
  // of its kind, and it is not kept. To be set before there are threads.
  using Tell = std::function<bool(const JournalEntry& entry)>;
  void tell(Tell tell) { tell_ = std::move(tell); }
  // Something has happened: it is told, and kept where its row says.
  void note(JournalEntry entry);
  // Keeps an entry that has been told already.
  void keep(JournalEntry entry);
  // The entries of both rings, by time.
  std::vector<JournalEntry> history() const;

  // Looks whether all files are still there; complaints() names those that are not. To be called
  // now and then: what another thread is using is left for the next call.
  void look();
  // Copies that have failed, or whose file is gone, get a new file.
  base::Status renew();

  // boots() and complaints() do not wait for the disk.
  base::Digest boots() const;
  // What has failed and is not renewed, or is not stored any more.
  std::vector<std::string> complaints() const;

 private:
  struct RetainHead {
    base::Digest image{};
    bool trial = false;
  };

  static base::Error failed(std::string text);
  void recover_control();
  void recover_images();
  void recover_retained();
  void choose_other();
  base::Status write_control(const ControlRecord& next);
  base::Status write_slot(size_t slot, const ImageToStore& image);
  base::Status write_image(size_t slot, const ImageToStore& image, uint64_t retain_bytes);
  base::Status end_trial_locked();
  base::Status settle_locked();
  void check_slots_locked();
  bool needs_slot(size_t slot) const;
  bool needs_copy(size_t copy) const;
  base::Status renew_slots_locked();
  base::Status renew_retained_locked();
  base::Status renew_journals();
  void show_retained() const;
  void show_journals() const;
  // For boots() and complaints().
  enum Shown : size_t { kControl, kSlots, kBoots, kRetained, kJournal, kTraps, kShownKinds };
  void show(Shown kind, std::string complaint) const;
  void show_control() const;
  void show_slots() const;  // with slots_mutex_
  void show_boots() const;
  // Is there a slot for a trial?
  base::Status may_begin_trial() const;
  bool rests_in_free_slot(const base::Digest& image) const;
  void look_into_free_slot(const ImageToStore& image);
  bool boots_valid() const { return has_control_ && in_slot_[control_.slot] == control_.boots; }
  bool names_locked(const base::Digest& image) const;
  bool in_a_slot(const base::Digest& image) const;
  size_t free_slot() const;
  size_t free_trial_slot() const;
  base::Status write_retained(size_t copy, const RetainRecord& record, bool older);
  bool may_save_retained(const base::Digest& image) const;
  // The newest of the retained records that can be read, with a layout that is stored.
  std::optional<size_t> newest_retained() const;
  // The newest record from before the trial, when the newest of all is of a trial that has not been
  // accepted.
  std::optional<size_t> retained_before() const;
  // The newest of the program that boots, not from a trial.
  std::optional<size_t> newest_accepted() const;
  bool retained_fits_locked() const;

  // In this order: of the slots and which of them counts, held as long as one is written; of all
  // else but the journals; of those; of what is shown.
  std::mutex slots_mutex_;
  mutable std::mutex mutex_;
  mutable std::mutex before_mutex_;
  mutable std::mutex journal_mutex_;
  vm::Storage& storage_;
  StoreSizes sizes_;
  Tell tell_;
  Copies control_copies_;
  Copies slots_;
  Copies retained_;
  Journal journal_;
  Journal traps_;
  bool has_control_ = false;
  ControlRecord control_;
  // By slot and by copy; of valid ones.
  std::optional<base::Digest> in_slot_[kImageSlots];
  bool written_[kImageSlots] = {};            // by this process, so it is what its digest says
  std::shared_ptr<const base::Bytes> aside_;  // it is in that slot, which was free
  size_t aside_slot_ = 0;
  std::optional<RetainHead> in_copy_[3];
  std::optional<size_t> saved_copy_;  // save_retained() has written it last
  Recovered recovered_;

  mutable std::mutex shown_mutex_;
  mutable base::Digest shown_boots_{};
  mutable std::array<std::string, kShownKinds> shown_{};  // complaints
};

}  // namespace online_change
