#include "tests/differential/forces.h"

#include <algorithm>
#include <functional>
#include <map>
#include <memory>
#include <vector>

#include "tests/differential/compiled.h"
#include "tests/differential/random.h"
#include "tests/golden/runner/evaluator_engine.h"
#include "vm/load/writers.h"
#include "vm/runtime/clocks.h"
#include "vm/runtime/controller.h"

namespace differential {
namespace {

constexpr int kScansBefore = 2;
constexpr uint64_t kFuel = 500'000;
constexpr uint64_t kInstructions = 200'000;  // of the evaluator, for a scan
constexpr uint32_t kMostForces = 30;

class AskingClock : public vm::VirtualClock {
 public:
  explicit AskingClock(int64_t ns_per_safe_point) : VirtualClock(ns_per_safe_point) {}
  void consumed(uint64_t safe_points) override {
    VirtualClock::consumed(safe_points);
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
  bool optimised = true;  // else each variable is read where the source reads it
  // Scans take time: tasks begin in the middle of others, where the code says, so that states are
  // not compared.
  int64_t ns_per_safe_point = 0;
};
constexpr Mode kModes[] = {
    {"no passes", vm::Tier::kInterpreter, vm::Fusing::kNever, 1000, false, false},
    {"interpreter", vm::Tier::kInterpreter, vm::Fusing::kAuto, 1000, false},
    {"native", vm::Tier::kNative, vm::Fusing::kAuto, 1000, false},
    {"unfused, fuel 1", vm::Tier::kInterpreter, vm::Fusing::kNever, 1, false},
    {"native, fuel 1", vm::Tier::kNative, vm::Fusing::kAlways, 1, false},
    {"native, republished", vm::Tier::kNative, vm::Fusing::kAuto, 1000, true},
    {"preempted", vm::Tier::kNative, vm::Fusing::kAuto, 1, false, true, 700'000},
};

// "fuel Main:7" a line: what all tiers must agree about.
std::string trap_line(ir::TrapKind kind, const std::string& pou, uint32_t line) {
  return std::string(ir::trap_name(kind)) + " " + pou + ":" + std::to_string(line) + "\n";
}

// A program whose variables can be forced.
class Subject {
 public:
  virtual ~Subject() = default;
  // What went wrong, or "".
  virtual std::string scan() = 0;
  virtual std::string state() const = 0;
  virtual base::Status force(const vm::NamedValue& row) = 0;
  virtual void unforce(const std::string& path) = 0;
  // A force can make a loop endless. Where in it the fuel ends, is another matter in other code.
  virtual bool out_of_fuel() const = 0;
};

// The oracle: it knows no code of writers, but puts the values back behind every instruction.
class Evaluated : public Subject {
 public:
  Evaluated(const golden::Program& program, const ir::Image& image)
      : image_(image),
        evaluator_(program.program, golden::memory_of(image, program.program.types)),
        period_ns_(golden::base_period_ns(program.program)) {}

  std::string scan() override {
    for (const ir::EvalTrap& trap : evaluator_.scan(now_ns_, kInstructions)) {
      out_of_fuel_ |= trap.kind == ir::TrapKind::kFuel;
      traps_ += trap_line(trap.kind, trap.pou, trap.line);
    }
    now_ns_ += period_ns_;
    return {};
  }
  std::string state() const override { return evaluator_.state() + traps_; }
  base::Status force(const vm::NamedValue& row) override {
    const base::Result<ir::Symbol> symbol = ir::find_symbol(image_, row.path);
    if (!symbol.ok()) return symbol.error();
    const base::Result<base::Bytes> bytes = ir::parse_value(image_, symbol->type, row.value);
    if (!bytes.ok()) return bytes.error();
    return evaluator_.hold(row.path, *bytes);
  }
  void unforce(const std::string& path) override { evaluator_.release(path); }
  bool out_of_fuel() const override { return out_of_fuel_; }

 private:
  const ir::Image& image_;
  ir::Evaluator evaluator_;
  int64_t period_ns_;
  int64_t now_ns_ = 0;
  std::string traps_;
  bool out_of_fuel_ = false;
};

class Forced : public Subject {
 public:
  explicit Forced(const Mode& mode) : clock_(mode.ns_per_safe_point) {}
  base::Status start(const ir::VerifiedImage& image, const Mode& mode) {
    republished_ = mode.republished;
    vm::ControllerOptions options;
    options.fuel_budget = kFuel;
    options.on_trap = ir::OnTrap::kGoOn;
    options.fuel_slice = mode.fuel_slice;
    options.tier.tier = mode.tier;
    options.tier.fusing = mode.fusing;
    options.tier.logic_line = 1;
    auto controller = vm::Controller::start(image, options, clock_, devices_);
    if (!controller.ok()) return controller.error();
    controller_ = std::move(*controller);
    clock_.ask = [this] { look(); };
    return base::Ok{};
  }

  std::string scan() override {
    controller_->cycle();
    for (; traps_seen_ < controller_->trap_count(); ++traps_seen_) {
      const vm::Traps& kept = controller_->traps();
      const size_t back = static_cast<size_t>(controller_->trap_count() - traps_seen_);
      if (back > kept.size()) continue;
      const vm::TrapRecord& trap = *kept[kept.size() - back];
      traps_ += trap_line(trap.trap.kind, trap.text.pou, trap.text.line);
      out_of_fuel_ |= trap.trap.kind == ir::TrapKind::kFuel;
    }
    if (republished_ && !controller_->faulted()) {
      auto next = controller_->prepare(controller_->verified());
      if (!next.ok()) return base::to_string(next.error());
      old_ = controller_->publish(std::move(*next));
    }
    return changed_;
  }
  std::string state() const override {
    return ir::state_text(controller_->image(), controller_->memory().view()) + traps_;
  }
  base::Status force(const vm::NamedValue& row) override {
    return comes_to_boundary() ? controller_->force(row.path, row.value) : base::Ok{};
  }
  void unforce(const std::string& path) override {
    if (comes_to_boundary()) (void)controller_->unforce(path).ok();
  }
  bool out_of_fuel() const override { return out_of_fuel_; }
  vm::Controller& controller() { return *controller_; }

 private:
  // Tasks that take too long never leave one.
  bool comes_to_boundary() {
    for (int i = 0; i < 100 && !controller_->at_boundary(); ++i) controller_->cycle();
    return controller_->at_boundary();
  }
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
  std::string traps_;
  uint64_t traps_seen_ = 0;
  bool out_of_fuel_ = false;
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

Run run(Subject& forced, const std::vector<vm::NamedValue>& values, int scans) {
  Run out;
  const auto some = [&](int count) {
    for (int i = 0; i < count && out.wrong.empty() && !forced.out_of_fuel(); ++i) {
      out.wrong = forced.scan();
      if (!forced.out_of_fuel()) out.states.push_back(forced.state());
    }
  };
  some(kScansBefore);
  for (const vm::NamedValue& row : values) {
    const base::Status done = forced.force(row);
    if (!done.ok()) out.wrong = base::to_string(done.error());
  }
  some(scans);
  for (size_t i = 0; i < values.size(); i += 2) forced.unforce(values[i].path);
  some(2);
  return out;
}

Finding failed(const Mode& mode, const char* what, const std::string& text) {
  return failure(std::string(what) + " " + mode.name, std::string(mode.name) + ": " + text);
}

// Those that hold everywhere in this program.
base::Status keep_certain(const ir::VerifiedImage& image, std::vector<vm::NamedValue>& values) {
  Forced forced(kModes[0]);
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
                       const Build& build) {
  const base::Result<golden::Program> optimised = compiled(source, build);
  const base::Result<golden::Program> plain = compiled(source, {"none", build.dialect});
  if (!optimised.ok()) return failed(kModes[1], "compile", base::to_string(optimised.error()));
  if (!plain.ok()) return failed(kModes[0], "compile", base::to_string(plain.error()));
  const base::Result<ir::VerifiedImage> images[] = {golden::link(*plain, nullptr, false),
                                                    golden::link(*optimised, nullptr, false)};
  for (const base::Result<ir::VerifiedImage>& image : images) {
    if (!image.ok()) return failed(kModes[0], "link", base::to_string(image.error()));
  }
  std::vector<vm::NamedValue> values;
  {
    Forced first(kModes[1]);
    if (base::Status s = first.start(*images[1], kModes[1]); !s.ok()) return {};
    if (!first.scan().empty()) return {};
    values = choose(first.controller(), first.controller().memory().view(), seed);
  }
  for (const base::Result<ir::VerifiedImage>& image : images) {
    const base::Status kept = keep_certain(*image, values);
    if (!kept.ok()) return failed(kModes[0], "force", base::to_string(kept.error()));
  }
  if (values.empty()) return skipped();
  Finding out;
  Evaluated oracle(*plain, images[0]->image());
  const Run expected = run(oracle, values, scans);
  for (const Mode& mode : kModes) {
    Forced forced(mode);
    if (base::Status s = forced.start(*images[mode.optimised ? 1 : 0], mode); !s.ok()) {
      return failed(mode, "refused", base::to_string(s.error()));
    }
    Run now = run(forced, values, scans);
    if (!now.wrong.empty()) return failed(mode, "wrong", now.wrong);
    if (forced.out_of_fuel()) {
      out.trap = ir::trap_name(ir::TrapKind::kFuel);
      out.scan = now.states.size() + 1;
    }
    if (mode.ns_per_safe_point != 0) continue;
    for (size_t i = 0; i < std::min(expected.states.size(), now.states.size()); ++i) {
      if (expected.states[i] == now.states[i]) continue;
      const Finding where = first_difference(expected.states[i], now.states[i]);
      return failed(mode, "state", "scan " + std::to_string(i + 1) + ": " + where.text);
    }
  }
  return out;
}

}  // namespace differential
