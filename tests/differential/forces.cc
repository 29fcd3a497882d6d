#include "tests/differential/forces.h"

#include <algorithm>
#include <functional>
#include <map>
#include <memory>
#include <vector>

#include "tests/differential/compiled.h"
#include "tests/differential/random.h"
#include "vm/load/writers.h"
#include "vm/runtime/clocks.h"
#include "vm/runtime/controller.h"

namespace differential {
namespace {

constexpr int kScansBefore = 2;
constexpr uint64_t kFuel = 500'000;
constexpr uint32_t kMostForces = 30;

class AskingClock : public vm::VirtualClock {
 public:
  AskingClock() : VirtualClock(0) {}
  void consumed(uint64_t) override {
    if (ask) ask();
  }
  std::function<void()> ask;
};

class NoDevices : public vm::IoPort {
 public:
  void receive(std::span<uint8_t>) override {}
  void send(std::span<const uint8_t>) override {}
};

struct Mode {
  const char* name;
  vm::Tier tier;
  vm::Fusing fusing;
  uint64_t fuel_slice;
  bool republished;       // an identity change after every scan
  bool optimised = true;  // else each variable is read where the source reads it: the oracle
};
constexpr Mode kModes[] = {
    {"no passes", vm::Tier::kInterpreter, vm::Fusing::kNever, 1000, false, false},
    {"interpreter", vm::Tier::kInterpreter, vm::Fusing::kAuto, 1000, false},
    {"native", vm::Tier::kNative, vm::Fusing::kAuto, 1000, false},
    {"unfused, fuel 1", vm::Tier::kInterpreter, vm::Fusing::kNever, 1, false},
    {"native, fuel 1", vm::Tier::kNative, vm::Fusing::kAlways, 1, false},
    {"native, republished", vm::Tier::kNative, vm::Fusing::kAuto, 1000, true},
};

class Forced {
 public:
  base::Status start(const ir::VerifiedImage& image, const Mode& mode) {
    republished_ = mode.republished;
    vm::ControllerOptions options;
    options.fuel_budget = kFuel;
    options.on_trap = ir::OnTrap::kGoOn;
    options.fuel_slice = mode.fuel_slice;
    options.tier.tier = mode.tier;
    options.tier.fusing = mode.fusing;
    auto controller = vm::Controller::start(image, options, clock_, devices_);
    if (!controller.ok()) return controller.error();
    controller_ = std::move(*controller);
    clock_.ask = [this] { look(); };
    return base::Ok{};
  }

  // What went wrong, or "".
  std::string scan() {
    controller_->cycle();
    if (republished_ && !controller_->faulted()) {
      auto next = controller_->prepare(controller_->verified());
      if (!next.ok()) return base::to_string(next.error());
      old_ = controller_->publish(std::move(*next));
    }
    return changed_;
  }
  std::string state() const {
    std::string text = ir::state_text(controller_->image(), controller_->memory().view());
    for (const vm::TrapRecord& trap : controller_->traps()) {
      text += std::string(ir::trap_name(trap.trap.kind)) + " " + trap.text.pou + ":" +
              std::to_string(trap.text.line) + " " + trap.text.text + "\n";
    }
    return text;
  }
  // A force can make a loop endless. Where in it the fuel ends, is another matter in other code.
  bool out_of_fuel() const {
    const std::vector<vm::TrapRecord>& traps = controller_->traps();
    return std::any_of(traps.begin(), traps.end(), [](const vm::TrapRecord& trap) {
      return trap.trap.kind == ir::TrapKind::kFuel;
    });
  }
  vm::Controller& controller() { return *controller_; }

 private:
  void look() {
    for (const vm::Force& force : controller_->forces()) {
      if (!force.reason.empty() || !changed_.empty()) continue;
      const uint8_t* const at = controller_->memory().data() + force.symbol.data;
      if (std::equal(force.value.begin(), force.value.end(), at)) continue;
      const auto is =
          ir::format_value(controller_->image(), force.symbol, controller_->memory().view());
      changed_ = force.path + " is forced everywhere, and " + is + " inside of a scan";
    }
  }

  AskingClock clock_;
  NoDevices devices_;
  std::unique_ptr<vm::Controller> controller_;
  std::unique_ptr<vm::Generation> old_;
  std::string changed_;
  bool republished_ = false;
};

// Variables that code writes. Each gets a value that another one of its type has: what is written
// there will be different.
std::vector<vm::NamedValue> choose(const vm::Controller& controller,
                                   std::span<const uint8_t> memory, uint64_t seed) {
  Random random(seed ^ 0xf0ce);
  const ir::Image& image = controller.image();
  std::map<std::string, std::vector<std::string>> by_type;
  std::vector<std::string> paths;
  std::vector<vm::Variable> variables;
  ir::for_each_leaf(image, [&](const std::string& path, const ir::Symbol& symbol) {
    if (symbol.constant) return;
    const std::string value = ir::format_value(image, symbol, memory);
    const auto bytes = ir::parse_value(image, symbol.type, value);
    if (!bytes.ok()) return;
    std::vector<std::string>& others = by_type[image.types.text(symbol.type)];
    if (std::find(others.begin(), others.end(), value) == others.end()) others.push_back(value);
    paths.push_back(path);
    variables.push_back({symbol.data, static_cast<uint32_t>(bytes->size()), symbol.type});
  });
  std::vector<uint32_t> written;
  for (const vm::Writer& writer : vm::find_writers(image, variables)) {
    if (written.empty() || written.back() != writer.variable) written.push_back(writer.variable);
  }
  std::vector<vm::NamedValue> chosen;
  std::vector<vm::Variable> places;
  for (uint32_t i = 0; i < kMostForces && !written.empty(); ++i) {
    const uint32_t at = written[random.below(static_cast<uint32_t>(written.size()))];
    const vm::Variable& place = variables[at];
    const std::vector<std::string>& others = by_type[image.types.text(place.type)];
    const std::string& value = others[random.below(static_cast<uint32_t>(others.size()))];
    const bool shared = std::any_of(places.begin(), places.end(), [&](const vm::Variable& other) {
      return other.data < place.data + place.size && place.data < other.data + other.size;
    });
    if (shared) continue;  // in a union: not both can be
    places.push_back(place);
    chosen.push_back({paths[at], value});
  }
  return chosen;
}

struct Run {
  std::vector<std::string> states;
  std::string wrong;
};

Run run(Forced& forced, const std::vector<vm::NamedValue>& values, int scans) {
  Run out;
  const auto some = [&](int count) {
    for (int i = 0; i < count && out.wrong.empty() && !forced.out_of_fuel(); ++i) {
      out.wrong = forced.scan();
      if (!forced.out_of_fuel()) out.states.push_back(forced.state());
    }
  };
  some(kScansBefore);
  for (const vm::NamedValue& row : values) {
    const base::Status done = forced.controller().force(row.path, row.value);
    if (!done.ok()) out.wrong = base::to_string(done.error());
  }
  some(scans);
  for (size_t i = 0; i < values.size(); i += 2) {
    // A later one at the same place, in a union, has replaced it.
    (void)forced.controller().unforce(values[i].path).ok();
  }
  some(2);
  return out;
}

Finding failed(const Mode& mode, const char* what, const std::string& text) {
  Finding out;
  out.failed = true;
  out.key = std::string(what) + " " + mode.name;
  out.text = std::string(mode.name) + ": " + text;
  return out;
}

// Those that hold everywhere in this program.
base::Status keep_certain(const ir::VerifiedImage& image, std::vector<vm::NamedValue>& values) {
  Forced forced;
  if (base::Status s = forced.start(image, kModes[0]); !s.ok()) return s;
  vm::Controller& controller = forced.controller();
  for (const vm::NamedValue& row : values) {
    if (base::Status s = controller.force(row.path, row.value); !s.ok()) return s;
  }
  for (const vm::Force& force : controller.forces()) {
    if (force.reason.empty()) continue;
    std::erase_if(values, [&](const vm::NamedValue& row) { return row.path == force.path; });
  }
  return base::Ok{};
}

}  // namespace

Finding examine_forces(const std::string& source, uint64_t seed, int scans,
                       const std::string& passes) {
  const base::Result<golden::Program> optimised = compiled(source, passes);
  const base::Result<golden::Program> plain = compiled(source, "none");
  if (!optimised.ok()) return failed(kModes[1], "compile", base::to_string(optimised.error()));
  if (!plain.ok()) return failed(kModes[0], "compile", base::to_string(plain.error()));
  const base::Result<ir::VerifiedImage> images[] = {golden::link(*plain, nullptr, false),
                                                    golden::link(*optimised, nullptr, false)};
  std::vector<vm::NamedValue> values;
  for (const base::Result<ir::VerifiedImage>& image : images) {
    if (!image.ok()) return failed(kModes[0], "link", base::to_string(image.error()));
  }
  {
    Forced first;
    if (base::Status s = first.start(*images[1], kModes[1]); !s.ok()) return {};
    if (!first.scan().empty()) return {};
    values = choose(first.controller(), first.controller().memory().view(), seed);
  }
  for (const base::Result<ir::VerifiedImage>& image : images) {
    base::Status kept = keep_certain(*image, values);
    if (!kept.ok()) return failed(kModes[0], "force", base::to_string(kept.error()));
  }
  Finding out;
  if (values.empty()) {
    out.key = "skipped";
    return out;
  }
  Run expected;
  for (const Mode& mode : kModes) {
    Forced forced;
    if (base::Status s = forced.start(*images[mode.optimised ? 1 : 0], mode); !s.ok()) {
      return failed(mode, "refused", base::to_string(s.error()));
    }
    Run now = run(forced, values, scans);
    if (!now.wrong.empty()) return failed(mode, "wrong", now.wrong);
    if (forced.out_of_fuel()) {
      out.trap = ir::trap_name(ir::TrapKind::kFuel);
      out.scan = now.states.size() + 1;
    }
    if (&mode == &kModes[0]) {
      expected = std::move(now);
      continue;
    }
    for (size_t i = 0; i < std::min(expected.states.size(), now.states.size()); ++i) {
      if (expected.states[i] == now.states[i]) continue;
      const Finding where = first_difference(expected.states[i], now.states[i]);
      return failed(mode, "state", "scan " + std::to_string(i + 1) + ": " + where.text);
    }
  }
  return out;
}

}  // namespace differential
