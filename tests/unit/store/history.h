// A controller's durable life on a simulated disk, and what must be found after a cut at any
// instant of it. Programs and retained values say of themselves which version they are, so that a
// mixture shows.
#pragma once

#include <memory>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "online_change/store/store.h"
#include "tests/unit/store/sim_storage.h"

namespace history {

online_change::StoredImage program(uint32_t version);
base::Bytes values(uint32_t version, uint64_t count);

// What was promised, and what is being done: a cut may leave either.
struct Promises {
  std::optional<uint32_t> boots;       // version; none: nothing was installed
  std::optional<uint32_t> boots_next;  // an operation is under way that changes it
  std::optional<uint32_t> trial;
  std::vector<uint32_t> below;  // edits on trial that this one was made on, oldest first
  bool trial_sure = true;       // no operation is under way that changes it
  uint64_t count = 0;           // of the retained values saved last; 0: none
  uint64_t count_begun = 0;     // of those being saved
  uint64_t count_accepted = 0;  // of those saved last for the program that boots, not on trial
  uint64_t notes = 0;
  uint64_t notes_begun = 0;
};

inline constexpr uint32_t kNotes = 6;  // entries of the journal
online_change::StoreSizes small();

class History {
 public:
  // On a disk that is empty, or as a cut left it.
  explicit History(sim::SimStorage& disk) : disk_(disk) {}
  History(sim::SimStorage& disk, const Promises& promises) : disk_(disk), now_(promises) {}

  // Recovers; "" or what is wrong.
  std::string open();
  // The recovered state becomes what is promised from now on.
  void believe();

  // Each is one thing that a controller does. False: storage failed.
  bool install(uint32_t version);
  bool settle();
  bool save();
  bool begin_trial(uint32_t version);
  bool undo();
  bool accept();
  // The oldest edit on trial, which is not the only one.
  bool accept_oldest();
  bool note();
  // One of these. False: storage failed.
  bool any_operation(uint64_t seed);
  // The disk fails at some calls of one of these, in any way, and is well behind it. What has
  // failed is renewed, or the controller goes on without.
  void fault(uint64_t seed);

  const Promises& promises() const { return now_; }
  bool on_trial() const { return now_.trial.has_value(); }
  uint32_t running() const { return now_.trial ? *now_.trial : *now_.boots; }
  const online_change::Recovered& found() const { return found_; }

 private:
  std::string check_program() const;
  std::string check_trial() const;
  std::string check_values() const;
  std::string check_journal();
  void renew();
  std::vector<online_change::JournalEntry> written_notes();

  sim::SimStorage& disk_;
  std::unique_ptr<online_change::Store> store_;
  online_change::Recovered found_;
  Promises now_;
  uint32_t highest_ = 1;  // version
};

// A whole life, chosen by `seed`; with faults, the disk fails now and then.
void live(History& history, uint64_t seed, uint32_t operations, bool faults = false);

}  // namespace history
