// stvm replay: a recorded run again, cycle by cycle, compared with what it was.
#include <cstdio>
#include <optional>

#include "ir/bytecode/variable_names.h"
#include "tools/common/exit.h"
#include "tools/common/files.h"
#include "tools/common/json.h"
#include "tools/stvm/commands.h"
#include "tools/stvm/names.h"
#include "tools/stvm/player.h"
#include "tools/stvm/plot.h"
#include "tools/stvm/run_resources.h"
#include "tools/stvm/trace.h"
#include "tools/stvm/trap_text.h"

namespace stvm {
namespace {

constexpr tools::OptionRow kReplayOptions[] = {
    tools::kScansOption, tools::kPrintOption, tools::kPlotOption,
    tools::kTraceOption, STVM_FORMAT_OPTION,
};
constexpr tools::Command kReplayCommand{
    "replay",       "RECORDING", "Runs a recorded run again and compares every cycle.",
    kReplayOptions, 1,           1};

void print_result(const Player& player, vm::Controller& controller,
                  const std::vector<std::string>& names, bool json) {
  const bool whole = player.at_end() && !player.recording().cut_off;
  if (json) {
    tools::JsonWriter out;
    out.begin_object().field("cycles", controller.cycles()).field("identical", true);
    out.field("requests", player.recording().requests.size()).field("whole", whole);
    out.key("values").begin_object();
    for (const std::string& name : names) {
      out.key(name);
      typed_value_of(out, controller, name);
    }
    out.end_object().end_object();
    std::fputs(out.finish().c_str(), stdout);
    return;
  }
  for (const std::string& name : names) {
    base::Result<std::string> value = controller.get(name);
    std::printf("%s=%s\n", name.c_str(), value.ok() ? value->c_str() : "?");
  }
  std::printf("%llu cycles replayed, the state is identical after each of them\n",
              static_cast<unsigned long long>(controller.cycles()));
  if (player.recording().cut_off) std::printf("the end of the recording is lost\n");
}

base::Status replay(const tools::Options& options) {
  const bool json = wants_json(options);
  base::Result<uint64_t> scans = options.number("--scans", UINT64_MAX);
  if (!scans.ok()) return scans.error();
  const std::string& file = options.arguments().front();
  base::Result<base::Bytes> bytes = tools::read_bytes(file);
  if (!bytes.ok()) return bytes.error();
  base::Result<vm::Recording> recording = vm::decode_recording(*bytes);
  if (!recording.ok()) {
    return base::Error{recording.error().refusal, file + ": " + recording.error().text};
  }
  Player player(std::move(*recording));
  if (base::Status started = player.start(); !started.ok()) return started;
  Names names;
  for (const std::string& name : split_names(options.all("--print"))) {
    base::Result<Names> now = matching(player.controller().image(), {name});
    if (!now.ok() && is_pattern(name)) return now.error();
    if (!now.ok()) now = Names{name};  // a change can bring it
    names.insert(names.end(), now->begin(), now->end());
  }
  std::optional<Trace> trace;
  if (options.has("--trace")) {
    base::Result<Trace> opened =
        Trace::open(options.text("--trace"), player.controller().image(), names);
    if (!opened.ok()) return opened.error();
    trace.emplace(std::move(*opened));
  }
  std::optional<Plot> plot;
  if (options.has("--plot")) {
    base::Result<Plot> begun = Plot::of(player.controller(), names);
    if (!begun.ok()) return begun.error();
    plot.emplace(std::move(*begun));
  }
  while (!player.at_end() && player.controller().cycles() < *scans) {
    if (base::Status same = player.cycle(); !same.ok()) return same;
    if (!player.controller().at_boundary()) continue;
    if (plot) plot->sample(player.controller());
    if (!trace) continue;
    if (base::Status written = trace->write(player.controller()); !written.ok()) return written;
  }
  if (trace) {
    if (base::Status closed = trace->close(); !closed.ok()) return closed;
  }
  // Only now: a change can have brought them.
  for (const std::string& name : names) {
    base::Result<ir::Symbol> symbol = ir::named_symbol(player.controller().image(), name);
    if (!symbol.ok()) return symbol.error();
  }
  if (plot) {
    const std::string picture = plot->svg(player.controller().image().name);
    base::Status drawn = tools::write_file(options.text("--plot"), base::as_bytes(picture));
    if (!drawn.ok()) return drawn;
  }
  print_result(player, player.controller(), names, json);
  return base::Ok{};
}

int run_replay(const tools::Options& options) {
  base::Status done = replay(options);
  if (done.ok()) return tools::kOk;
  const int code = refuse(done.error());
  return done.error().refusal == base::Refusal::kReplayDiffers ? tools::kFindings : code;
}

}  // namespace

const Entry kReplay{&kReplayCommand, run_replay};

}  // namespace stvm
