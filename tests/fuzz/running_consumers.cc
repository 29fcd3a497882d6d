#include <functional>
#include <optional>
#include <vector>

#include "ir/bytecode/symbols.h"
#include "online_change/apply/change.h"
#include "online_change/store/retained_values.h"
#include "tests/fuzz/answered.h"
#include "tests/fuzz/consumers.h"
#include "tools/stvm/plot.h"
#include "vm/io/device_io.h"
#include "vm/io/global_exchange.h"
#include "vm/io/simulated_driver.h"
#include "vm/runtime/clocks.h"
#include "vm/runtime/controller.h"
#include "vm/runtime/io.h"

namespace fuzz {
namespace {

using namespace online_change;

constexpr int kScans = 4;

// As a controller has it: simulated devices in virtual time.
struct Plant {
  explicit Plant(const ir::VerifiedImage& image, vm::Tier tier, base::ByteSpan retained = {}) {
    vm::ControllerOptions options;
    options.fuel_budget = 2000;
    options.tier.tier = tier;
    auto started = vm::Controller::start(image, options, clock, io, retained);
    if (answered(started)) controller = *std::move(started);
  }
  void run() {
    for (int i = 0; i < kScans; ++i) controller->cycle();
  }
  base::Digest hash() { return ir::state_hash(controller->image(), controller->memory().view()); }

  vm::VirtualClock clock;
  vm::DeviceIo io{{vm::make_simulated_driver, {}, &clock}};
  std::unique_ptr<vm::Controller> controller;  // null: it was refused
};

// Paths of some variables, with values as people type them.
std::vector<vm::NamedValue> some_values(const ir::Image& image, const vm::Controller& controller) {
  std::vector<vm::NamedValue> values;
  uint32_t number = 0;
  ir::for_each_leaf(image, [&](const std::string& path, const ir::Symbol&) {
    if (number++ % 5 != 0 || values.size() > 20) return;
    const base::Result<std::string> value = controller.get(path);
    if (answered(value)) values.push_back({path, *value});
  });
  return values;
}

// A picture of the run; of what cannot be drawn there is none.
void plot(Plant& plant) {
  vm::Controller& controller = *plant.controller;
  std::vector<std::string> names;
  for (const vm::NamedValue& value : some_values(controller.image(), controller)) {
    if (stvm::Plot::of(controller, {value.path}).ok()) names.push_back(value.path);
  }
  if (names.empty()) return;
  auto drawn = stvm::Plot::of(controller, names);
  base::check(drawn.ok(), "what can be drawn alone is drawn beside others");
  for (int i = 0; i < kScans; ++i) {
    controller.cycle();
    drawn->sample(controller);
  }
  base::check(drawn->svg(controller.image().name).ends_with("</svg>\n"), "a whole picture");
}

void set_and_force(Plant& plant) {
  vm::Controller& controller = *plant.controller;
  const auto values = some_values(controller.image(), controller);
  for (const vm::NamedValue& value : values) answered(controller.set(value.path, value.value));
  std::vector<std::string> forced;
  for (const vm::NamedValue& value : values) {
    if (answered(controller.force(value.path, value.value))) forced.push_back(value.path);
  }
  plant.run();
  for (const std::string& path : forced) answered(controller.unforce(path));
}

void look_at(vm::Controller& controller) {
  controller.tasks();
  controller.devices();
  for (const auto& trap : controller.traps()) {
    base::check(!trap->text.text.empty(), "a trap has a text");
  }
}

}  // namespace

void carry_values(const ir::VerifiedImage& from, const ir::VerifiedImage& to) {
  if (!answered(retained_bytes(from.image())) || !answered(retained_bytes(to.image()))) return;
  const base::Bytes values = initial_retained(from.image());
  const base::Result<CarriedValues> carried = carry_retained(from, values, to);
  if (!answered(carried)) return;
  answered(carry_retained_back(to, carried->values, from, values));
  if (!can_run(to)) return;
  Plant warm(to, vm::Tier::kInterpreter, carried->values);
  if (warm.controller != nullptr) warm.run();
}

void run_image(const ir::VerifiedImage& image) {
  if (!can_run(image)) return;
  Plant plant(image, vm::Tier::kInterpreter);
  Plant native(image, vm::Tier::kNative);
  base::check((plant.controller == nullptr) == (native.controller == nullptr), "both start");
  if (plant.controller == nullptr) return;
  plant.run();
  native.run();
  base::check(plant.hash() == native.hash(), "both tiers give the same values");
  look_at(*plant.controller);
  set_and_force(plant);
  set_and_force(native);
  plot(plant);
  for (const vm::Restart kind : {vm::Restart::kCold, vm::Restart::kWarm, vm::Restart::kHot}) {
    answered(plant.controller->restart(kind, 1'000'000));
    plant.run();
  }
  native.controller->make_outputs_safe();
}

namespace {

// True: it is on trial.
bool switch_to(Change& change, const base::Bytes& package, Strategy strategy) {
  if (!answered(change.stage(package, strategy))) return false;
  for (const LiveLoss& loss : change.live_losses()) {
    base::check(!loss.what.empty(), "what is lost says how");
  }
  return answered(change.arm(true, true)) && answered(change.switch_now());
}

}  // namespace

void change_images(const ir::VerifiedImage& from, const ir::VerifiedImage& to, Strategy strategy) {
  if (!can_run(from) || !can_run(to)) return;
  const base::Result<Package> package = make_package(from.encoded(), to.encoded());
  if (!answered(package)) return;
  Plant plant(from, vm::Tier::kInterpreter);
  if (plant.controller == nullptr) return;
  plant.run();
  Change change(*plant.controller);
  const base::Bytes bytes = encode(*package);
  if (!switch_to(change, bytes, strategy)) {
    change.cancel();
    return plant.run();
  }
  plant.run();
  if (answered(change.undo())) {
    plant.run();
    if (!switch_to(change, bytes, strategy)) return change.cancel();
    plant.run();
  }
  if (change.state() == State::kTrial) answered(change.accept());
  plant.run();
}

void exchange_globals(const ir::VerifiedImage& one, const ir::VerifiedImage& other) {
  if (!can_run(one) || !can_run(other)) return;
  auto exchange = vm::GlobalExchange::make({{"one", one}, {"other", other}});
  if (!answered(exchange)) return;
  vm::VirtualClock clock;
  vm::NullIo devices;
  std::vector<std::unique_ptr<vm::ResourcePort>> ports;
  std::vector<std::unique_ptr<vm::Controller>> controllers;
  for (size_t i = 0; i < 2; ++i) {
    ports.push_back(std::make_unique<vm::ResourcePort>(**exchange, i, clock, devices));
    vm::ControllerOptions options;
    options.fuel_budget = 2000;
    options.tier.tier = vm::Tier::kInterpreter;
    auto started = vm::Controller::start(i == 0 ? one : other, options, clock, *ports.back());
    if (!answered(started)) return;
    controllers.push_back(*std::move(started));
  }
  for (int i = 0; i < kScans; ++i) {
    for (const auto& controller : controllers) controller->cycle();
  }
  ports[0]->status();
}

}  // namespace fuzz
