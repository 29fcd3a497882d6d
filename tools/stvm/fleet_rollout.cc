// stvm fleet roll, resume, abort, watch: an edit goes out by waves (X6-01 to X6-10). The plan lies
// beside the fleet file, and whoever works on it holds its lock.
#include "tools/stvm/fleet_rollout.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/random.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <thread>

#include "base/joined.h"
#include "tools/common/child.h"
#include "tools/common/exit.h"
#include "tools/common/files.h"
#include "tools/stvm/commands.h"
#include "tools/stvm/fleet_agents.h"
#include "tools/stvm/fleet_roll.h"
#include "tools/stvm/question.h"
#include "vm/runtime/descriptor.h"
#include "vm/runtime/socket_peer.h"

namespace stvm {
namespace {

constexpr int64_t kMsOfASecond = 1000;

base::Error roll_usage(std::string text) {
  return {base::Refusal::kUsage, "fleet: " + std::move(text)};
}

int64_t wall_ms() {
  return std::chrono::duration_cast<std::chrono::milliseconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

}  // namespace

std::string new_plan_id() {
  uint32_t number = 0;
  if (::getrandom(&number, sizeof number, 0) != sizeof number) {
    number = static_cast<uint32_t>(wall_ms());
  }
  char text[16];
  std::snprintf(text, sizeof text, "%08x", number);
  return text;
}

namespace {

// One tool at a time works on a plan.
base::Result<vm::Descriptor> hold_plan(const std::string& path) {
  const std::string lock = path + ".lock";
  vm::Descriptor held(::open(lock.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666));
  if (!held.valid()) {
    return base::Error{base::Refusal::kFileUnwritable, lock + ": " + std::strerror(errno)};
  }
  if (::flock(held.get(), LOCK_EX | LOCK_NB) == 0) return held;
  return base::Error{base::Refusal::kBusy,
                     path + ": a roll-out is at work on it; end that, or `stvm fleet watch` it"};
}

base::Result<base::Bytes> package_to_before(const base::Bytes& running, const base::Bytes& before) {
  base::Result<tools::TemporaryFolder> folder = tools::TemporaryFolder::make();
  if (!folder.ok()) return folder.error();
  const std::string file = folder->file("before.img");
  if (base::Status written = tools::write_file(file, before); !written.ok()) {
    return written.error();
  }
  return make_package({{file}, {}}, {}, running);
}

// What a roll-out has in its hands.
struct RollJob {
  std::string path;  // of the plan
  vm::Descriptor lock;
  RollPlan plan;
  FleetEdit edit;
  FleetAccess access;
  bool ask = true;
  bool json = false;
};

base::Result<uint32_t> patience(const tools::Options& options) {
  base::Result<uint64_t> given = options.number("--timeout", vm::SocketClient::kPatienceSeconds);
  if (!given.ok()) return given.error();
  if (*given >= 1 && *given <= 86'400) return static_cast<uint32_t>(*given);
  return roll_usage("--timeout is between 1 and 86400");
}

// A plan has no key, so whoever goes on with it gives it again.
base::Status reach_agents_of(RollJob& job, ConnectBroker connect, uint32_t patience_s) {
  std::vector<FleetMember> members;
  for (const RollMember& row : job.plan.members) members.push_back(row.member);
  if (std::none_of(members.begin(), members.end(), is_at_agent)) return base::Ok{};
  if (job.access.sign.empty()) {
    return base::Error{base::Refusal::kUnsigned,
                       "agents carry out only what is signed: --sign KEY"};
  }
  FleetBrokerUse use;
  use.connect = connect;
  use.file = job.path + " (fleet.toml)";
  use.list = job.plan.list;
  use.key = job.access.sign;
  use.plan = job.plan.id;
  use.who = job.plan.who;
  use.patience_s = patience_s;
  return reach_agents(use, members, job.access);
}

base::Status open_edit(RollJob& job, const tools::Options& options, ConnectBroker connect) {
  base::Result<uint32_t> seconds = patience(options);
  if (!seconds.ok()) return seconds.error();
  base::Result<FleetEdit> edit = read_fleet_edit(job.plan.file);
  if (!edit.ok()) return edit.error();
  if (edit->digest != job.plan.digest) {
    return base::Error{base::Refusal::kBadHash,
                       job.plan.file + " is another file than the one that the plan is of"};
  }
  if (!edit->steps.empty() && !edit->steps_if_needed) {
    return roll_usage(
        "the units of this file start one after the other, and a roll-out lets "
        "them start together; make it without --start each");
  }
  job.edit = std::move(*edit);
  job.edit.steps.clear();
  job.edit.matching = job.plan.matching;
  job.access = fleet_access(*seconds, job.plan.file, {false, job.plan.matching});
  job.access.sign = options.text("--sign");
  return reach_agents_of(job, connect, *seconds);
}

RollPorts ports_of(const RollJob& job) {
  RollPorts ports;
  ports.now_ms = wall_ms;
  ports.pause_ms = [](int64_t ms) { std::this_thread::sleep_for(std::chrono::milliseconds(ms)); };
  ports.save = [path = job.path](const RollPlan& plan) { return write_plan(path, plan); };
  ports.say = [json = job.json](const std::string& text) {
    if (json) return;
    std::fputs(text.c_str(), stdout);
    std::fflush(stdout);
  };
  ports.may_begin = [ask_each = job.ask](const RollPlan& plan) {
    if (!ask_each || !plan.confirm_each || plan.wave == 0) return base::Status(base::Ok{});
    const std::string question = "Begin wave " + std::to_string(plan.wave + 1) + "?";
    return ask(question.c_str(), "not begun; `stvm fleet resume` goes on with it");
  };
  ports.package_back = package_to_before;
  return ports;
}

base::Status may_ask(const RollJob& job) {
  if (!job.ask || can_ask()) return base::Ok{};
  return base::Error{base::Refusal::kUsage,
                     "cannot ask for confirmation: stdin is not a terminal; pass --yes"};
}

// X6-02: who cannot be changed now is a failure of its wave.
base::Status check_rows(const RollPlan& plan, const std::vector<FleetRow>& rows) {
  for (size_t i = 0; i < plan.settings.waves.size(); ++i) {
    const Wave& wave = plan.settings.waves[i];
    std::string names;
    size_t bad = 0;
    for (const size_t member : wave.members) {
      if (is_good(rows[member].outcome)) continue;
      names += (bad++ == 0 ? "" : ", ") + rows[member].place;
    }
    if (bad <= wave.max_failed) continue;
    return base::Error{base::Refusal::kOtherPart,
                       base::joined({"nothing was begun: in wave ", std::to_string(i + 1), " ",
                                     names, " cannot take the edit"})};
  }
  return base::Ok{};
}

int finish_roll(const RollJob& job, const base::Status& ended) {
  if (job.json) {
    std::fputs(plan_json(job.plan, wall_ms()).c_str(), stdout);
  } else {
    std::printf("\n%s", plan_page(job.plan, wall_ms()).c_str());
  }
  if (ended.ok()) return plan_exit_code(job.plan);
  if (job.json) return refuse_reported(ended.error());
  if (!is_over(job.plan.phase)) {
    std::printf("`stvm fleet resume %s` goes on with it\n", job.path.c_str());
  }
  return refuse(ended.error());
}

int carry_out(RollJob& job) {
  FleetRoll roll(job.plan, job.edit, job.access, ports_of(job));
  return finish_roll(job, roll.run());
}

base::Result<RollJob> read_new_job(const tools::Options& options, ConnectBroker connect) {
  if (options.arguments().size() != 2) return roll_usage("roll needs a fleet file");
  if (!options.has("--fleet") || options.has("--dir") || options.has("--host")) {
    return roll_usage("roll takes controllers and waves from --fleet FILE");
  }
  const std::string& file = options.arguments()[1];
  base::Status trusted = check_fleet_signature(file, options);
  if (!trusted.ok()) return trusted.error();
  base::Result<FleetEdit> edit = read_fleet_edit(file);
  if (!edit.ok()) return edit.error();
  base::Result<SwitchOptions> how = switch_options(options, {file});
  if (!how.ok()) return how.error();
  base::Result<RollPlan> plan = new_plan(options.text("--fleet"));
  if (!plan.ok()) return plan.error();
  RollJob job;
  job.path = file + ".plan";
  job.plan = std::move(*plan);
  job.plan.id = new_plan_id();
  job.plan.who = vm::user_name(::geteuid());
  char* const whole = ::realpath(file.c_str(), nullptr);
  job.plan.file = whole == nullptr ? file : whole;
  ::free(whole);
  job.plan.digest = edit->digest;
  job.plan.stage_flags = how->stage_flags & ~uint32_t{vm::kRehearsal};
  job.plan.switch_flags = how->switch_flags & (vm::kAllowLoss | vm::kAllowOverrun);
  job.plan.matching = options.has("--matching");
  job.plan.confirm_each = options.has("--confirm-each-wave");
  job.ask = how->ask;
  job.json = how->json;
  if (base::Status opened = open_edit(job, options, connect); !opened.ok()) {
    return opened.error();
  }
  return job;
}

int begin_roll(const tools::Options& options, ConnectBroker connect) {
  base::Result<RollJob> read = read_new_job(options, connect);
  if (!read.ok()) return refuse(read.error());
  RollJob& job = *read;
  const bool dry = options.has("--dry-run");
  if (base::Status may = may_ask(job); !dry && !may.ok()) return refuse(may.error());
  base::Result<vm::Descriptor> lock = hold_plan(job.path);
  if (!lock.ok()) return refuse(lock.error());
  job.lock = std::move(*lock);
  if (tools::is_there(job.path)) {
    base::Result<RollPlan> before = read_plan(job.path);
    if (!before.ok()) return refuse(before.error());
    if (!is_over(before->phase)) {
      return refuse({base::Refusal::kChangePending,
                     base::joined({job.path,
                                   " is not over: `stvm fleet resume` goes on with it, "
                                   "`stvm fleet abort` takes it back"})});
    }
  }
  if (!job.json) std::fputs(plan_outline(job.plan).c_str(), stdout);
  FleetRoll roll(job.plan, job.edit, job.access, ports_of(job));
  const std::vector<FleetRow> rows = roll.check_all();
  if (!job.json) std::printf("\n%s", (fleet_text(rows) + reasons_text(rows)).c_str());
  base::Status fits = check_rows(job.plan, rows);
  if (dry || !fits.ok()) {
    if (job.json) std::fputs(fleet_json(job.edit.digest, rows).c_str(), stdout);
    if (fits.ok()) return fleet_exit_code(rows);
    return job.json ? refuse_reported(fits.error()) : refuse(fits.error());
  }
  if (job.ask) {
    const base::Status go = ask("Begin with wave 1?", "nothing was begun");
    if (!go.ok()) return refuse(go.error());
  }
  if (base::Status saved = write_plan(job.path, job.plan); !saved.ok()) {
    return refuse(saved.error());
  }
  return finish_roll(job, roll.run());
}

base::Result<RollPlan> named_plan(const tools::Options& options) {
  if (options.arguments().size() == 2) return read_plan(options.arguments()[1]);
  return roll_usage(options.arguments()[0] + " needs the plan of a roll-out, x.fleet.plan");
}

base::Result<RollJob> read_old_job(const tools::Options& options, ConnectBroker connect) {
  RollJob job;
  base::Result<RollPlan> looked_at = named_plan(options);
  if (!looked_at.ok()) return looked_at.error();
  job.path = options.arguments()[1];
  base::Result<vm::Descriptor> lock = hold_plan(job.path);
  if (!lock.ok()) return lock.error();
  job.lock = std::move(*lock);
  base::Result<RollPlan> plan = read_plan(job.path);  // nobody writes it any more
  if (!plan.ok()) return plan.error();
  job.plan = std::move(*plan);
  job.ask = !options.has("--yes");
  job.json = wants_json(options);
  if (base::Status opened = open_edit(job, options, connect); !opened.ok()) {
    return opened.error();
  }
  return job;
}

int resume_roll(const tools::Options& options, ConnectBroker connect) {
  base::Result<RollJob> job = read_old_job(options, connect);
  if (!job.ok()) return refuse(job.error());
  const bool asks = job->plan.confirm_each && job->ask;
  if (base::Status may = may_ask(*job); asks && !may.ok()) return refuse(may.error());
  return carry_out(*job);
}

int abort_roll(const tools::Options& options, ConnectBroker connect) {
  base::Result<RollJob> job = read_old_job(options, connect);
  if (!job.ok()) return refuse(job.error());
  FleetRoll roll(job->plan, job->edit, job->access, ports_of(*job));
  base::Status ended = roll.abort();
  const int code = finish_roll(*job, ended);
  return ended.ok() && job->plan.phase == RollPhase::kAborted ? tools::kOk : code;
}

// At a terminal a page that refreshes; else one page for each change of the plan.
int watch_roll(const tools::Options& options, ConnectBroker) {
  const bool terminal = ::isatty(STDOUT_FILENO) != 0;
  std::string before;
  for (;;) {
    base::Result<RollPlan> plan = named_plan(options);
    if (!plan.ok()) return refuse(plan.error());
    if (wants_json(options)) {
      std::fputs(plan_json(*plan, wall_ms()).c_str(), stdout);
      return tools::kOk;
    }
    const std::string text = plan_text(*plan);
    if (terminal) std::fputs("\x1b[H\x1b[J", stdout);
    if (terminal || text != before) std::fputs(plan_page(*plan, wall_ms()).c_str(), stdout);
    std::fflush(stdout);
    before = text;
    if (is_over(plan->phase)) return plan_exit_code(*plan);
    std::this_thread::sleep_for(std::chrono::milliseconds(kMsOfASecond));
  }
}

struct RollVerb {
  std::string_view name;
  int (*run)(const tools::Options&, ConnectBroker);
};
constexpr RollVerb kRollVerbs[] = {
    {"roll", begin_roll}, {"resume", resume_roll}, {"abort", abort_roll}, {"watch", watch_roll}};

}  // namespace

bool is_roll_verb(const std::string& verb) {
  return std::any_of(std::begin(kRollVerbs), std::end(kRollVerbs),
                     [&](const RollVerb& one) { return one.name == verb; });
}

int run_roll(const tools::Options& options, ConnectBroker connect) {
  for (const RollVerb& one : kRollVerbs) {
    if (one.name == options.arguments()[0]) return one.run(options, connect);
  }
  return refuse(roll_usage("there is no such verb"));
}

}  // namespace stvm
