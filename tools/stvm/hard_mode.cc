#include "tools/stvm/hard_mode.h"

#include "tools/stvm/compiler.h"

namespace stvm {
namespace {

// A copy of the program as another version: without that, a change to itself does nothing at all.
base::Bytes renamed(const ir::Image& running) {
  ir::Image image = running;
  if (image.name.ends_with('\'')) {
    image.name.pop_back();
  } else {
    image.name += '\'';
  }
  return ir::encode(image);
}

base::Status switch_to(base::ByteSpan next, vm::Controller& controller) {
  auto package = online_change::make_package(controller.verified().encoded(), next);
  if (!package.ok()) return package.error();
  online_change::Change change(controller);
  base::Status staged = change.stage(online_change::encode(*package));
  if (!staged.ok()) return staged;
  base::Status armed = change.arm(false);
  if (!armed.ok()) return armed;
  base::Result<online_change::SwitchReport> report = change.switch_now();
  if (!report.ok()) return report.error();
  return change.accept();
}

}  // namespace

base::Result<HardMode> parse_hard_mode(const std::string& text) {
  if (text.empty()) return HardMode::kNone;
  if (text == "fuel1") return HardMode::kFuel1;
  if (text == "identity") return HardMode::kIdentity;
  if (text == "move") return HardMode::kMove;
  return base::Error{base::Refusal::kUsage,
                     "--hard-mode is fuel1, identity or move, not `" + text + "`"};
}

base::Status check_hard_mode(HardMode mode, const Sources& sources) {
  if (mode != HardMode::kMove || sources.paths.size() != 1 || !is_image(sources.paths.front())) {
    return base::Ok{};
  }
  return base::Error{base::Refusal::kUsage, "--hard-mode move relinks: it needs sources"};
}

base::Status apply_hard_mode(HardMode mode, const Sources& sources, vm::Controller& controller) {
  if (mode == HardMode::kIdentity) return switch_to(renamed(controller.image()), controller);
  if (mode != HardMode::kMove) return base::Ok{};
  base::Result<base::Bytes> next = relink(sources, controller.verified().encoded(), true);
  if (!next.ok()) return next.error();
  base::Status changed = switch_to(*next, controller);
  // Where nothing can move, the relinked program is the running one.
  bool same = !changed.ok() && changed.error().refusal == base::Refusal::kNoChange;
  return same ? base::Status(base::Ok{}) : changed;
}

}  // namespace stvm
