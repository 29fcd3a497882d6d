// One controller, its devices, its people and its bad luck, all drawn from one seed: production
// code (Controller, Change, the service of the control channel, its client) with clock, devices and
// transport replaced. The same seed is the same run on every machine.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "online_change/package/package.h"
#include "online_change/store/boot.h"
#include "tests/differential/random.h"
#include "tests/differential/tree.h"
#include "tests/golden/runner/compile.h"
#include "tests/sim/event_check.h"
#include "tests/sim/faulty_transport.h"
#include "tests/sim/stepped_boundary.h"
#include "tests/unit/store/sim_storage.h"
#include "tools/stvm/controller_client.h"
#include "tools/stvm/controller_service.h"
#include "vm/runtime/io.h"

namespace sim {

struct Tally {
  uint64_t steps = 0;
  uint64_t boundaries = 0;
  uint64_t switches = 0;  // undos included
  uint64_t refusals = 0;
  uint64_t faults = 0;
  uint64_t cuts = 0;
  uint64_t plant_ns = 0;  // of the plant's time
};

// What was used most of the heap, in an hour of the plant's time.
using Hourly = std::function<void(int hour, uint64_t most_bytes)>;

class World {
 public:
  // `trace`: every step is printed.
  World(uint64_t seed, bool trace);
  ~World();
  // Throws Violation. False: the seed's program does not compile.
  bool run(int steps);
  // endurance.cc: a step every few seconds of `hours` of the plant's time, scans in between. Memory
  // must stay flat: no hour uses much more than the first.
  bool endure(int hours, const Hourly& hourly);
  const Tally& tally() const { return tally_; }

 private:
  struct Version {
    differential::Program tree;
    golden::Program compiled;
  };
  struct Hand {  // a tool that is connected
    FaultyTransport* way = nullptr;
    std::optional<stvm::ControllerClient> client;
    vm::StatusReport seen;
  };

  bool begin();
  void step();
  void act(uint32_t kind);
  void scan_for(int64_t ns);
  void forget_versions();
  uint32_t strategy();  // of a change, as a flag of the protocol
  void let_run();
  void change();
  void bad_package();
  void two_tools();
  void undo();
  void accept();
  void write_values();
  void force();
  void restart();
  // power.cc
  void save();
  // Storage is well again, and its keeper finds that out.
  void renew();
  void keeper_round();
  void disk_fault();
  void power_cut();

  // Given, or what the disk says.
  void boot(const std::optional<ir::VerifiedImage>& given);
  void any_operation();
  void come_back();
  void remember_retained();
  Hand connect();
  // Its next exchanges may fail, one time in four.
  void bad_luck(Hand& hand);
  // What a status without faults says; checks what must hold of every status.
  vm::StatusReport settled();
  std::optional<base::Bytes> package_for(const base::Digest& base, Version& next);
  std::shared_ptr<Version> edited_version(const base::Digest& base);
  // stage, look at the fates, switch; what came of it.
  base::Status try_change(Hand& hand, base::ByteSpan package, uint32_t flags);
  void switched(const Snapshot& before, const Snapshot& now);
  // told.cc: what has happened has been told.
  void device_fault();
  bool given_back();
  void check_events();
  void expect_start(const online_change::Boot& boot);
  // If it was refused, by a controller that could answer.
  void told_refused(const Hand& hand, const base::Status& done);
  void say(const std::string& text);
  void refused(const base::Error& error);

  differential::Random random_;
  bool trace_;
  Tally tally_;
  vm::VirtualClock clock_;
  bool may_delay_ = false;  // the change at hand was allowed to
  vm::SimulatedIo devices_;
  SimStorage disk_;
  std::unique_ptr<online_change::Store> store_;
  std::unique_ptr<EventCheck> events_;
  std::unique_ptr<vm::Controller> controller_;
  std::unique_ptr<SteppedBoundary> boundary_;
  std::unique_ptr<stvm::ControllerService> service_;
  std::map<base::Digest, std::shared_ptr<Version>> versions_;
  std::shared_ptr<Version> first_;
  size_t most_text_ = SIZE_MAX;  // of a program that is edited further; the first one, instead
  // What a boot may find: programs, and the retained values of one of these boundaries.
  std::vector<base::Digest> may_boot_;
  std::vector<Values> retained_;
  bool disk_failed_ = false;
  base::Bytes last_package_;
  // The edits on trial, oldest first.
  struct OnTrial {
    base::Digest before{};             // what it was made on
    std::optional<Snapshot> at_switch;  // the boundary; null: that was before a power cut
  };
  std::vector<OnTrial> on_trial_;
  size_t edits_ = 0;  // at the last look
};

}  // namespace sim
