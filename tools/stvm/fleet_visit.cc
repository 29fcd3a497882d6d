#include "tools/stvm/fleet_visit.h"

#include <cstdio>

#include "tools/common/fleet_parts.h"
#include "tools/stvm/fleet_agents.h"
#include "tools/stvm/question.h"
#include "tools/stvm/waiting.h"

namespace stvm {

FleetRow FleetTalk::begin(const FleetMember& member) const {
  FleetRow row;
  row.place = member.name;
  if (!quit_) say("== " + member.name + "\n");
  return row;
}

void FleetTalk::say(const std::string& text) const {
  if (quiet_) return;
  std::fputs(text.c_str(), stdout);
  std::fflush(stdout);
}

base::Status FleetTalk::ask(const char* question, const char* otherwise) {
  if (all_) return base::Ok{};
  const Answer answer = ask_for_each(question);
  all_ = answer == Answer::kAll;
  quit_ = answer == Answer::kQuit;
  if (answer == Answer::kYes || all_) return base::Ok{};
  return base::Error{base::Refusal::kBusy, otherwise};
}

FleetRow FleetTalk::ended(FleetRow row, FleetOutcome outcome, const base::Error& why) const {
  row.outcome = outcome;
  row.why = why;
  say(std::string("not done: ") + base::refusal_code(why.refusal) + ": " + why.text + "\n");
  return row;
}

FleetRow FleetTalk::failed(FleetRow row, const base::Error& why) const {
  const bool gone = why.refusal == base::Refusal::kNotRunning;
  return ended(std::move(row), gone ? FleetOutcome::kUnreachable : FleetOutcome::kRefused, why);
}

std::optional<FleetSeen> see(const FleetAccess& access, const FleetTalk& talk,
                             const FleetMember& member, FleetRow& row, bool waits) {
  base::Result<ControllerClient> client = access.connect(member);
  if (!client.ok()) {
    row = talk.ended(std::move(row), FleetOutcome::kUnreachable, client.error());
    return std::nullopt;
  }
  const auto lost = [&](const base::Error& why) {
    row = talk.failed(std::move(row), why);
    return std::nullopt;
  };
  base::Status waited = waits ? wait_for_others(*client) : base::Status(base::Ok{});
  if (!waited.ok()) return lost(waited.error());
  base::Result<vm::StatusReport> status = client->status();
  if (!status.ok()) return lost(status.error());
  base::Result<base::Bytes> running = client->image();
  if (!running.ok()) return lost(running.error());
  base::Result<ir::VerifiedImage> image = ir::verify(*running);
  if (!image.ok()) return lost(image.error());
  row.from = image->digest();
  row.program = image->image().name;
  talk.say(row.program + " (" + base::short_hex(row.from) + ")\n");
  return FleetSeen{std::move(*client), std::move(*running), std::move(*image)};
}

FleetVisit::FleetVisit(const FleetEdit& edit, SwitchOptions how, FleetAccess access,
                       const char* question, const char* otherwise)
    : edit_(edit), how_(std::move(how)), access_(std::move(access)), talk_(how_.json) {
  how_.confirm = [this, question, otherwise] { return talk_.ask(question, otherwise); };
}

FleetRow FleetVisit::not_done(FleetRow row, const base::Result<Outcome>& outcome) const {
  const base::Error& why = *why_not(outcome);
  const bool said_no = why.refusal == base::Refusal::kBusy && outcome.ok() && how_.ask;
  if (said_no) return talk_.ended(std::move(row), FleetOutcome::kCancelled, why);
  if (why.refusal != base::Refusal::kNotRunning) return talk_.failed(std::move(row), why);
  return talk_.failed(std::move(row),
                      {why.refusal, why.text + "; `stvm edits` there says if it is done"});
}

base::Status check_parts(const FleetEdit& edit, const ir::VerifiedImage& image, FleetRow& row) {
  row.table = tools::own_table_edits(edit.parts, image.image());
  return check_parts(edit, edit.parts.of(image.image()),
                     online_change::check_table(row.table, "its own table"), row);
}

base::Status check_parts(const FleetEdit& edit, const std::vector<ir::Part>& here,
                         const base::Status& table, FleetRow& row) {
  row.parts = ir::part_edits(edit.parts.original, edit.parts.edited, here);
  bool all = true;
  bool any = false;
  std::string others;
  for (const ir::PartEdit& part : row.parts) {
    all = all && part.state == ir::PartState::kHasIt;
    const bool fits = part.state == ir::PartState::kOk || part.state == ir::PartState::kHasIt;
    any = any || fits;
    if (fits) continue;
    others += (others.empty() ? "" : ", ") + part.name + " is " +
              std::string(tools::part_state_name(part.state));
  }
  row.outcome = all ? FleetOutcome::kHadIt : FleetOutcome::kPossible;
  const bool fit = others.empty() || (edit.matching && any);
  if (fit) return all ? base::Status(base::Ok{}) : table;
  if (!table.ok()) others += "; " + table.error().text;
  return base::Error{base::Refusal::kOtherPart, others};
}

FleetRow look_at(const FleetEdit* edit, const FleetAccess& access, const FleetTalk& talk,
                 const FleetMember& member) {
  if (is_at_agent(member)) return access.agents->look_at(edit, talk, member);
  FleetRow row = talk.begin(member);
  std::optional<FleetSeen> seen = see(access, talk, member, row);
  if (!seen) return row;
  row.has = ir::parts_of(seen->image.image());
  row.outcome = FleetOutcome::kReached;
  if (edit == nullptr) return row;
  base::Status fits = check_parts(*edit, seen->image, row);
  return fits.ok() ? row : talk.ended(std::move(row), FleetOutcome::kRefused, fits.error());
}

}  // namespace stvm
