// stvm fleet change: one edit for many controllers, one after the other (E-27 to E-31). Each is
// checked before anything is sent; what it refuses, or does not answer, stops none of the others.
#include <cstdio>

#include "tools/common/exit.h"
#include "tools/common/files.h"
#include "tools/common/fleet_parts.h"
#include "tools/stvm/commands.h"
#include "tools/stvm/fleet_list.h"
#include "tools/stvm/fleet_result.h"
#include "tools/stvm/package_making.h"
#include "tools/stvm/question.h"
#include "tools/stvm/switch_option_rows.h"
#include "tools/stvm/switch_steps.h"

namespace stvm {
namespace {

constexpr tools::OptionRow kFleetOptions[] = {
    {"--dir", "DIR", "state directory of a controller; repeatable", "", "", tools::Times::kMany},
    {"--host", "HOST", "[user@]host of a controller, by ssh; repeatable", "", "",
     tools::Times::kMany},
    {"--fleet", "FILE", "the controllers of this file (docs/FLEET.md)"},
    STVM_SWITCH_OPTIONS,
    tools::kMatchingOption,
    STVM_FORMAT_OPTION,
};
constexpr tools::Command kFleetCommand{
    "fleet",
    "change|status FILE",
    "Makes the edit of a fleet file (stc fleet) on many controllers, or says what they have of it.",
    kFleetOptions,
    2,
    2};

struct FleetEdit {
  std::string path;
  base::Digest digest{};
  tools::FleetParts parts;
  bool changes = false;  // else only the check
  bool matching = false;
};

base::Result<FleetEdit> read_edit(const tools::Options& options) {
  const std::string& verb = options.arguments()[0];
  FleetEdit edit;
  edit.path = options.arguments()[1];
  edit.changes = verb == "change";
  edit.matching = options.has("--matching");
  if (!edit.changes && verb != "status") {
    return base::Error{base::Refusal::kUsage,
                       "fleet: `" + verb + "` is neither `change` nor `status`"};
  }
  base::Result<base::Bytes> bytes = tools::read_bytes(edit.path);
  if (!bytes.ok()) return bytes.error();
  edit.digest = online_change::fleet_digest(*bytes);
  base::Result<online_change::FleetFile> file = online_change::decode_fleet_file(*bytes);
  if (!file.ok()) return file.error();
  base::Result<tools::FleetParts> parts = tools::parts_of(*file);
  if (!parts.ok()) return parts.error();
  edit.parts = std::move(*parts);
  return edit;
}

// What the person at the terminal said last: for this one, for all that follow, or no more.
struct Dialogue {
  bool all = false;
  bool quit = false;

  base::Status ask_once() {
    if (all) return base::Ok{};
    const Answer answer = ask_for_each("Start it there?");
    all = answer == Answer::kAll;
    quit = answer == Answer::kQuit;
    if (answer == Answer::kYes || all) return base::Ok{};
    return base::Error{base::Refusal::kBusy, "not switched; the old program runs on"};
  }
};

class FleetRun {
 public:
  FleetRun(const FleetEdit& edit, SwitchOptions how) : edit_(edit), how_(std::move(how)) {
    how_.note = "fleet file " + base::short_hex(edit.digest);
    how_.confirm = [this] { return dialogue_.ask_once(); };
  }

  FleetRow visit(const FleetMember& member) {
    FleetRow row;
    row.place = member.name;
    if (dialogue_.quit) return row;
    if (!how_.json) std::printf("== %s\n", member.name.c_str());
    base::Result<ControllerClient> client = ControllerClient::connect_to(member.place);
    if (!client.ok()) return ended(row, FleetOutcome::kUnreachable, client.error());
    base::Result<vm::StatusReport> status = client->status();
    if (!status.ok()) return ended(row, FleetOutcome::kUnreachable, status.error());
    base::Result<base::Bytes> running = client->image();
    if (!running.ok()) return ended(row, FleetOutcome::kUnreachable, running.error());
    if (base::Status checked = check(*running, row); !checked.ok()) {
      return ended(row, FleetOutcome::kRefused, checked.error());
    }
    if (row.outcome == FleetOutcome::kHadIt || !edit_.changes) return row;
    SwitchOptions how = how_;
    if (member.allow_loss) how.switch_flags |= vm::kAllowLoss;
    change(how, *client, *running, row);
    return row;
  }

 private:
  // E-11: every part of the edit, before a byte is sent.
  base::Status check(const base::Bytes& running, FleetRow& row) {
    base::Result<ir::VerifiedImage> image = ir::verify(running);
    if (!image.ok()) return image.error();
    row.from = image->digest();
    row.program = image->image().name;
    row.parts =
        ir::part_edits(edit_.parts.original, edit_.parts.edited, ir::parts_of(image->image()));
    row.table = tools::own_table_edits(edit_.parts, image->image());
    if (!how_.json) {
      std::printf("%s (%s)\n%s", row.program.c_str(), base::short_hex(row.from).c_str(),
                  tools::part_edits_text(row.parts, true).c_str());
    }
    bool all = true;
    std::string others;
    for (const ir::PartEdit& part : row.parts) {
      all = all && part.state == ir::PartState::kHasIt;
      if (part.state == ir::PartState::kOk || part.state == ir::PartState::kHasIt) continue;
      others += (others.empty() ? "" : ", ") + part.name + " is " +
                std::string(tools::part_state_name(part.state));
    }
    row.outcome = all ? FleetOutcome::kHadIt : FleetOutcome::kPossible;
    base::Status kept = online_change::check_table(row.table, "its own table");
    const bool fit = others.empty() || edit_.matching;
    if (fit) return all ? base::Status(base::Ok{}) : kept;
    if (!kept.ok()) others += "; " + kept.error().text;
    return base::Error{base::Refusal::kOtherPart, others};
  }

  void change(const SwitchOptions& how, ControllerClient& client, const base::Bytes& running,
              FleetRow& row) {
    base::Result<base::Bytes> package =
        make_package({{edit_.path}, {}}, {how.restricted, edit_.matching}, running);
    if (!package.ok()) {
      const bool has = package.error().refusal == base::Refusal::kNoChange;
      ended(row, has ? FleetOutcome::kHadIt : FleetOutcome::kRefused, package.error());
      if (has) row.why.reset();
      return;
    }
    base::Result<Outcome> outcome = bring(how, client, *package);
    if (!outcome.ok() || outcome->refused) {
      const base::Error& why = outcome.ok() ? *outcome->refused : outcome.error();
      const bool said_no = why.refusal == base::Refusal::kBusy && outcome.ok() && how.ask;
      ended(row, said_no ? FleetOutcome::kCancelled : FleetOutcome::kRefused, why);
      return;
    }
    row.outcome = how.dry_run ? FleetOutcome::kPossible : FleetOutcome::kDone;
    row.report = outcome->report;
    if (!how.json) print(how, *outcome);
  }

  FleetRow ended(FleetRow& row, FleetOutcome outcome, const base::Error& why) {
    row.outcome = outcome;
    row.why = why;
    if (!how_.json) {
      std::printf("cannot be changed: %s: %s\n", base::refusal_code(why.refusal), why.text.c_str());
    }
    return row;
  }

  const FleetEdit& edit_;
  SwitchOptions how_;
  Dialogue dialogue_;
};

int run_fleet(const tools::Options& options) {
  base::Result<FleetEdit> edit = read_edit(options);
  if (!edit.ok()) return refuse(edit.error());
  base::Result<SwitchOptions> how = switch_options(options, {edit->path});
  if (!how.ok()) return refuse(how.error());
  const base::Result<std::vector<FleetMember>> members = fleet_members(options);
  if (!members.ok()) return refuse(members.error());
  // E-28: nobody to ask is said before anything is sent to anybody.
  if (edit->changes && how->ask && !how->dry_run && !can_ask()) {
    return refuse({base::Refusal::kUsage, "nobody to ask: not a terminal; give --yes"});
  }
  FleetRun run(*edit, *how);
  std::vector<FleetRow> rows;
  for (const FleetMember& member : *members) rows.push_back(run.visit(member));
  if (how->json) {
    std::fputs(fleet_json(edit->digest, rows).c_str(), stdout);
  } else {
    std::printf("\n%s", fleet_text(rows).c_str());
  }
  return fleet_exit_code(rows);
}

}  // namespace

const Entry kFleet{&kFleetCommand, run_fleet};

}  // namespace stvm
