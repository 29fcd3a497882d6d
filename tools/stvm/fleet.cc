// stvm fleet: one edit and many controllers (E-27 to E-32). A run is a verb, who is visited, and a
// table of what came out.
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <memory>

#include "base/nearest_name.h"
#include "tools/common/exit.h"
#include "tools/common/files.h"
#include "tools/stvm/fleet_agents.h"
#include "tools/stvm/fleet_command.h"
#include "tools/stvm/fleet_left.h"
#include "tools/stvm/fleet_matrix.h"
#include "tools/stvm/fleet_rollout.h"
#include "tools/stvm/fleet_visit.h"
#include "tools/stvm/fleet_walk.h"
#include "tools/stvm/question.h"
#include "vm/runtime/socket_peer.h"

namespace stvm {
namespace {

struct FleetRun {
  std::string verb;
  FleetEdit edit;  // without a path: there is none
  SwitchOptions how;
  bool json = false;
  bool all = false;
  uint32_t patience_s = vm::SocketClient::kPatienceSeconds;
  FleetWalk walk;
  FleetAccess access;
  std::vector<FleetMember> members;
  std::string broker;  // the table that leads to some of them
};

base::Error fleet_usage(std::string text) { return {base::Refusal::kUsage, "fleet: " + text}; }

bool changes(const std::string& verb) {
  return verb == "change" || verb == "undo" || verb == "accept";
}

base::Result<uint32_t> fleet_number(const tools::Options& options, const char* name, uint32_t most,
                                    uint32_t otherwise) {
  base::Result<uint64_t> given = options.number(name, otherwise);
  if (!given.ok()) return given.error();
  if (*given >= 1 && *given <= most) return static_cast<uint32_t>(*given);
  return fleet_usage(std::string(name) + " is between 1 and " + std::to_string(most));
}

// Who is visited: whom the command line names, or whom an earlier run has left.
base::Status find_members(const tools::Options& options, FleetRun& run) {
  const bool named = options.has("--dir") || options.has("--host") || options.has("--fleet");
  if (run.verb != "continue") {
    base::Result<std::vector<FleetMember>> members = fleet_members(options);
    if (!members.ok()) return members.error();
    run.members = std::move(*members);
    return base::Ok{};
  }
  if (named)
    return fleet_usage(
        "continue takes those that an earlier run has left; leave out --dir, "
        "--host and --fleet");
  base::Result<std::string> verb = FleetLeft(run.edit.path, run.edit.digest).read(run.members);
  if (!verb.ok()) return verb.error();
  run.verb = *verb;
  return changes(run.verb) ? base::Status(base::Ok{})
                           : fleet_usage("`" + run.verb + "` cannot be continued");
}

// Controllers of the file that a broker leads to.
base::Status reach_broker(const tools::Options& options, ConnectBroker connect, FleetRun& run) {
  if (std::none_of(run.members.begin(), run.members.end(), is_at_agent)) return base::Ok{};
  FleetBrokerUse use;
  use.connect = connect;
  use.file = options.has("--fleet") ? options.text("--fleet")
                                    : FleetLeft(run.edit.path, run.edit.digest).path();
  base::Result<std::string> list = tools::read_text(use.file);
  if (!list.ok()) return list.error();
  use.list = std::move(*list);
  base::Result<FleetBroker> broker = parse_broker(use.file, use.list);
  if (!broker.ok()) return broker.error();
  run.broker = broker_text(*broker);
  use.key = run.how.sign;
  use.plan = new_plan_id();
  use.who = vm::user_name(::geteuid());
  use.patience_s = run.patience_s;
  if (use.key.empty() && changes(run.verb)) {
    return base::Error{base::Refusal::kUnsigned,
                       "agents carry out only what is signed: --sign KEY"};
  }
  return reach_agents(use, run.members, run.access);
}

base::Status check_walk(const FleetRun& run) {
  const bool several = run.walk.jobs > 1;
  if (several && run.walk.one_by_one)
    return fleet_usage("--jobs and --one-by-one contradict each other");
  if (!changes(run.verb)) return base::Ok{};
  if (several && run.how.ask && !run.how.dry_run) {
    return fleet_usage("--jobs cannot ask about each controller; pass --yes");
  }
  // E-28: without a terminal and --yes, nothing is sent to anybody.
  if (run.how.ask && !run.how.dry_run && !can_ask()) {
    return base::Error{base::Refusal::kUsage,
                       "cannot ask for confirmation: stdin is not a terminal; pass --yes"};
  }
  return base::Ok{};
}

base::Status read_options(const tools::Options& options, FleetRun& run) {
  base::Result<uint32_t> jobs = fleet_number(options, "--jobs", 256, 1);
  if (!jobs.ok()) return jobs.error();
  base::Result<uint32_t> patience =
      fleet_number(options, "--timeout", 86'400, vm::SocketClient::kPatienceSeconds);
  if (!patience.ok()) return patience.error();
  base::Result<SwitchOptions> how = switch_options(options, {run.edit.path});
  if (!how.ok()) return how.error();
  run.how = std::move(*how);
  run.json = run.how.json;
  run.all = run.how.all;
  run.how.json = run.json || *jobs > 1;  // what several say at once nobody could read
  run.walk.jobs = *jobs;
  run.patience_s = *patience;
  run.walk.one_by_one = options.has("--one-by-one");
  run.access = fleet_access(*patience, run.edit.path, {run.how.restricted, run.edit.matching});
  return base::Ok{};
}

base::Error no_such_verb(const std::string& given) {
  base::NearestName nearest(given);
  std::string all;
  for (const char* verb : {"change", "status", "diff", "undo", "accept", "continue", "roll",
                           "resume", "abort", "watch"}) {
    nearest.offer(verb);
    all += (all.empty() ? "" : ", ") + std::string(verb);
  }
  return fleet_usage("`" + given + "` is none of its verbs: " + all + nearest.question());
}

base::Result<FleetRun> read_run(const tools::Options& options, ConnectBroker connect) {
  FleetRun run;
  run.verb = options.arguments()[0];
  const size_t more = options.arguments().size() - 1;
  const bool known =
      changes(run.verb) || run.verb == "status" || run.verb == "continue" || run.verb == "diff";
  if (!known) return no_such_verb(run.verb);
  if (run.verb == "diff") {
    if (base::Status read = read_options(options, run); !read.ok()) return read.error();
    return run;
  }
  if (more > 1) return fleet_usage(run.verb + " takes one fleet file");
  if (more == 0 && run.verb != "status") return fleet_usage(run.verb + " needs a fleet file");
  if (more == 1) {
    base::Status trusted = check_fleet_signature(options.arguments()[1], options);
    if (!trusted.ok()) return trusted.error();
    base::Result<FleetEdit> edit = read_fleet_edit(options.arguments()[1]);
    if (!edit.ok()) return edit.error();
    run.edit = std::move(*edit);
    run.edit.matching = options.has("--matching");
  }
  if (base::Status read = read_options(options, run); !read.ok()) return read.error();
  if (base::Status found = find_members(options, run); !found.ok()) return found.error();
  if (base::Status fits = check_walk(run); !fits.ok()) return fits.error();
  if (base::Status reached = reach_broker(options, connect, run); !reached.ok()) {
    return reached.error();
  }
  return run;
}

bool answers(const FleetAccess& access, const FleetMember& member) {
  if (is_at_agent(member)) return access.agents->is_online(member);
  base::Result<ControllerClient> client = access.connect(member);
  return client.ok() && client->status().ok();
}

std::unique_ptr<FleetVisit> visit_of(const FleetRun& run) {
  if (run.verb == "change") {
    return std::make_unique<FleetChange>(run.edit, run.how, run.access);
  }
  if (run.verb == "undo") return std::make_unique<FleetUndo>(run.edit, run.how, run.access);
  return std::make_unique<FleetAccept>(run.edit, run.how, run.access);
}

void say_left(const FleetLeft& left, const FleetRun& run) {
  if (!left.complaint().empty()) {
    std::fprintf(stderr, "stvm: the list of controllers that are left cannot be written: %s\n",
                 left.complaint().c_str());
  } else if (!left.members().empty() && !run.json) {
    std::printf("%zu left: `stvm fleet continue %s` goes on with them\n", left.members().size(),
                run.edit.path.c_str());
  }
}

int go_through(FleetRun& run) {
  FleetLeft left(run.edit.path, run.edit.digest);
  const bool notes = !run.how.dry_run;
  left.keep_broker(run.broker);
  if (notes) left.begin(run.verb, run.members);
  const std::unique_ptr<FleetVisit> verb = visit_of(run);
  run.walk.visit = [&](const FleetMember& member) { return verb->visit(member); };
  run.walk.answers = [&](const FleetMember& member) { return answers(run.access, member); };
  run.walk.told = [&](const FleetMember& member, const FleetRow& row) {
    if (notes) left.visited(member, is_good(row.outcome));
    if (run.walk.jobs == 1 || run.json) return;
    std::printf("%s: %s\n", row.place.c_str(), std::string(outcome_name(row.outcome)).c_str());
    std::fflush(stdout);
  };
  const std::vector<FleetRow> rows = walk(run.members, run.walk);
  if (run.json) {
    std::fputs(fleet_json(run.edit.digest, rows).c_str(), stdout);
  } else {
    const bool said = run.walk.jobs == 1;  // by each visit
    std::printf("\n%s", (fleet_text(rows) + (said ? "" : reasons_text(rows))).c_str());
  }
  if (notes) say_left(left, run);
  return fleet_exit_code(rows);
}

std::string edit_text(const FleetEdit& edit) {
  return tools::part_edits_text(
      ir::part_edits(edit.parts.original, edit.parts.edited, edit.parts.original), false);
}

// Without a fleet file 1 also says that they differ.
int show_status(FleetRun& run) {
  const FleetEdit* const edit = run.edit.path.empty() ? nullptr : &run.edit;
  run.walk.visit = [&](const FleetMember& member) {
    return look_at(edit, run.access, FleetTalk(true), member);
  };
  run.walk.one_by_one = false;
  run.walk.told = [](const FleetMember&, const FleetRow&) {};
  const std::vector<FleetRow> rows = walk(run.members, run.walk);
  const bool of_edit = edit != nullptr;
  const FleetMatrix matrix = fleet_matrix(rows, of_edit);
  if (run.json) {
    tools::JsonWriter json;
    json.begin_object().field("file", of_edit ? base::to_hex(run.edit.digest) : std::string());
    json.key("controllers");
    fleet_rows_json(rows, json);
    json.key("parts");
    matrix_json(matrix, json);
    json.end_object();
    std::fputs(json.finish().c_str(), stdout);
  } else {
    if (of_edit) std::fputs(edit_text(run.edit).c_str(), stdout);
    std::printf("%s%s\n%s", of_edit ? "\n" : "", matrix_text(matrix, of_edit, run.all).c_str(),
                (fleet_text(rows) + reasons_text(rows)).c_str());
  }
  const int code = fleet_exit_code(rows);
  return code == tools::kOk && !of_edit && matrix.differs ? tools::kFindings : code;
}

}  // namespace

FleetAccess fleet_access(uint32_t patience_s, const std::string& file, const PackageOptions& made) {
  FleetAccess access;
  access.connect = [patience_s](const FleetMember& member) -> base::Result<ControllerClient> {
    if (is_at_agent(member)) {
      return base::Error{base::Refusal::kUsage,
                         member.name +
                             " is reached over a broker only: change, undo, accept, "
                             "status, continue and roll-outs go there"};
    }
    return is_at_folder(member) ? ControllerClient::connect_here(member.place, patience_s)
                                : ControllerClient::connect_there(member.place, {}, patience_s);
  };
  access.package = [file, made](const base::Bytes& running, size_t step) {
    PackageOptions of_step = made;
    of_step.step = step;
    return make_package({{file}, {}}, of_step, running);
  };
  return access;
}

int run_fleet(const tools::Options& options, ConnectBroker connect) {
  if (is_roll_verb(options.arguments()[0])) return run_roll(options, connect);
  base::Result<FleetRun> run = read_run(options, connect);
  if (!run.ok()) return refuse(run.error());
  if (run->verb == "diff") return compare_fleet(options, run->access);
  return run->verb == "status" ? show_status(*run) : go_through(*run);
}

}  // namespace stvm
