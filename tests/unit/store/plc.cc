#include "tests/unit/store/plc.h"

#include <gtest/gtest.h>

#include <map>
#include <utility>
#include <vector>

#include "base/diagnostics.h"
#include "frontend/compile.h"
#include "ir/bytecode/symbols.h"
#include "ir/lower/lower.h"
#include "linker/link.h"
#include "online_change/package/package.h"

namespace plc {
namespace {

struct Compiled {
  ir::Program program;
  std::vector<ir::Object> objects;
};

Compiled compile(const std::string& source) {
  base::SourceMap sources;
  sources.add("test.st", source);
  base::Diagnostics diagnostics;
  std::optional<ir::Program> program = frontend::compile(sources, {}, diagnostics);
  base::check(program.has_value(),
              base::render(diagnostics, sources, base::DiagnosticFormat::kText, false).c_str());
  Compiled out{std::move(*program), {}};
  for (uint32_t i = 0; i < out.program.pous.size(); ++i) {
    out.objects.push_back(*ir::lower(out.program, ir::PouId(i)));
  }
  return out;
}

// Tests build the same few programs thousands of times: each is compiled once.
const Compiled& compiled(const std::string& source) {
  static std::map<std::string, Compiled> known;
  const auto found = known.find(source);
  return found != known.end() ? found->second
                              : known.emplace(source, compile(source)).first->second;
}

}  // namespace

ir::VerifiedImage build(const std::string& source, const ir::Image* base) {
  const Compiled& of = compiled(source);
  linker::Options options;
  options.base = base;
  base::Result<ir::Image> image = linker::link(of.program, of.objects, options);
  base::check(image.ok(), image.ok() ? "" : base::to_string(image.error()).c_str());
  base::Result<ir::VerifiedImage> verified = ir::verify(ir::encode(*image));
  base::check(verified.ok(), "the test program is verified");
  return *verified;
}

base::Status Plc::boot(const std::string& source) {
  if (source.empty()) return boot(std::optional<ir::VerifiedImage>());
  return boot(std::optional(build(source)));
}

base::Status Plc::boot(const std::optional<ir::VerifiedImage>& given, bool create) {
  store_ =
      std::make_unique<online_change::Store>(storage_, online_change::StoreSizes{4096, 64, 64, 8});
  auto found = online_change::boot(*store_, given, "test", 1, create);
  if (!found.ok()) return found.error();
  boot_ = std::move(*found);
  if (make_trust) trust_ = make_trust(*store_);
  vm::ControllerOptions options;
  options.halted = !boot_->fault.empty();
  auto controller = vm::Controller::start(boot_->image, options, clock_, io_, boot_->retained);
  if (!controller.ok()) return controller.error();
  controller_ = std::move(*controller);
  service_ = std::make_unique<stvm::ControllerService>(
      *controller_, clock_, *store_, *this,
      stvm::StartReport{boot_->trial_lost, boot_->alarms, boot_->fault, {}, trust_.get(),
                        most_upload},
      [this] { return wall_ns; });
  service_->resume(boot_->edits);
  service_->asked_by("tester", 1);
  return base::Ok{};
}

void Plc::run(int scans) {
  for (int i = 0; i < scans; ++i) controller_->cycle();
}

std::string Plc::get(const std::string& path) const {
  base::Result<std::string> value = controller_->get(path);
  return value.ok() ? *value : "no " + path;
}

void Plc::set(const std::string& path, const std::string& value) {
  base::Status status = controller_->set(path, value);
  EXPECT_TRUE(status.ok()) << base::to_string(status.error());
}

base::Status Plc::save() {
  online_change::Snapshot snapshot;
  service_->keeper().take(snapshot);
  return service_->keeper().save(snapshot);
}

vm::Boundary::Outcome Plc::run(const std::function<void()>& job, int64_t) {
  const Outcome outcome = at_boundary ? at_boundary() : Outcome::kDone;
  if (outcome != Outcome::kDone) return outcome;
  job();
  if (behind_job) behind_job();
  return outcome;
}

// Whatever boundaries do.
vm::StatusReport Plc::status() {
  bool keep_open = true;
  auto asked = std::exchange(at_boundary, {});
  base::Bytes answer = service_->answer(vm::encode(vm::Request{}), keep_open);
  at_boundary = std::move(asked);
  base::Result<base::Bytes> body = vm::decode_answer(answer);
  base::check(body.ok(), "status is answered");
  return *vm::decode_status(*body);
}

base::Result<base::Bytes> Plc::answer_to(vm::Request request) {
  const vm::StatusReport now = status();
  request.expected = now.running;
  request.edition = now.edition;
  bool keep_open = true;
  return vm::decode_answer(service_->answer(vm::encode(request), keep_open));
}

base::Status Plc::ask(vm::Request request) {
  base::Result<base::Bytes> body = answer_to(std::move(request));
  if (!body.ok()) return body.error();
  return base::Ok{};
}

void Plc::stop() {
  EXPECT_TRUE(save().ok());
  service_->keep_trial_over_stop();
}

base::Status Plc::change(const std::string& source, uint32_t flags) {
  return change(build(source, &controller_->image()), flags);
}

base::Status Plc::stage(const ir::VerifiedImage& next) {
  auto package = online_change::make_package(controller_->verified().encoded(), next.encoded());
  base::check(package.ok(), "the package is made");
  vm::Request upload{.command = vm::Command::kUpload};
  upload.data = online_change::encode(*package);
  vm::Request stage{.command = vm::Command::kStage};
  stage.digest = base::sha256(upload.data);
  base::Status done = ask(std::move(upload));
  return done.ok() ? ask(std::move(stage)) : done;
}

base::Status Plc::change(const ir::VerifiedImage& next, uint32_t flags, const std::string& health) {
  vm::Request change{.command = vm::Command::kSwitch};
  change.flags = flags | vm::kAllowOverrun;
  if (!health.empty()) change.names = {health};
  base::Status done = stage(next);
  return done.ok() ? ask(std::move(change)) : done;
}

}  // namespace plc
