// A plan as people and programs see it (X6-09).
#include <algorithm>

#include "base/joined.h"
#include "tools/common/exit.h"
#include "tools/common/table.h"
#include "tools/stvm/controller_service.h"
#include "tools/stvm/fleet_plan.h"

namespace stvm {
namespace {

std::string whole_seconds(int64_t ms) {
  return roll_time_text(std::max<int64_t>(ms, 0) / 1000 * 1000);
}

// "wave 2: the soak ends in 25s"
std::string next_event(const RollPlan& plan, int64_t now_ms) {
  if (is_over(plan.phase)) return "nothing more";
  if (plan.phase != RollPhase::kRunning) return "the edit is taken back";
  const Wave& wave = plan.settings.waves[plan.wave];
  const std::string name = "wave " + std::to_string(plan.wave + 1) + ": ";
  if (plan.soak_from_ms == 0) return name + "the edit is brought";
  const int64_t left = plan.soak_from_ms + wave.soak_ms - now_ms;
  if (left > 0) return name + "the soak ends in " + whole_seconds(left);
  return name + (wave.accept_at_end ? "the next one begins" : "it is accepted");
}

std::string names_of(const RollPlan& plan, const Wave& wave) {
  constexpr size_t kShown = 6;
  std::string text;
  for (size_t i = 0; i < wave.members.size() && i < kShown; ++i) {
    text += (i == 0 ? "" : ", ") + plan.members[wave.members[i]].member.name;
  }
  if (wave.members.size() > kShown) {
    text += " and " + std::to_string(wave.members.size() - kShown) + " more";
  }
  return text;
}

}  // namespace

std::string plan_outline(const RollPlan& plan) {
  std::string out = base::joined(
      {"plan ", plan.id, " by ", plan.who, ": fleet file ", base::short_hex(plan.digest), "\n"});
  tools::Table table({"wave", "soak", "deadline", "failures", "at once", "accept", "controllers"});
  for (size_t i = 0; i < plan.settings.waves.size(); ++i) {
    const Wave& wave = plan.settings.waves[i];
    table.row({std::to_string(i + 1), roll_time_text(wave.soak_ms),
               roll_time_text(wave.deadline_ms), std::to_string(wave.max_failed),
               std::to_string(wave.parallel), wave.accept_at_end ? "at end" : "after soak",
               names_of(plan, wave)});
  }
  out += table.text();
  for (const Condition& condition : plan.settings.guard.conditions) {
    out += base::joined({"healthy: ", condition.text, "\n"});
  }
  out += plan.settings.undo_all ? "a wave that fails: all waves are taken back\n"
                                : "a wave that fails: that wave is taken back\n";
  out += plan.settings.guard.stop_safe
             ? "where it cannot be taken back: the controller stops, with safe outputs\n"
             : "where it cannot be taken back: it stays, with an alarm\n";
  return out;
}

std::string plan_page(const RollPlan& plan, int64_t now_ms) {
  std::string out = base::joined({"plan ", plan.id, " by ", plan.who, ": ",
                                  roll_phase_name(plan.phase), plan.why.empty() ? "" : ", ",
                                  plan.why, "\nnext: ", next_event(plan, now_ms), "\n\n"});
  tools::Table table({"wave", "controller", "state", "since", "remark"});
  for (size_t wave = 0; wave < plan.settings.waves.size(); ++wave) {
    for (const size_t member : plan.settings.waves[wave].members) {
      const RollMember& row = plan.members[member];
      std::string remark = row.text;
      if (remark.empty() && row.silent_ms != 0) {
        remark = "silent for " + whole_seconds(now_ms - row.silent_ms);
      }
      table.row({std::to_string(wave + 1), row.member.name, std::string(roll_state_name(row.state)),
                 row.since_ms == 0 ? "-" : whole_seconds(now_ms - row.since_ms), remark});
    }
  }
  return out + table.text();
}

std::string plan_json(const RollPlan& plan, int64_t now_ms) {
  tools::JsonWriter json;
  json.begin_object().field("plan", plan.id).field("who", plan.who);
  json.field("file", base::to_hex(plan.digest));
  json.field("phase", std::string(roll_phase_name(plan.phase))).field("why", plan.why);
  json.field("wave", static_cast<uint64_t>(plan.wave + 1));
  json.field("waves", static_cast<uint64_t>(plan.settings.waves.size()));
  json.field("next", next_event(plan, now_ms)).key("controllers").begin_array();
  for (size_t wave = 0; wave < plan.settings.waves.size(); ++wave) {
    for (const size_t member : plan.settings.waves[wave].members) {
      const RollMember& row = plan.members[member];
      json.begin_object().field("controller", row.member.name);
      json.field("wave", static_cast<uint64_t>(wave + 1));
      json.field("state", std::string(roll_state_name(row.state)));
      json.field("since", row.since_ms == 0 ? std::string() : time_text(row.since_ms * 1'000'000));
      json.field("silent", row.silent_ms != 0).field("edit", row.edit).field("text", row.text);
      json.end_object();
    }
  }
  json.end_array().end_object();
  return json.finish();
}

int plan_exit_code(const RollPlan& plan) {
  if (plan.phase != RollPhase::kDone) return tools::kRefused;
  const bool all = std::all_of(plan.members.begin(), plan.members.end(), [](const RollMember& row) {
    return row.state == RollState::kAccepted || row.state == RollState::kHadIt;
  });
  return all ? tools::kOk : tools::kFindings;
}

}  // namespace stvm
