// What `stvm fleet` does with each controller: it is connected to, looked at, and perhaps changed.
// A visit ends in a row of the result, whatever happens, and stops no other (E-30).
#pragma once

#include <functional>
#include <memory>
#include <optional>

#include "ir/bytecode/verify.h"
#include "tools/stvm/controller_client.h"
#include "tools/stvm/fleet_edit.h"
#include "tools/stvm/fleet_list.h"
#include "tools/stvm/fleet_result.h"
#include "tools/stvm/undo_only.h"

namespace stvm {

class FleetAgents;

// How controllers are reached, and what makes a package of the edit for the program that runs on
// one. Several threads call them.
struct FleetAccess {
  std::function<base::Result<ControllerClient>(const FleetMember&)> connect;
  // `step`: of an edit that comes in several, from 1; 0: all of it.
  std::function<base::Result<base::Bytes>(const base::Bytes& running, size_t step)> package;
  // One edit of several on trial.
  std::function<decltype(take_out)> take_back = take_out;
  std::string sign = {};  // of a roll-out: SwitchOptions::sign
  // Those that a broker leads to; null: there are none.
  std::shared_ptr<FleetAgents> agents = {};
};

// What is said on the way, and the person at the terminal, who may be done with all of it. Quiet:
// nothing is said.
class FleetTalk {
 public:
  explicit FleetTalk(bool quiet) : quiet_(quiet) {}
  bool quiet() const { return quiet_; }
  bool is_over() const { return quit_; }
  // The row of a controller, under its headline.
  FleetRow begin(const FleetMember& member) const;
  void say(const std::string& text) const;
  // kBusy with `otherwise`: somebody said no.
  base::Status ask(const char* question, const char* otherwise);
  // What a visit ends with.
  FleetRow ended(FleetRow row, FleetOutcome outcome, const base::Error& why) const;
  // The row after an error in the middle of the visit: a controller that is gone is unreachable.
  FleetRow failed(FleetRow row, const base::Error& why) const;

 private:
  bool quiet_;
  bool all_ = false;
  bool quit_ = false;
};

struct FleetSeen {
  ControllerClient client;
  base::Bytes running;
  ir::VerifiedImage image;
};
// Connects, waits for the changes of others where it is told to, and asks for the program. Else
// `row` has ended.
std::optional<FleetSeen> see(const FleetAccess& access, const FleetTalk& talk,
                             const FleetMember& member, FleetRow& row, bool waits = false);

// One of the verbs. It goes by `how`, of which `ask`, `dry_run` and `switch_flags` count; json:
// quiet. The edit must outlive it.
class FleetVisit {
 public:
  virtual ~FleetVisit() = default;
  FleetVisit(const FleetVisit&) = delete;
  FleetVisit& operator=(const FleetVisit&) = delete;
  virtual FleetRow visit(const FleetMember& member) = 0;

 protected:
  // Whoever says no to the question reads `otherwise`.
  FleetVisit(const FleetEdit& edit, SwitchOptions how, FleetAccess access, const char* question,
             const char* otherwise);
  // Somebody said no, or something failed.
  FleetRow not_done(FleetRow row, const base::Result<Outcome>& outcome) const;

  const FleetEdit& edit_;
  SwitchOptions how_;
  FleetAccess access_;
  FleetTalk talk_;
};

// E-28, E-11 to E-15: the check, then the change.
class FleetChange : public FleetVisit {
 public:
  FleetChange(const FleetEdit& edit, SwitchOptions how, FleetAccess access);
  FleetRow visit(const FleetMember& member) override;

 private:
  FleetRow had_it(FleetSeen& seen, FleetRow row);
  FleetRow change(const SwitchOptions& how, FleetSeen& seen, FleetRow row);
  // E-25, E-26: each unit by itself; all or none of them.
  FleetRow change_in_steps(SwitchOptions how, FleetSeen& seen, FleetRow row);
  base::Result<Outcome> bring_step(const SwitchOptions& how, FleetSeen& seen, size_t step);
  FleetRow taken_back(FleetSeen& seen, FleetRow row, const base::Error& why) const;
  FleetRow finished(const SwitchOptions& how, FleetRow row, const Outcome& outcome) const;
};

// E-32: the edit goes again where it is on trial.
class FleetUndo : public FleetVisit {
 public:
  FleetUndo(const FleetEdit& edit, SwitchOptions how, FleetAccess access);
  FleetRow visit(const FleetMember& member) override;
};

// E-32: the edit becomes final there where it is on trial.
FleetRow make_final(const FleetEdit& edit, const SwitchOptions& how, FleetTalk& talk,
                    FleetSeen& seen, FleetRow row);
class FleetAccept : public FleetVisit {
 public:
  FleetAccept(const FleetEdit& edit, SwitchOptions how, FleetAccess access);
  FleetRow visit(const FleetMember& member) override;
};

// E-11: what a controller has of the edit; nothing is changed. Ok, or why it cannot be changed.
base::Status check_parts(const FleetEdit& edit, const ir::VerifiedImage& image, FleetRow& row);
// The same of parts that are known without the image; `table`: what was found of its own table.
base::Status check_parts(const FleetEdit& edit, const std::vector<ir::Part>& here,
                         const base::Status& table, FleetRow& row);
// X6: where an edit is on trial no roll-out begins.
base::Error rolls_on_trial();
// E-32: of the edit, or, without one, all that it has.
FleetRow look_at(const FleetEdit* edit, const FleetAccess& access, const FleetTalk& talk,
                 const FleetMember& member);

// `stvm fleet diff`; the exit code.
int compare_fleet(const tools::Options& options, const FleetAccess& access);

}  // namespace stvm
