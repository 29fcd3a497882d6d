#include "tests/differential/rig.h"

#include <algorithm>
#include <cstring>

#include "ir/types/shared_bytes.h"
#include "linker/link.h"
#include "linker/unlink.h"

namespace differential {
namespace {

// E-09: taken apart and linked again on top of itself, an image is what it was. What it does not
// tell is how initial values of one instance were written, so its constants may be more.
base::Status comes_back(const ir::VerifiedImage& verified) {
  const ir::Image& image = verified.image();
  base::Result<linker::Unlinked> parts = linker::unlink(image);
  if (!parts.ok()) return parts.error();
  linker::Options options;
  options.base = &image;
  options.devices = parts->devices;
  options.safe = parts->safe;
  base::Result<ir::Image> again = linker::link(parts->program, parts->objects, options);
  if (!again.ok()) return again.error();
  again->constants = image.constants;
  if (ir::encode(*again) == verified.encoded()) return base::Ok{};
  return base::Error{base::Refusal::kInternal, "the image is another one when it is linked again"};
}

}  // namespace

base::Result<std::unique_ptr<Rig>> Rig::start(const golden::Program& program,
                                              online_change::Strategy strategy) {
  base::Result<ir::VerifiedImage> image = golden::link(program, nullptr, false);
  if (!image.ok()) return image.error();
  if (base::Status same = comes_back(*image); !same.ok()) return same.error();
  auto rig = std::make_unique<Rig>();
  rig->strategy_ = strategy;
  vm::ControllerOptions options;
  options.fuel_budget = 20'000'000;
  options.on_trap = ir::OnTrap::kGoOn;
  auto controller = vm::Controller::start(*image, options, rig->clock_, rig->devices_);
  if (!controller.ok()) return controller.error();
  rig->controller_ = std::move(*controller);
  rig->change_ = std::make_unique<online_change::Change>(*rig->controller_);
  return rig;
}

std::string Rig::scan() {
  size_t before = controller_->traps().size();
  controller_->cycle();
  const vm::Traps& traps = controller_->traps();
  if (traps.size() == before) return {};
  const vm::TrapRecord& first = *traps[before];
  return std::string(ir::trap_name(first.trap.kind)) + " " + first.text.pou + ":" +
         std::to_string(first.text.line);
}

base::Status Rig::arm(const golden::Program& next) {
  base::Result<ir::VerifiedImage> image = golden::link(next, &controller_->image(), false);
  if (!image.ok()) return image.error();
  if (base::Status same = comes_back(*image); !same.ok()) return same;
  auto package = online_change::make_package(controller_->verified().encoded(), image->encoded());
  if (!package.ok()) return package.error();
  base::Status staged = change_->stage(online_change::encode(*package), strategy_);
  if (!staged.ok()) return staged;
  return change_->arm(true, true);
}

base::Status Rig::make_switch() {
  base::Result<online_change::SwitchReport> report = change_->switch_now();
  if (!report.ok()) return report.error();
  return base::Ok{};
}

base::Status Rig::undo() {
  if (base::Status primed = change_->prime(); !primed.ok()) return primed;
  base::Result<online_change::SwitchReport> report =
      change_->undo(online_change::Exits::kRun, online_change::Losses::kAllowed);
  if (!report.ok()) return report.error();
  return base::Ok{};
}

Leaves Rig::leaves() const {
  Leaves out;
  const ir::Image& now = controller_->image();
  std::span<const uint8_t> memory = controller_->memory().view();
  ir::for_each_leaf(now, [&](const std::string& path, const ir::Symbol& symbol) {
    Leaf& leaf = out[path];
    leaf = {symbol, now.types.text(symbol.type), ir::format_value(now, symbol, memory), 0};
    if (now.types.is_scalar(symbol.type)) leaf.bits = scalar_bits(leaf);
  });
  std::map<std::string, bool> overlapping;
  for (auto& [path, leaf] : out) {
    // The name of a variable that shares bytes by its address is no part of a union's.
    const std::string first = path.substr(0, path.find('['));
    leaf.shared = ir::find_shared(now.types, now.globals, first).has_value();
    for (size_t end = path.find_last_of(".["); end != std::string::npos && end > 0 && !leaf.shared;
         end = path.find_last_of(".[", end - 1)) {
      auto [known, fresh] = overlapping.try_emplace(path.substr(0, end), false);
      if (fresh) {
        base::Result<ir::Symbol> whole = ir::find_symbol(now, known->first);
        known->second = whole.ok() && now.types.overlaps(whole->type);
      }
      leaf.shared = known->second;
    }
  }
  return out;
}

std::vector<Leaf> Rig::structures() const {
  const ir::Image& now = controller_->image();
  std::map<std::string, bool> seen;
  std::vector<Leaf> out;
  ir::for_each_leaf(now, [&](const std::string& path, const ir::Symbol&) {
    for (size_t end = path.find_first_of(".["); end != std::string::npos;
         end = path.find_first_of(".[", end + 1)) {
      std::string prefix = path.substr(0, end);
      if (!seen.try_emplace(prefix, true).second) continue;
      base::Result<ir::Symbol> whole = ir::find_symbol(now, prefix);
      if (!whole.ok() || now.types[whole->type].kind != ir::Kind::kStruct) continue;
      out.push_back({*whole, std::move(prefix), {}});
    }
  });
  return out;
}

std::string Rig::state() const {
  return ir::state_text(controller_->image(), controller_->memory().view());
}

std::span<const uint8_t> Rig::bytes(const Leaf& leaf) const {
  return controller_->memory().view().subspan(leaf.symbol.data,
                                              image().layouts[leaf.symbol.type].size);
}

uint64_t Rig::scalar_bits(const Leaf& leaf) const {
  ir::Scalar scalar = image().types.scalar(leaf.symbol.type);
  uint32_t size = ir::scalar_size(scalar);
  uint64_t bits = 0;
  std::memcpy(&bits, controller_->memory().data() + leaf.symbol.data, size);
  if (!ir::is_signed(scalar) || size == 8) return bits;
  uint32_t shift = 64 - size * 8;
  return static_cast<uint64_t>(static_cast<int64_t>(bits << shift) >> shift);
}

}  // namespace differential
