// What a serving controller answers. Runs on the channel's thread; whatever reads or writes live
// data goes to the control thread through vm::Boundary: what is read is copied there, in portions
// that no scan waits for (live_copy.h), what is set is written at one boundary. Everything else
// (decoding, finding names, checking, planning, formatting) stays here, beside the running program.
// This thread alone changes which version runs.
#pragma once

#include <atomic>
#include <optional>
#include <set>

#include "base/limits.h"
#include "online_change/apply/change.h"
#include "online_change/plan/every_fate.h"
#include "online_change/store/boot.h"
#include "online_change/store/retain_keeper.h"
#include "tools/stvm/admission.h"
#include "tools/stvm/aside_writer.h"
#include "tools/stvm/event_log.h"
#include "tools/stvm/fate_message.h"
#include "tools/stvm/live_report.h"
#include "tools/stvm/rehearsal.h"
#include "tools/stvm/trial_guard.h"
#include "tools/stvm/unit_table.h"
#include "vm/runtime/asked_values.h"
#include "vm/runtime/boundary.h"
#include "vm/runtime/live_copy.h"
#include "vm/runtime/protocol.h"
#include "vm/runtime/recorder.h"
#include "vm/runtime/socket_server.h"

namespace stvm {

// What a store says of the start, for status and journal.
struct StartReport {
  std::optional<base::Digest> trial_lost;
  std::vector<std::string> alarms;
  std::string fault = {};                       // of Boot
  std::string who = {};                         // started it
  Trust* trust = nullptr;                       // keys of the controller; null: it has none
  uint64_t most_upload = base::kMaxImageBytes;  // bytes; tests have less
};
// What finds too little time before the next cycle is tried again so much later.
inline constexpr int64_t kBetweenAttemptsNs = 1'000'000;
// So many cycles after a switch, a version on trial that traps is undone by the controller (X7).
inline constexpr uint64_t kProbationCycles = 1000;
inline constexpr int kProbationLookMs = 20;  // between two looks at it
// In the alarm that says so.
inline constexpr const char* kGivenBackMark = " undone by the controller at ";
// ns since 1970.
int64_t wall_time_ns();
// "2026-03-01T08:00:00.123Z"
std::string time_text(int64_t time_ns);

class ControllerService : public vm::Service {
 public:
  ControllerService(vm::Controller& controller, vm::Clock& clock, online_change::Store& store,
                    vm::Boundary& boundary, StartReport start = {},
                    online_change::RetainKeeper::WallTime wall_time = wall_time_ns);
  // Sets the version of the program that serves.
  void is_version(std::string version) { version_ = std::move(version); }
  // What changes something from now on is noted there; it must outlive this.
  void record(vm::Recorder& recorder) { recorder_ = &recorder; }
  // A replay: no cycle comes while a request is carried out, so idle time is what it was then.
  void stand_between_cycles() { stands_ = true; }
  // Sets the log whose events are shown to those who ask; it must outlive this.
  void show_events(const EventLog& log) { events_ = &log; }
  // The trial of another process goes on (D4); before anything is answered. What cannot is an
  // alarm, and its edits have no way back. `alarms`: further ones of the start.
  void resume(const std::vector<online_change::ResumedEdit>& edits,
              const std::vector<std::string>& alarms = {});
  // A clean end: at the next start what is on trial goes on, whatever the policy.
  void keep_trial_over_stop();
  // From now on an image that is staged is written to the store by a thread of its own, beside its
  // verification: the storage must allow that threads use different files at once.
  void store_beside();
  void asked_by(const std::string& user, uint64_t session, bool bridged = false) override {
    who_ = user;
    session_ = session;
    local_ = !bridged;
  }
  // What was uploaded over it, and what the pages of its reports are of, is given back.
  void ended(uint64_t session) override;
  // C9: the change that is being prepared is given up.
  void asker_left() override;
  std::optional<base::Bytes> answer_urgent(const std::string& user,
                                           base::ByteSpan request) override;
  base::Bytes answer(base::ByteSpan request, bool& keep_open) override;
  // Forces run in machine code as soon as there is some, and programs whose files are gone are
  // stored again.
  void keep_up() override;
  int keep_up_ms() const override {
    return probation_ || guard_.looks_aside() || watches_unless() ? kProbationLookMs : 1000;
  }
  bool stop_wanted() const { return stop_wanted_.load(std::memory_order_acquire); }
  // Who wanted it; after stop_wanted().
  const std::string& stopped_by() const { return stopped_by_; }
  online_change::RetainKeeper& keeper() { return keeper_; }
  // How many edits are on trial; for the control thread.
  size_t edits_on_trial() const { return change_.on_trial(); }

 private:
  base::Bytes answer_within_memory(base::ByteSpan request, bool& keep_open);
  using Answer = base::Result<base::Bytes>;

  Answer dispatch(const vm::Request& request);
  // An answer to each command: controller_*.cc.
#define COMMAND(id, name, handler, body, changes_state, meaning) \
  Answer handler(const vm::Request& request);
#include "vm/runtime/commands.def"
#undef COMMAND
  std::vector<vm::TaskActivity> activities() const;
  static base::Error too_long();
  base::Bytes force_rows(const std::vector<std::string>& names) const;
  Answer before_edit(const vm::Request& request);
  static Answer image_part(const base::Digest& digest, const base::Bytes& encoded, uint64_t offset);

  // controller_units.cc
  // An edit on trial, or one that was undone.
  struct Trial {
    TrialEdit edit;
    ir::VerifiedImage before;  // that it was made on
    base::Bytes package;
    uint32_t flags = 0;  // as it was staged with
    uint32_t switch_flags = 0;
    online_change::Snapshot retained;  // of `before`, at the switch
    std::string taken_out = {};        // the edit whose work it takes back; "": none
    uint64_t chain = 0;                // steps of one edit have the same (E-26); 0: it is none
    Signer signer = {};                // of its package, when it was brought
  };
  const ir::VerifiedImage* previous() const {
    return trials_.empty() ? nullptr : &trials_.back().before;
  }
  void note_edit(Trial trial, const online_change::SwitchReport& report, int64_t predicted_ns);
  // The oldest `edits` boot as version `next`. `watched`: whose trial it was; "": nobody's.
  void note_accepted(size_t edits, const base::Digest& next, const std::string& watched);
  // A name must be that of the newest one.
  base::Status check_newest(const vm::Request& request) const;
  // From the oldest; none of that name.
  online_change::TakenOut trial_taken_out(const std::string& edit) const;
  // After a switch or an undo of this cycle.
  void note_units(const char* event, uint64_t cycle);
  // What is staged, as an edit; before it is forgotten.
  TrialEdit describe_staged() const;
  static TrialEdit describe(const ir::VerifiedImage& running, const ir::VerifiedImage& next,
                            const online_change::Plan& plan);

  base::Status check_expected(const vm::Request& request) const;
  // Runs `job` on the control thread at a boundary and waits for its end.
  base::Status at_boundary(const std::function<void()>& job);
  // The same for a job that only reads: a recording has nothing of it.
  base::Status look_at_boundary(const std::function<void()>& job);
  // `take(free_ns)` at boundaries until it has everything.
  base::Status copy_at_boundaries(const std::function<vm::Copied(int64_t)>& take);
  base::Result<vm::LiveCopy> copy_of(std::vector<ir::DataRange> ranges);
  // Reports on the change that is looked_at(). `next`, `whole`: as LiveReport::take().
  base::Status look(const ir::Image* next, bool whole);
  Answer every_page(uint64_t first, const online_change::Plan& plan, const ir::Image& next,
                    FatePage page);
  Answer group_page(uint64_t first, const online_change::Plan& plan, const ir::VerifiedImage& next,
                    bool back, FatePage page) const;
  base::Status look_back(size_t below);
  void forget_staged();
  void forget_report();
  base::Error others_upload() const;
  // kBadHash, kFault.
  base::Status check_upload(const vm::Request& request, base::ByteSpan package) const;
  Answer stage_package(base::Bytes package, uint32_t flags, const std::string& unless,
                       const std::string& redone, const std::string& taken_out,
                       const Signer& signer);
  Answer stage_rehearsal(base::ByteSpan package, online_change::Strategy strategy, uint32_t flags,
                         const std::string& taken_out);
  double pace();  // of this machine (online_change/apply/pace.h)
  base::Status stage_unless_aborted(base::ByteSpan package, online_change::Strategy strategy);
  // The change that this connection stages, rehearses or, on trial, would undo.
  const online_change::Change& looked_at() const;
  bool rehearses() const { return rehearsal_ && rehearsal_of_ == session_; }
  // Arms at a boundary with time enough for a look at all values.
  base::Status arm_in_time(bool allow_loss, bool allow_overrun, base::Status& armed);
  // `before`: the retained values of the program that it takes the place of.
  base::Result<online_change::SwitchReport> switch_in_time(bool allow_overrun,
                                                           online_change::Snapshot& before,
                                                           uint64_t& missed_before,
                                                           int64_t& done_ns);
  bool time_for_switch() const;
  // All that comes before the switch itself. What has failed is noted.
  // E-14: what is staged is what the asker has checked.
  base::Status check_staged(const vm::Request& request) const;
  base::Status prepare_switch(const vm::Request& request, Trial& next, bool faulted,
                              bool allow_overrun);
  // What the change must have done before the switch, cycle by cycle in idle time (C5).
  base::Status configure(bool allow_overrun);
  // By standby, brings up to date what the program has written meanwhile (C7).
  base::Status catch_up();
  // False: no idle time is left to go on in, or the controller stands.
  base::Result<bool> work_in_idle_time(base::Result<bool> (online_change::Change::*work)());
  online_change::SwitchReport finish_report(online_change::SwitchReport report,
                                            uint64_t missed_before, int64_t done_ns);
  // Notes the refusal of a switch.
  base::Error not_switched(const base::Error& why);
  // The running image boots next, and only then the change is final, with all that it was made on.
  base::Status make_permanent();
  // Makes the oldest `edits` of those on trial; the others stay so.
  base::Status make_oldest_permanent(size_t edits);

  // controller_abort.cc
  struct Unless {  // a BOOL of the running program; while it is TRUE nothing is switched
    std::string name;
    uint32_t data = 0;  // where it is in data memory; 0: there is none
    bool seen = false;  // TRUE at a boundary, since it was named
  };
  // Where it is; 0: none is named.
  base::Result<uint32_t> find_unless(const std::string& name) const;
  // Checks the condition of a dry run beside another change.
  base::Status check_unless(const std::string& name);
  // At a boundary: it is TRUE, now or since it was named.
  bool unless_holds();
  bool watches_unless() const;
  void watch_unless();
  // Beside boundaries: did anybody, or the condition, end what is being prepared?
  bool aborted();
  base::Error abort_error() const;
  // Gives the change up: the standby side is cleared, and it is noted why. Returns the error that
  // says so.
  base::Error give_up();
  // What was staged over this connection has been given up.
  base::Status check_not_aborted() const;

  // controller_first.cc
  bool has_no_program() const;
  // To what is staged. Accepted at once.
  Answer switch_to_first();
  // The first program boots from now on. `retained`: what is stored of its values, if anything.
  base::Status store_first(base::Bytes& retained);
  // At a boundary after its switch.
  void begin_first(base::ByteSpan retained);

  // controller_trial.cc
  struct Probation {           // of the version on trial
    uint64_t ends = 0;         // cycle
    std::string health;        // a BOOL that must stay TRUE; "": none
    uint32_t health_data = 0;  // where it is in data memory
    std::string edit;          // its name
  };
  static base::Status check_health(const std::string& name, const ir::Image& next);
  base::Status check_not_gone() const;
  void forget_rehearsal();
  // At a boundary: the newest trap since the last switch, and before cycle `end`, that has stopped
  // its task or all of them; null: none. Allocates nothing.
  const vm::TrapRecord* stopping_trap(uint64_t end) const;
  void begin_probation(const vm::Request& request);
  // Why the version on trial must go; "" while nothing speaks against it.
  std::string look_at_trial();
  void watch_trial();
  void give_back(const std::string& why);
  // Is the newest edit on trial one that more was to follow (E-26)?
  bool is_incomplete() const;
  // What is switched is, or is not, one of several steps.
  void begin_or_end_chain(Trial& trial);
  void go_on_hot();
  base::Result<base::Bytes> undo_now(const std::string& why, online_change::Exits exits,
                                     online_change::Losses losses);
  // "edit E2, without FB_Exit of Main.a: why"

  // controller_journal.cc
  online_change::JournalEntry entry(online_change::Event event) const;
  // Notes the end of a command that is no change.
  void note_done(online_change::Event event, const std::string& who, std::string text);
  // Notes it, and is the error.
  base::Error refused(const base::Error& error);
  // Stored as being on trial, and durable, before anything of it runs.
  base::Status store_trial(Trial& next);
  // What is on trial in the store is what is on trial here, or nothing.
  base::Status store_follows();
  void let_store_follow();
  // D4: does what is on trial boot? Of the newest edit.
  bool last_edit_boots() const {
    return !trials_.empty() && (trials_.back().switch_flags & vm::kLastEditBoots) != 0;
  }
  // The edits on trial, with one that is switched next. The store has one version to go back to:
  // where there are more, or where the newest boots, it has the edits, too.
  base::Status keep_edits(const Trial* next = nullptr);
  // The program that runs, and the one that undo would bring back.
  base::Status keep_programs();
  void keep_programs_now_and_then();
  base::Status save_retained_now();
  // A program that was held since nobody knew what boots: now it does.
  base::Status install_held();
  online_change::Snapshot empty_snapshot() const;
  void complain(const base::Status& status);
  void note_switch(online_change::Event event, const base::Digest& from,
                   const online_change::SwitchReport& report, int64_t predicted_ns,
                   const std::string& why = {});

  vm::Controller& controller_;
  vm::Clock& clock_;
  online_change::Store& store_;
  vm::Boundary& boundary_;
  vm::Recorder* recorder_ = nullptr;
  const EventLog* events_ = nullptr;
  std::string version_ = "unknown";
  StartReport start_;
  online_change::RetainKeeper::WallTime wall_time_;
  online_change::RetainKeeper keeper_;
  std::string who_;
  std::string changed_by_;  // who made the newest edition
  uint64_t session_ = 0;
  bool local_ = true;  // nobody asks over a bridge
  Admission admission_;
  uint64_t more_of_ = 0;  // session that brings an edit in several steps; 0: none does
  uint64_t chains_ = 0;   // such edits until now
  online_change::Change change_;
  UnitTable units_;
  std::vector<Trial> trials_;  // oldest first
  std::vector<Trial> undone_;  // of which the last one can be brought again
  uint64_t edits_made_ = 0;    // since the start: names
  base::Bytes upload_;
  uint64_t upload_of_ = 0;  // session
  std::string upload_by_;
  uint64_t live_of_ = 0;
  uint64_t history_of_ = 0;
  base::Bytes no_memory_;  // the answer that says so
  std::optional<ir::VerifiedImage> staged_;
  base::Bytes staged_package_;
  uint32_t staged_flags_ = 0;
  base::Digest staged_digest_{};  // of the package that was sent; zeros: brought again by redo
  Signer signer_;                 // of what is staged
  std::string redone_;            // name of the edit that is staged again; "": a new one
  double pace_ = 0;               // 0: not measured yet
  std::string taken_out_;         // the edit on trial whose work it takes back; "": none
  uint64_t staged_of_ = 0;        // session
  bool preparing_ = false;        // a request is about it just now
  bool stands_ = false;           // stand_between_cycles()
  std::string abort_why_;         // by whom or what it ends; "": it goes on
  std::string aborted_;           // the same of the last one that ended so, with its time
  uint64_t aborted_of_ = 0;       // session
  Unless unless_;                 // of what is staged
  std::string note_;              // what the journal says of it, by whoever brought it (E-33)
  bool only_looked_at_ = false;   // what is staged, by vm::kRehearsal: nothing of it is kept
  uint64_t looked_at_by_ = 0;     // session of that
  std::set<uint64_t> gone_;       // sessions whose dry run has been replaced
  std::unique_ptr<Rehearsal> rehearsal_;
  uint64_t rehearsal_of_ = 0;                         // session
  std::optional<LiveReport> live_;                    // of the change that is looked_at()
  std::optional<online_change::EveryFate> every_;     // of the same
  std::vector<online_change::JournalEntry> history_;  // that pages of the journal are of
  std::string not_undone_;                            // why the automatic undo failed: an alarm
  std::string given_back_;                            // what was undone by itself: an alarm
  std::optional<Probation> probation_;                // in its first cycles
  TrialGuard guard_;                                  // of the trial of a roll-out
  online_change::StoredImage before_;                 // that pages of kBefore are of
  uint64_t before_of_ = 0;                            // session
  uint64_t switched_cycle_ = 0;                       // cycles before the last switch
  uint64_t edition_ = 0;
  std::atomic<bool> stop_wanted_{false};
  std::string stopped_by_;
  AsideWriter aside_;  // by store_beside()
  vm::AskedValues asked_;
  online_change::BackOff keep_again_;
  bool store_is_behind_ = false;  // what was switched or undone is not stored
};

}  // namespace stvm
