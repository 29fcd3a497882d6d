#include "tools/stc/online_edits.h"

#include "online_change/plan/online_limits.h"
#include "tools/common/json.h"
#include "tools/common/table.h"

namespace stc {
namespace {

using online_change::EditKind;
using online_change::EditRule;

struct EditRow {
  EditKind kind;
  const char* name;
  EditRule rule;
  const char* what;
  const char* remark;
};
constexpr EditRow kEdits[] = {
#define ONLINE_EDIT(id, name, rule, what, remark) \
  {EditKind::id, name, EditRule::rule, what, remark},
#include "online_change/plan/online_edits.def"
#undef ONLINE_EDIT
};

online_change::ChosenLimits limits_for(const std::vector<std::string>& targets) {
  return online_change::chosen_limits(online_change::online_limits(), targets);
}

const char* rule_name(EditRule rule) {
  if (rule == EditRule::kTable) return "table";
  return rule == EditRule::kInterface ? "interface" : "";
}

const char* way_out(EditRule rule) {
  if (rule == EditRule::kTable) return "with --table free";
  return rule == EditRule::kInterface ? "without --restricted" : "yes";
}

}  // namespace

std::string online_edits_page(const std::vector<std::string>& targets, uint32_t width) {
  const online_change::ChosenLimits chosen = limits_for(targets);
  tools::Table table({"edit", "online", "what", "and"});
  for (const EditRow& row : kEdits) {
    table.row(
        {row.name, chosen.limits.takes(row.kind) ? way_out(row.rule) : "no", row.what, row.remark});
  }
  return "limits are " + chosen.text + "; formats of images from " +
         std::to_string(chosen.limits.first_format) + " to " +
         std::to_string(chosen.limits.last_format) + "\n\n" + table.text(width);
}

std::string online_edits_json(const std::vector<std::string>& targets) {
  const online_change::ChosenLimits chosen = limits_for(targets);
  tools::JsonWriter json;
  json.begin_object().field("limits", chosen.text);
  json.field("first_format", chosen.limits.first_format);
  json.field("last_format", chosen.limits.last_format).key("edits").begin_array();
  for (const EditRow& row : kEdits) {
    json.begin_object().field("edit", row.name).field("what", row.what);
    json.field("online", chosen.limits.takes(row.kind)).field("rule", rule_name(row.rule));
    json.field("remark", row.remark).end_object();
  }
  json.end_array().end_object();
  return json.finish();
}

}  // namespace stc
