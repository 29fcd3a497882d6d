#include "tests/unit/online_change/plant.h"

#include <cstdlib>
#include <utility>

#include "base/diagnostics.h"
#include "frontend/compile.h"
#include "ir/bytecode/symbols.h"
#include "ir/lower/lower.h"
#include "ir/program/text.h"
#include "ir/program/verify.h"

namespace plant {

namespace {

std::optional<ir::Program> program_of(const std::string& source) {
  if (source.starts_with("program ")) {
    base::Result<ir::Program> program = ir::parse_program(source);
    if (!program.ok()) base::check(false, program.error().text.c_str());
    base::Status status = ir::verify(*program);
    if (!status.ok()) base::check(false, status.error().text.c_str());
    return *std::move(program);
  }
  base::SourceMap sources;
  sources.add("test.st", source);
  base::Diagnostics diagnostics;
  std::optional<ir::Program> program = frontend::compile(sources, {}, diagnostics);
  base::check(program.has_value(),
              base::render(diagnostics, sources, base::DiagnosticFormat::kText, false).c_str());
  return program;
}

}  // namespace

Compiled compile(const std::string& source) {
  Compiled out{*program_of(source), {}};
  for (uint32_t i = 0; i < out.program.pous.size(); ++i) {
    out.objects.push_back(*ir::lower(out.program, ir::PouId(i)));
  }
  return out;
}

namespace {

online_change::Strategy default_strategy() {
  const char* const name = std::getenv("STC_TEST_STRATEGY");
  return name != nullptr && std::string(name) == "standby" ? online_change::Strategy::kStandby
                                                           : online_change::Strategy::kInPlace;
}

ir::VerifiedImage link_objects(const Compiled& compiled, const linker::Options& options) {
  base::Result<ir::Image> image = linker::link(compiled.program, compiled.objects, options);
  if (!image.ok()) base::check(false, base::to_string(image.error()).c_str());
  base::Result<ir::VerifiedImage> verified = ir::verify(ir::encode(*image));
  if (!verified.ok()) base::check(false, base::to_string(verified.error()).c_str());
  return *verified;
}

}  // namespace

Plant::Plant(const std::string& source, const Settings& settings)
    : slack_(settings.slack), strategy_(default_strategy()), clock_(settings.ns_per_safe_point) {
  linker::Options options;
  options.slack = slack_;
  vm::ControllerOptions running = settings.options;
  // Suspended as soon as a release is due.
  if (settings.ns_per_safe_point != 0) running.fuel_slice = 1;
  auto controller =
      vm::Controller::start(link_objects(compiled(source), options), running, clock_, devices_);
  base::check(controller.ok(), "the controller starts");
  controller_ = std::move(*controller);
  change_ = std::make_unique<online_change::Change>(*controller_);
}

ir::VerifiedImage Plant::link(const std::string& source, bool move_all) {
  linker::Options options;
  options.slack = slack_;
  options.base = &controller_->image();
  options.move_all = move_all;
  return link_objects(compiled(source), options);
}

const Compiled& Plant::compiled(const std::string& source) {
  if (known_[0].source != source) std::swap(known_[0], known_[1]);
  if (known_[0].source != source || !known_[0].compiled) known_[0] = {source, compile(source)};
  return *known_[0].compiled;
}

void Plant::run(int scans) {
  for (int i = 0; i < scans; ++i) controller_->cycle();
  for (const auto& trap : controller_->traps()) ADD_FAILURE() << trap->text.text;
}

std::string Plant::get(const std::string& path) const {
  base::Result<std::string> value = controller_->get(path);
  return value.ok() ? *value : "no " + path;
}

void Plant::set(const std::string& path, const std::string& value) {
  base::Status status = controller_->set(path, value);
  EXPECT_TRUE(status.ok()) << base::to_string(status.error());
}

base::Digest Plant::hash() const {
  return ir::state_hash(controller_->image(), controller_->memory().view());
}

base::Bytes Plant::package(const std::string& source, bool move_all) {
  ir::VerifiedImage next = link(source, move_all);
  auto package = online_change::make_package(controller_->verified().encoded(), next.encoded());
  if (!package.ok()) base::check(false, base::to_string(package.error()).c_str());
  return online_change::encode(*package);
}

online_change::SwitchReport Plant::change(const std::string& source, bool allow_loss,
                                          bool move_all) {
  base::Status staged = stage(package(source, move_all));
  EXPECT_TRUE(staged.ok()) << base::to_string(staged.error());
  if (!staged.ok()) return {};
  plan_ = change_->plan();
  base::Status armed = change_->arm(allow_loss);
  EXPECT_TRUE(armed.ok()) << base::to_string(armed.error());
  if (!armed.ok()) return {};
  auto report = change_->switch_now();
  EXPECT_TRUE(report.ok()) << base::to_string(report.error());
  return report.ok() ? *report : online_change::SwitchReport();
}

base::Refusal Plant::refused(const std::string& source, bool allow_loss) {
  base::Status status = stage(package(source));
  if (status.ok()) {
    plan_ = change_->plan();
    status = change_->arm(allow_loss);
  }
  change_->cancel();
  return status.ok() ? base::Refusal::kInternal : status.error().refusal;
}

void Plant::undo() {
  EXPECT_TRUE(change_->prime().ok());
  auto report = change_->undo(online_change::Exits::kRun, online_change::Losses::kAllowed);
  EXPECT_TRUE(report.ok()) << base::to_string(report.error());
}

void Plant::accept() { EXPECT_TRUE(change_->accept().ok()); }

const online_change::FateRow* Plant::row(const std::string& path) const {
  for (const online_change::FateRow& row : plan_.fates) {
    if (ir::same_name(row.path, path)) return &row;
  }
  ADD_FAILURE() << "no fate row for " << path;
  static const online_change::FateRow kNone;
  return &kNone;
}

uint32_t Plant::id_of(const std::string& path) const {
  const ir::Image& image = controller_->image();
  for (uint32_t id = 1; id < image.instances.size(); ++id) {
    if (image.instances[id].live && ir::same_name(image.instance_path(id), path)) return id;
  }
  return 0;
}

}  // namespace plant
