// A plant under test: versions in Structured Text, or in IR text (which begins with "program"),
// compiled, linked against what runs, run on virtual time, changed and undone through Change as a
// controller does it.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "linker/link.h"
#include "online_change/apply/change.h"
#include "vm/runtime/clocks.h"
#include "vm/runtime/controller.h"
#include "vm/runtime/io.h"

namespace plant {

// Every process image that was sent, and terminals for inputs.
class Devices : public vm::SimulatedIo {
 public:
  void send(std::span<const uint8_t> outputs) override {
    sent.emplace_back(outputs.begin(), outputs.end());
  }
  std::vector<base::Bytes> sent;
};

// Objects of one source text.
struct Compiled {
  ir::Program program;
  std::vector<ir::Object> objects;
};
Compiled compile(const std::string& source);

struct Settings {
  linker::Slack slack = {};
  vm::ControllerOptions options = {};
  int64_t ns_per_safe_point = 0;
};

class Plant {
 public:
  explicit Plant(const std::string& source, linker::Slack slack = {}, int64_t ns_per_safe_point = 0)
      : Plant(source, Settings{slack, {}, ns_per_safe_point}) {}
  Plant(const std::string& source, const Settings& settings);

  // How change() and stage() go about it; at first what STC_TEST_STRATEGY says, else in place.
  void use(online_change::Strategy strategy) { strategy_ = strategy; }

  void run(int scans);
  std::string get(const std::string& path) const;
  void set(const std::string& path, const std::string& value);
  base::Digest hash() const;

  // Compiles and links against the running version; the encoded package.
  base::Bytes package(const std::string& source, bool move_all = false);
  base::Status stage(base::ByteSpan package, std::optional<size_t> taken_out = std::nullopt) {
    const online_change::TakenOut taken =
        taken_out ? online_change::TakenOut{change_.get(), *taken_out} : online_change::TakenOut{};
    return change_->stage(package, strategy_, {}, taken);
  }
  // Stages, arms and switches. Fails the test when anything is refused.
  online_change::SwitchReport change(const std::string& source, bool allow_loss = false,
                                     bool move_all = false);
  // The code with which the change is refused; kInternal when it is not.
  base::Refusal refused(const std::string& source, bool allow_loss = false);
  void undo();
  void accept();

  const online_change::Plan& plan() const { return plan_; }
  const online_change::FateRow* row(const std::string& path) const;
  vm::Controller& controller() { return *controller_; }
  vm::VirtualClock& clock() { return clock_; }
  online_change::Change& driver() { return *change_; }
  Devices& devices() { return devices_; }
  uint32_t id_of(const std::string& path) const;  // of a live instance; 0 when there is none

 private:
  ir::VerifiedImage link(const std::string& source, bool move_all);
  const Compiled& compiled(const std::string& source);

  // The last two texts: thousands of edits go back and forth between them.
  struct Known {
    std::string source;
    std::optional<Compiled> compiled;
  };
  std::array<Known, 2> known_;
  linker::Slack slack_;
  online_change::Strategy strategy_;
  vm::VirtualClock clock_;
  Devices devices_;
  std::unique_ptr<vm::Controller> controller_;
  std::unique_ptr<online_change::Change> change_;
  online_change::Plan plan_;
};

}  // namespace plant
