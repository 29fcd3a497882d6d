#include "tools/stvm/fleet_agents.h"

#include <algorithm>
#include <chrono>

#include "base/joined.h"
#include "tools/common/files.h"
#include "tools/common/fleet_parts.h"
#include "tools/common/signed_content.h"

namespace stvm {
namespace {

using base::Refusal;
using std::chrono::milliseconds;

constexpr int64_t kBetweenEventsMs = 100;
constexpr int64_t kLastWordMs = 5000;  // for what is on its way to the broker at the end
constexpr int64_t kOthersMs = 2000;    // for what the broker knows of the others
constexpr const char* kNobodyShows = ", and no other one shows its program: nothing new is ordered";

base::Error not_reached(std::string text) { return {Refusal::kNotRunning, std::move(text)}; }

}  // namespace

FleetAgents::FleetAgents(Settings settings, FleetAgentsPorts ports,
                         const std::vector<FleetMember>& members)
    : settings_(std::move(settings)), ports_(std::move(ports)) {
  for (const FleetMember& member : members) {
    if (is_at_agent(member)) known_[member.place];
  }
  pump_ = std::thread([this] { pump(); });
}

FleetAgents::~FleetAgents() {
  clear_up();
  (void)ports_.broker->flush(std::min(settings_.patience_ms, kLastWordMs));
  stops_ = true;
  pump_.join();
}

void FleetAgents::pump() {
  while (!stops_) {
    if (std::optional<mqtt::Event> event = ports_.broker->wait(kBetweenEventsMs)) take(*event);
  }
}

// What a broker has of a controller may be older than the order that it has not answered.
PlanTrace FleetAgents::look(const FleetMember& member, const std::string& plan) {
  base::Result<Known> known = wait_for(member);
  if (!known.ok()) return {};
  PlanTrace trace;
  if (known->about->plan == plan) trace = known->about->trace;
  trace.answers = known->online && !known->waits_for && known->about->trace.answers;
  return trace;
}

base::Result<AgentFile> FleetAgents::put(base::ByteSpan file) {
  const AgentFile out{base::sha256(file), file.size()};
  if (put_.contains(out.digest)) return out;
  if (file.size() > kMostAgentFile) {
    return base::Error{Refusal::kTooMany, "a file of more than 64 MiB for agents"};
  }
  if (!settings_.files.empty()) {
    if (!settings_.files_folder.empty()) {
      base::Status written =
          tools::write_file(settings_.files_folder + "/" + base::to_hex(out.digest), file);
      if (!written.ok()) return written.error();
    }
  } else {
    for (uint64_t at = 0; at * kAgentPiece < file.size(); ++at) {
      const uint64_t begin = at * kAgentPiece;
      base::Status sent = ports_.broker->publish(
          settings_.topics.file(out.digest, std::to_string(at)),
          file.subspan(begin, std::min<uint64_t>(kAgentPiece, file.size() - begin)), true);
      if (!sent.ok()) return sent.error();
    }
  }
  put_[out.digest] = out;
  return out;
}

base::Result<AgentFile> FleetAgents::fleet_file(const FleetEdit& edit) {
  const std::lock_guard<std::mutex> one(making_);
  const auto found = fleet_files_.find(edit.path);
  if (found != fleet_files_.end()) return found->second;
  base::Result<base::Bytes> bytes = tools::read_content(edit.path);
  if (!bytes.ok()) return bytes.error();
  base::Result<AgentFile> file = put(*bytes);
  if (file.ok()) fleet_files_[edit.path] = *file;
  return file;
}

// Those that are there and run it; as soon as one is known, or all are.
std::vector<std::string> FleetAgents::who_runs(const base::Digest& running,
                                               const FleetMember& first) {
  std::unique_lock<std::mutex> held(mutex_);
  std::vector<std::string> out;
  const auto found = [&] {
    bool all = true;
    out.clear();
    for (const auto& [name, known] : known_) {
      all = all && known.about;
      if (!known.about || !known.online || known.about->running != running) continue;
      out.insert(name == first.place ? out.begin() : out.end(), name);
    }
    return all || !out.empty();
  };
  came_.wait_for(held, milliseconds(std::min(settings_.patience_ms, kOthersMs)), found);
  return out;
}

// The program is asked of one controller that runs it.
base::Result<FleetAgents::Program*> FleetAgents::program_of(const base::Digest& running,
                                                            const FleetMember& member) {
  const std::lock_guard<std::mutex> one(making_);
  const auto found = programs_.find(running);
  if (found != programs_.end()) return &found->second;
  base::Result<base::Bytes> bytes = not_reached("its agent is not connected to the broker");
  for (const std::string& name : who_runs(running, member)) {
    bytes = shown(name, running);
    if (bytes.ok() || bytes.error().refusal != Refusal::kNotRunning) break;
  }
  if (!bytes.ok() && bytes.error().refusal == Refusal::kNotRunning) {
    return not_reached(bytes.error().text + kNobodyShows);
  }
  if (!bytes.ok()) return bytes.error();
  base::Result<ir::VerifiedImage> image = ir::verify(*bytes);
  if (!image.ok()) return image.error();
  if (image->digest() != running) {
    return base::Error{Refusal::kStaleBase, "another program runs there than a moment ago"};
  }
  Program program{std::move(*bytes), std::move(*image), std::nullopt};
  return &programs_.emplace(running, std::move(program)).first->second;
}

base::Result<base::Bytes> FleetAgents::shown(const std::string& agent,
                                             const base::Digest& running) {
  AgentOrder order;
  order.act = AgentAct::kShow;
  order.plan = settings_.plan;
  order.base = running;
  base::Result<AgentAnswer> answer = ask(order, agent);
  if (!answer.ok()) return answer.error();
  if (answer->row.why) return *answer->row.why;
  const AgentFile file = answer->shown;
  if (file.size == 0 || file.size > kMostAgentFile) {
    return base::Error{Refusal::kTooMany, "its program is larger than 64 MiB"};
  }
  const std::string pieces = settings_.topics.file(file.digest, "+");
  std::unique_lock<std::mutex> held(mutex_);
  if (base::Status asked = ports_.broker->subscribe(pieces); !asked.ok()) return asked.error();
  pieces_.emplace(file);
  const bool whole =
      came_.wait_for(held, milliseconds(settings_.patience_ms), [&] { return pieces_->whole(); });
  base::Result<base::Bytes> bytes =
      whole ? pieces_->take() : not_reached("its program does not come from the broker");
  pieces_.reset();
  held.unlock();
  (void)ports_.broker->unsubscribe(pieces);
  clear(file);
  return bytes;
}

base::Result<AgentFile> FleetAgents::package_for(Program& program) {
  const std::lock_guard<std::mutex> one(making_);
  if (program.package) return *program.package;
  base::Result<base::Bytes> package = ports_.package(program.bytes);
  program.package = package.ok() ? put(*package) : base::Result<AgentFile>(package.error());
  return *program.package;
}

AgentOrder FleetAgents::order_of(AgentAct act, const FleetEdit& edit, const SwitchOptions& how,
                                 const AgentFile& fleet) const {
  AgentOrder order;
  order.act = act;
  order.plan = settings_.plan;
  order.wave = how.wave;
  order.note = how.note;
  // The journal there says by it what this run has done.
  if (order.note.find("plan " + settings_.plan + " wave ") == std::string::npos) {
    order.note = base::joined({order.note.empty() ? fleet_note(edit.digest) : order.note, ", plan ",
                               settings_.plan, " wave 1 by ", settings_.who});
  }
  order.fleet = fleet;
  order.source = settings_.files;
  order.stage_flags = how.stage_flags & ~uint32_t{vm::kRehearsal};
  order.switch_flags = how.switch_flags;
  order.matching = edit.matching;
  order.guard = how.guard;
  order.window_ms = how.window_ms;
  return order;
}

FleetRow FleetAgents::finished(FleetRow row, const base::Result<AgentAnswer>& answer,
                               const FleetTalk& talk) const {
  if (!answer.ok()) return talk.failed(std::move(row), answer.error());
  const FleetRow& there = answer->row;
  if (there.from != base::Digest{}) row.from = there.from;
  row.edits = there.edits;
  row.report = there.report;
  if (there.why) return talk.ended(std::move(row), there.outcome, *there.why);
  row.outcome = there.outcome;
  talk.say(base::joined({outcome_name(row.outcome), "\n"}));
  return row;
}

FleetRow FleetAgents::look_at(const FleetEdit* edit, const FleetTalk& talk,
                              const FleetMember& member) {
  FleetRow row = talk.begin(member);
  base::Result<Known> known = wait_for(member);
  if (!known.ok()) return talk.failed(std::move(row), known.error());
  row.program = known->about->program;
  row.from = known->about->running;
  row.has = known->about->parts;
  if (!known->online || !known->about->trace.answers) {
    return talk.failed(std::move(row),
                       not_reached(known->online ? "its controller does not answer its agent"
                                                 : "its agent is not connected to the broker"));
  }
  row.outcome = FleetOutcome::kReached;
  if (edit == nullptr) return row;
  // What it has published are units as it knows them: those of the edit need its image.
  base::Result<Program*> program{nullptr};
  if (!edit->parts.units().empty()) program = program_of(row.from, member);
  if (!program.ok()) return talk.failed(std::move(row), program.error());
  base::Status fits = *program ? check_parts(*edit, (*program)->image, row)
                               : check_parts(*edit, known->about->parts, base::Ok{}, row);
  return fits.ok() ? row : talk.ended(std::move(row), FleetOutcome::kRefused, fits.error());
}

FleetRow FleetAgents::change(const FleetEdit& edit, SwitchOptions how, FleetTalk& talk,
                             const FleetMember& member) {
  FleetRow row = talk.begin(member);
  if (talk.is_over()) return row;
  base::Result<Known> known = wait_for(member);
  if (!known.ok()) return talk.failed(std::move(row), known.error());
  row.program = known->about->program;
  row.from = known->about->running;
  talk.say(base::joined({row.program, " (", base::short_hex(row.from), ")\n"}));
  base::Result<Program*> program = program_of(row.from, member);
  if (!program.ok()) return talk.failed(std::move(row), program.error());
  base::Status fits = check_parts(edit, (*program)->image, row);
  talk.say(tools::part_edits_text(row.parts, true));
  if (!fits.ok()) return talk.ended(std::move(row), FleetOutcome::kRefused, fits.error());
  if (row.outcome == FleetOutcome::kHadIt) {
    const bool on_trial = known->about->edits != 0;
    if (on_trial && !how.guard.empty()) {
      return talk.ended(std::move(row), FleetOutcome::kRefused, rolls_on_trial());
    }
    const bool for_good = on_trial && (how.switch_flags & vm::kPermanent) != 0;
    if (!for_good || how.dry_run) return row;
    return decided(std::move(row), AgentAct::kMakeFinal, edit, how, talk, member);
  }
  if (!edit.steps.empty() && !edit.steps_if_needed) {
    return talk.ended(std::move(row), FleetOutcome::kRefused,
                      {Refusal::kUsage,
                       "units that start one after the other do not go over a broker; make the "
                       "fleet file without --start each"});
  }
  base::Result<AgentFile> package = package_for(**program);
  if (!package.ok()) {
    const bool has = package.error().refusal == Refusal::kNoChange;
    row = talk.ended(std::move(row), has ? FleetOutcome::kHadIt : FleetOutcome::kRefused,
                     package.error());
    if (has) row.why.reset();
    return row;
  }
  base::Result<AgentFile> fleet = fleet_file(edit);
  if (!fleet.ok()) return talk.failed(std::move(row), fleet.error());
  if (member.allow_loss) how.switch_flags |= vm::kAllowLoss;
  AgentOrder order = order_of(AgentAct::kCheck, edit, how, *fleet);
  order.base = row.from;
  order.package = *package;
  if (how.dry_run || how.ask) {
    base::Result<AgentAnswer> possible = ask(order, member.place);
    const bool ends = how.dry_run || !possible.ok() || possible->row.why;
    if (ends) return finished(std::move(row), possible, talk);
    base::Status go = talk.ask("Start it there?", "not switched; the old program runs on");
    if (!go.ok()) return talk.ended(std::move(row), FleetOutcome::kCancelled, go.error());
  }
  order.act = AgentAct::kBring;
  return finished(std::move(row), ask(order, member.place), talk);
}

FleetRow FleetAgents::decide(AgentAct act, const FleetEdit& edit, const SwitchOptions& how,
                             FleetTalk& talk, const FleetMember& member) {
  FleetRow row = talk.begin(member);
  if (talk.is_over()) return row;
  base::Result<Known> known = wait_for(member);
  if (!known.ok()) return talk.failed(std::move(row), known.error());
  row.program = known->about->program;
  row.from = known->about->running;
  return decided(std::move(row), act, edit, how, talk, member);
}

FleetRow FleetAgents::decided(FleetRow row, AgentAct act, const FleetEdit& edit,
                              const SwitchOptions& how, FleetTalk& talk,
                              const FleetMember& member) {
  base::Result<AgentFile> fleet = fleet_file(edit);
  if (!fleet.ok()) return talk.failed(std::move(row), fleet.error());
  if (how.ask) {
    const bool undoes = act == AgentAct::kTakeBack;
    base::Status go = talk.ask(undoes ? "Take it back there?" : "Make it final there?",
                               undoes ? "not taken back; the program on trial runs on"
                                      : "not accepted; it stays on trial");
    if (!go.ok()) return talk.ended(std::move(row), FleetOutcome::kCancelled, go.error());
  }
  return finished(std::move(row), ask(order_of(act, edit, how, *fleet), member.place), talk);
}

void FleetAgents::withdraw(const FleetEdit& edit, const SwitchOptions& how,
                           const FleetMember& member) {
  base::Result<AgentFile> fleet = fleet_file(edit);
  if (!fleet.ok()) return;
  const AgentOrder order = order_of(AgentAct::kTakeBack, edit, how, *fleet);
  base::Result<base::Bytes> order_signed = signed_for(order, member.place);
  if (order_signed.ok()) (void)give(member.place, *order_signed);
}

}  // namespace stvm
