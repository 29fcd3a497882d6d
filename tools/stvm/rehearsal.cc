#include "tools/stvm/rehearsal.h"

#include <cstring>
#include <vector>

#include "ir/bytecode/symbols.h"

namespace stvm {

base::Result<std::unique_ptr<Rehearsal>> Rehearsal::stage(const vm::Controller& running,
                                                          base::ByteSpan package,
                                                          online_change::Strategy strategy,
                                                          online_change::TakenOut taken_out,
                                                          const LiveReport::CopyRanges& copy_of) {
  auto rehearsal = std::make_unique<Rehearsal>();
  base::Status started = rehearsal->start(running, copy_of);
  if (!started.ok()) return started.error();
  rehearsal->change_ = std::make_unique<online_change::Change>(*rehearsal->controller_);
  base::Status staged = rehearsal->change_->stage(package, strategy, {}, taken_out);
  if (!staged.ok()) return staged.error();
  return rehearsal;
}

base::Status Rehearsal::start(const vm::Controller& running,
                              const LiveReport::CopyRanges& copy_of) {
  const uint32_t bytes = running.image().data_capacity;
  base::Result<vm::LiveCopy> copy = copy_of({{0, bytes}});
  if (!copy.ok()) return copy.error();
  vm::ControllerOptions options;
  options.halted = true;  // nothing ever runs here but migrations, on copies of their own
  options.data_limit = running.data_limit();
  options.tier.tier = vm::Tier::kInterpreter;
  auto started = vm::Controller::start(running.verified(), options, clock_, io_);
  if (!started.ok()) return started.error();
  controller_ = std::move(*started);
  uint8_t* const data = controller_->memory().data();
  std::memcpy(data, copy->memory().data(), bytes);
  controller_->generation().write_pool(data);
  return adopt_forces(running);
}

base::Status Rehearsal::adopt_forces(const vm::Controller& running) {
  std::vector<vm::NamedValue> forces;
  for (const vm::Force& force : running.forces()) {
    forces.push_back({force.path, vm::value_text(running.image(), force)});
  }
  if (forces.empty()) return base::Ok{};
  auto change = controller_->prepare_force(forces);
  if (!change.ok()) return change.error();
  controller_->use(**change);
  return base::Ok{};
}

}  // namespace stvm
