#include "tools/stvm/run_timing.h"

#include "tools/common/option_rows.h"

#include <algorithm>

#include "ir/types/time_parse.h"
#include "tools/common/files.h"
#include "tools/stvm/names.h"

namespace stvm {
namespace {

base::Result<int64_t> time_of(const char* option, const std::string& text) {
  const std::optional<int64_t> ns = ir::parse_duration(text);
  if (ns && *ns >= 0) return *ns;
  return base::Error{base::Refusal::kUsage,
                     std::string(option) + ": `" + text + "` is no time; write it as in 3ms"};
}

// "WHAT=REST".
base::Result<std::pair<std::string, std::string>> parts_of(const char* option, const char* form,
                                                           const std::string& text) {
  const size_t equals = text.find('=');
  if (equals != std::string::npos && equals != 0 && equals + 1 < text.size()) {
    return std::pair{text.substr(0, equals), text.substr(equals + 1)};
  }
  return base::Error{base::Refusal::kUsage,
                     std::string(option) + ": `" + text + "` is not " + form};
}

base::Result<RunChange::Settings> change_of(const tools::Options& options) {
  RunChange::Settings out;
  auto parts = parts_of("--change", "TIME=PATH", options.text("--change"));
  if (!parts.ok()) return parts.error();
  base::Result<int64_t> at = time_of("--change", parts->first);
  if (!at.ok()) return at.error();
  base::Result<int64_t> lasts = time_of("--configuration", options.text("--configuration", "0ms"));
  if (!lasts.ok()) return lasts.error();
  out.at_ns = *at;
  out.lasts_ns = *lasts;
  out.sources = {{parts->second}, tools::given_compile_options(options)};
  const bool standby = options.text("--strategy") == "standby";
  if (standby) out.strategy = online_change::Strategy::kStandby;
  return out;
}

base::Error usage(const char* text) { return {base::Refusal::kUsage, text}; }

}  // namespace

base::Result<RunTiming> RunTiming::read(const tools::Options& options) {
  RunTiming out;
  out.chart = options.text("--chart");
  for (const std::string& text : options.all("--duration")) {
    auto parts = parts_of("--duration", "TASK=TIME", text);
    if (!parts.ok()) return parts.error();
    base::Result<int64_t> ns = time_of("--duration", parts->second);
    if (!ns.ok()) return ns.error();
    out.durations.emplace_back(parts->first, *ns);
  }
  base::Result<int64_t> safe_point = time_of("--safe-point", options.text("--safe-point", "0ms"));
  if (!safe_point.ok()) return safe_point.error();
  out.safe_point_ns = *safe_point;
  if (options.has("--change")) {
    base::Result<RunChange::Settings> change = change_of(options);
    if (!change.ok()) return change.error();
    out.change = std::move(*change);
  } else if (options.has("--configuration") || options.has("--strategy")) {
    return usage("--configuration and --strategy are of a --change");
  }
  if (!out.any()) return out;
  if (!options.has("--virtual-time")) {
    return usage("--duration, --safe-point and --change need --virtual-time");
  }
  if (options.has("--record")) {
    return usage("--record cannot be combined with --duration, --safe-point and --change");
  }
  return out;
}

base::Status RunTiming::check_tasks(const ir::Image& image) const {
  for (const auto& [name, ns] : durations) {
    const bool there =
        std::any_of(image.tasks.begin(), image.tasks.end(),
                    [&](const ir::ImageTask& task) { return ir::same_name(task.name, name); });
    if (!there) return no_such_task(image, name);
  }
  return base::Ok{};
}

uint64_t RunTiming::fuel_slice(uint64_t usual) const {
  constexpr int64_t kExactNs = 10'000;
  if (safe_point_ns == 0) return usual;
  return static_cast<uint64_t>(std::clamp<int64_t>(kExactNs / safe_point_ns, 1, 1000));
}

base::Status RunChange::stage() {
  const bool image = is_image(settings_.sources.paths.front());
  const base::Bytes running = controller_.verified().encoded();
  base::Result<base::Bytes> next = image ? tools::read_bytes(settings_.sources.paths.front())
                                         : relink(settings_.sources, running, false);
  if (!next.ok()) return next.error();
  auto package = online_change::make_package(running, *next);
  if (!package.ok()) return package.error();
  staged_ = true;
  return change_.stage(online_change::encode(*package), settings_.strategy);
}

// Where the work itself takes less than was asked for, the rest of that is idle time too, in units
// as short as others.
base::Status RunChange::configure() {
  const int64_t from_ns = clock_.now_ns();
  base::Result<bool> ready = change_.configure();
  if (!ready.ok()) return ready.error();
  const auto spent = [&] { return spent_ns_ + clock_.now_ns() - from_ns; };
  controller_.run_idle([&] {
    const int64_t left_ns = settings_.lasts_ns - spent();
    if (left_ns > 0) clock_.advance(std::min(left_ns, vm::kIdleUnitNs));
    return left_ns > 0;
  });
  spent_ns_ = spent();
  configured_ = *ready && spent_ns_ >= settings_.lasts_ns;
  return base::Ok{};
}

base::Status RunChange::switch_over() {
  if (base::Status armed = change_.arm(false); !armed.ok()) return armed;
  if (auto switched = change_.switch_now(); !switched.ok()) return switched.error();
  done_ = true;
  return change_.accept();
}

base::Status RunChange::step(TimingChart* chart) {
  if (done_) return base::Ok{};
  if (!staged_) {
    if (settings_.at_ns >= controller_.next_cycle_ns()) return base::Ok{};
    clock_.wait_until(settings_.at_ns);
    if (base::Status staged = stage(); !staged.ok()) return staged;
  }
  if (!configured_) {
    const int64_t from_ns = clock_.now_ns();
    if (base::Status done = configure(); !done.ok()) return done;
    if (chart != nullptr) chart->configured(from_ns, clock_.now_ns());
    if (!configured_) return base::Ok{};
  }
  const int64_t at_ns = clock_.now_ns();
  if (at_ns + change_.predicted_pause_ns() > controller_.next_cycle_ns()) return base::Ok{};
  if (chart != nullptr) chart->switched(at_ns);
  return switch_over();
}

base::Status RunChange::end() const {
  if (done_) return base::Ok{};
  return usage("the run ended before the switch of its --change; give it more --scans");
}

}  // namespace stvm
