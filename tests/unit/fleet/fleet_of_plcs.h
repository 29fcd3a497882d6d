// A fleet in one process: controllers as tests/unit/store makes them, each with its disk, reached
// by the client of the commands without a socket.
#pragma once

#include <atomic>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "linker/edit_steps.h"
#include "tests/unit/store/plc.h"
#include "tests/unit/store/sim_storage.h"
#include "tools/stvm/fleet_visit.h"

namespace fleet_test {

struct Member {
  sim::SimStorage disk;
  plc::Plc plc{disk};
};

class Fleet {
 public:
  // A controller called `name` with a program of that source.
  void add(const std::string& name, const std::string& source);
  plc::Plc& plc(const std::string& name);
  // From now on it has no controllers.
  void clear();
  const std::vector<stvm::FleetMember>& members() const { return members_; }
  // As `user`. The controller answers until it is cut off.
  base::Result<stvm::ControllerClient> connect(const std::string& name, const std::string& user);
  void cut_off(const std::string& name) { gone_ = name; }
  stvm::FleetAccess access();

  // The edit from one source to the other.
  void edit(const std::string& original, const std::string& edited);
  // Its units start one after the other; or only where there is no room for all of them.
  void start_each(linker::StepOrder order, bool if_needed = false);
  const stvm::FleetEdit& edit() const { return edit_; }
  // Asked before each message to a controller; false: it is lost, and its answer with it.
  std::function<bool()> before_message;
  // Called before a package is made, with the number of the controller that it is for.
  std::function<void()> before_package;
  // No package of this step is made, for that reason.
  std::optional<std::pair<size_t, base::Refusal>> refuses;

 private:
  base::Result<base::Bytes> package(const base::Bytes& running, size_t step) const;
  // What stvm::take_out() does with the stc beside it.
  static base::Result<stvm::Outcome> take_out(const stvm::SwitchOptions& how,
                                              stvm::ControllerClient& client,
                                              const std::string& edit,
                                              const std::vector<std::string>& on_trial);

  std::vector<stvm::FleetMember> members_;
  std::vector<std::unique_ptr<Member>> plcs_;
  std::optional<ir::VerifiedImage> original_;
  std::optional<ir::VerifiedImage> edited_;
  stvm::FleetEdit edit_;
  std::string gone_;
  std::atomic<uint64_t> sessions_{1};
};

// How a fleet is changed where nobody is asked and nothing is printed.
stvm::SwitchOptions quietly();

}  // namespace fleet_test
