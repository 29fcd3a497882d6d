#include "tests/fuzz/consumers.h"

#include <functional>
#include <optional>
#include <vector>

#include "base/check.h"
#include "ir/bytecode/embedded_sources.h"
#include "ir/bytecode/name_index.h"
#include "ir/bytecode/renames.h"
#include "ir/bytecode/symbols.h"
#include "linker/merge.h"
#include "online_change/apply/change.h"
#include "online_change/plan/system_edits.h"
#include "online_change/plan/pou_edits.h"
#include "online_change/store/retained_values.h"
#include "tools/common/fate_report.h"
#include "tools/common/source_edits.h"
#include "tools/stc/image_text.h"
#include "vm/io/device_io.h"
#include "vm/io/global_exchange.h"
#include "vm/io/simulated_driver.h"
#include "vm/runtime/clocks.h"
#include "vm/runtime/controller.h"
#include "vm/runtime/io.h"
#include "vm/runtime/memory_report.h"
#include "vm/runtime/shared_globals.h"

namespace fuzz {
namespace {

using namespace online_change;

constexpr int kScans = 4;

void must_say_why(const base::Error& error) {
  base::check(!error.text.empty() || error.refusal == base::Refusal::kNoMemory, "a reason");
  base::check(error.refusal != base::Refusal::kInternal,
              "a reason that one can do something about");
}
template <class T>
bool answered(const base::Result<T>& result) {
  if (!result.ok()) must_say_why(result.error());
  return result.ok();
}
bool answered(const base::Status& status) {
  if (!status.ok()) must_say_why(status.error());
  return status.ok();
}

bool can_run(const ir::VerifiedImage& image) { return image.image().data_capacity <= kMostData; }

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
  base::Digest hash() {
    return ir::state_hash(controller->image(), controller->memory().view());
  }

  vm::VirtualClock clock;
  vm::DeviceIo io{{vm::make_simulated_driver, {}, &clock}};
  std::unique_ptr<vm::Controller> controller;  // null: it was refused
};

// A look into the table of names gives what a walk over the image does.
void find_by_both(const ir::NameIndex& names, const std::string& path) {
  const base::Result<ir::Symbol> walked = ir::find_symbol(names.image(), path);
  const base::Result<ir::Symbol> looked = ir::find_symbol(names, path);
  base::check(walked.ok() == looked.ok(), "a name is there for both");
  if (!walked.ok()) return base::check(walked.error().text == looked.error().text, "one reason");
  base::check(ir::same_place(*walked, *looked) && walked->type == looked->type &&
                  walked->constant == looked->constant,
              "a name is one variable for both");
}

void read_values(const ir::Image& image) {
  const ir::NameIndex names(image);
  std::vector<uint8_t> memory(image.data_capacity);
  for (const ir::DataRun& run : image.data) {
    std::copy(run.bytes.begin(), run.bytes.end(), memory.begin() + run.offset);
  }
  base::check(ir::state_text(image, memory).size() != 1, "lines of values");
  ir::for_each_leaf(image, [&](const std::string& path, const ir::Symbol& symbol) {
    const base::Result<ir::Symbol> found = ir::find_symbol(image, path);
    find_by_both(names, path);
    find_by_both(names, path.substr(0, path.rfind('.')));
    if (answered(found)) ir::path_of(image, *found);
    ir::format_value(image, symbol, memory);
    if (const auto value = ir::parse_value(image, symbol.type, "1"); !value.ok()) {
      must_say_why(value.error());
    }
  });
}

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

void compare_texts(const ir::VerifiedImage& from, const ir::VerifiedImage& to, const Plan& plan) {
  const auto edits = pou_edits(from.image(), to.image());
  const EncodedImage before{from.image(), from.encoded()};
  const EncodedImage after{to.image(), to.encoded()};
  pou_edits(before, after);
  check_restricted(edits).ok();
  auto system = system_edits(from.image(), to.image());
  for (auto& edit : tools::source_edits(from.encoded(), to.encoded())) {
    system.push_back(std::move(edit));
  }
  base::check(!tools::fate_report(plan, {}, edits, system).empty(), "a report");
}

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

}  // namespace

void read_image(const ir::VerifiedImage& verified) {
  const ir::Image& image = verified.image();
  for (const ir::LinkedPou& pou : image.pous) ir::disassemble(image, pou);
  base::check(!stc::image_text(image, verified.digest()).empty(), "tables as text");
  stc::symbols_text(image);
  vm::memory_report(image);
  const vm::SharedGlobals shared(image);
  for (uint32_t id = 0; id < image.instances.size(); ++id) image.instance_path(id);
  if (const auto sources = ir::sources_of(verified.encoded()); answered(sources)) {
    const auto texts = ir::unpack_sources(*sources);
    base::check(!answered(texts) || texts->size() == sources->files.size(), "a text of each");
  }
  if (can_run(verified)) read_values(image);
}

void compare_images(const ir::VerifiedImage& from, const ir::VerifiedImage& to) {
  carry_values(from, to);
  ir::under_new_names(from.image(), to.image());
  const base::Result<Package> package = make_package(from.encoded(), to.encoded());
  if (!answered(package)) return;
  compare_texts(from, to, package->forward);
  answered(check_package(*package, from.image(), to.image()));
  answered(decode(encode(*package)));
  const base::Bytes brief = encode_short(*package, from.encoded());
  const base::Result<Package> again = decode(brief, from.encoded());
  base::check(again.ok() && encode(*again) == encode(*package), "the short form is the same");
}

void merge_images(const ir::VerifiedImage& original, const ir::VerifiedImage& edited,
                  const ir::VerifiedImage& target) {
  const auto merged =
      linker::merge({original.image(), edited.image(), target.image()}, {{}, true});
  if (!answered(merged)) return;
  answered(ir::verify(ir::encode(*merged)));
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
