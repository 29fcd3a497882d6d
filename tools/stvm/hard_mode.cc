#include "tools/stvm/hard_mode.h"

#include "tools/common/files.h"
#include "tools/stvm/compiler.h"

namespace stvm {
namespace {

base::Result<base::Bytes> relinked(const std::vector<std::string>& sources,
                                   base::ByteSpan running) {
  base::Result<TemporaryFolder> folder = TemporaryFolder::make();
  if (!folder.ok()) return folder.error();
  std::string base_file = folder->file("base.img");
  std::string next_file = folder->file("next.img");
  base::Status written = tools::write_file(base_file, running);
  if (!written.ok()) return written.error();
  std::vector<std::string> arguments = {"build", "--base",  base_file, "--move-all",
                                        "-o",    next_file, "--"};
  arguments.insert(arguments.end(), sources.begin(), sources.end());
  base::Status built = run_stc(arguments);
  if (!built.ok()) return built.error();
  return tools::read_bytes(next_file);
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

base::Status apply_hard_mode(HardMode mode, const std::vector<std::string>& sources,
                             vm::Controller& controller) {
  if (mode != HardMode::kIdentity && mode != HardMode::kMove) return base::Ok{};
  base::Bytes next = controller.verified().encoded();
  if (mode == HardMode::kMove) {
    base::Result<base::Bytes> moved = relinked(sources, next);
    if (!moved.ok()) return moved.error();
    next = std::move(*moved);
  }
  base::Status changed = switch_to(next, controller);
  // Where nothing can move, the relinked program is the running one.
  bool same = !changed.ok() && changed.error().refusal == base::Refusal::kNoChange;
  return same ? base::Status(base::Ok{}) : changed;
}

}  // namespace stvm
