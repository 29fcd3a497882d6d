#include "tests/unit/fleet/fleet_of_plcs.h"

#include <algorithm>

#include "base/check.h"
#include "linker/merge.h"
#include "online_change/package/package.h"
#include "tools/stvm/undo_only.h"

namespace fleet_test {
namespace {

// One connection to a controller of this process.
class Line : public vm::Transport {
 public:
  Line(plc::Plc& plc, std::string user, uint64_t session, const std::function<bool()>& arrives)
      : plc_(plc), user_(std::move(user)), session_(session), arrives_(arrives) {}
  ~Line() override { plc_.service().ended(session_); }
  base::Result<base::Bytes> exchange(base::ByteSpan request) override {
    if (arrives_ && !arrives_()) return base::Error{base::Refusal::kNotRunning, "cut"};
    plc_.service().asked_by(user_, session_);
    bool keep_open = true;
    return plc_.service().answer(request, keep_open);
  }

 private:
  plc::Plc& plc_;
  std::string user_;
  uint64_t session_;
  const std::function<bool()>& arrives_;
};

base::Result<base::Bytes> merged_package(const ir::VerifiedImage& original,
                                         const ir::VerifiedImage& edited,
                                         const base::Bytes& running,
                                         const linker::MergeOptions& how) {
  base::Result<ir::VerifiedImage> target = ir::verify(running);
  if (!target.ok()) return target.error();
  base::Result<ir::Image> merged =
      linker::merge({original.image(), edited.image(), target->image()}, how);
  if (!merged.ok()) return merged.error();
  auto made = online_change::make_package(running, ir::encode(*merged));
  if (!made.ok()) return made.error();
  return online_change::encode(*made);
}

}  // namespace

void Fleet::add(const std::string& name, const std::string& source) {
  members_.push_back({name, name, false});
  plcs_.push_back(std::make_unique<Member>());
  base::check(plcs_.back()->plc.boot(source).ok(), "a controller of the fleet starts");
  plcs_.back()->plc.run(2);
}

void Fleet::clear() {
  members_.clear();
  plcs_.clear();
}

plc::Plc& Fleet::plc(const std::string& name) {
  for (size_t i = 0; i < members_.size(); ++i) {
    if (members_[i].name == name) return plcs_[i]->plc;
  }
  base::check(false, "the fleet has such a controller");
  return plcs_.front()->plc;
}

base::Result<stvm::ControllerClient> Fleet::connect(const std::string& name,
                                                    const std::string& user) {
  if (name == gone_) return base::Error{base::Refusal::kNotRunning, "cut off"};
  return stvm::ControllerClient(
      std::make_unique<Line>(plc(name), user, ++sessions_, before_message));
}

stvm::FleetAccess Fleet::access() {
  return {[this](const stvm::FleetMember& member) { return connect(member.name, "fleet"); },
          [this](const base::Bytes& running, size_t step) {
            if (before_package) before_package();
            if (refuses && refuses->first == step) {
              return base::Result<base::Bytes>(base::Error{refuses->second, "of the test"});
            }
            return package(running, step);
          },
          take_out};
}

void Fleet::edit(const std::string& original, const std::string& edited) {
  original_ = plc::build(original);
  edited_ = plc::build(edited, &original_->image());
  edit_.digest = edited_->digest();
  edit_.parts.original = ir::parts_of(original_->image());
  edit_.parts.edited = ir::parts_of(edited_->image());
  edit_.parts.edited_image = *edited_;
  edit_.parts.free_table = true;
}

void Fleet::start_each(linker::StepOrder order, bool if_needed) {
  edit_.steps = *linker::edit_steps({original_->image(), edited_->image()}, order);
  edit_.steps_if_needed = if_needed;
}

// What `stc package` does with a fleet file.
base::Result<base::Bytes> Fleet::package(const base::Bytes& running, size_t step) const {
  linker::MergeOptions how;
  how.matching = edit_.matching;
  if (step != 0) how.step = edit_.steps[step - 1];
  return merged_package(*original_, *edited_, running, how);
}

base::Result<stvm::Outcome> Fleet::take_out(const stvm::SwitchOptions& how,
                                            stvm::ControllerClient& client, const std::string& edit,
                                            const std::vector<std::string>& on_trial) {
  const auto found = std::find(on_trial.begin(), on_trial.end(), edit);
  base::check(client.status().ok(), "the controller answers");
  base::Result<base::Bytes> before = client.image_before(edit);
  base::Result<base::Bytes> after = client.image_before(*(found - 1));
  base::Result<base::Bytes> running = client.image();
  base::Result<base::Bytes> package =
      merged_package(*ir::verify(*after), *ir::verify(*before), *running, {});
  if (!package.ok()) return package.error();
  stvm::SwitchOptions noted = how;
  noted.note = stvm::take_out_note(edit);
  return bring(noted, client, *package);
}

stvm::SwitchOptions quietly() {
  stvm::SwitchOptions how;
  how.switch_flags = vm::kAllowOverrun;
  how.ask = false;
  how.json = true;
  return how;
}

}  // namespace fleet_test
