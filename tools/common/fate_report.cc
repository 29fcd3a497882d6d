#include "tools/common/fate_report.h"

#include <cstdio>

#include "base/visible_text.h"
#include "base/wrapped.h"
#include "ir/bytecode/renames.h"
#include "tools/common/live_key.h"
#include "tools/common/old_names.h"
#include "tools/common/table.h"

namespace tools {
namespace {

using online_change::Fate;
using online_change::FateRow;
using online_change::PouChange;
using online_change::PouEdit;

constexpr size_t kWidth = 80;
constexpr size_t kNamedFollowers = 8;

struct CountColumn {
  const char* name;
  uint64_t online_change::FateCounts::*field;
};
constexpr CountColumn kCounts[] = {
    {"kept", &online_change::FateCounts::kept},
    {"moved", &online_change::FateCounts::moved},
    {"converted", &online_change::FateCounts::converted},
    {"initialised", &online_change::FateCounts::initialised},
    {"dropped", &online_change::FateCounts::dropped},
};

std::string type_change(const FateRow& row) {
  if (row.old_type == row.new_type) return row.new_type;
  if (row.old_type.empty()) return row.new_type;
  if (row.new_type.empty()) return row.old_type;
  return row.old_type + " -> " + row.new_type;
}

std::string value_change(const FateRow& row, const LiveValue& value) {
  std::string text = value.now;
  if (text.empty()) {
    text = ":= " + value.after;
  } else if (!value.after.empty() && value.after != value.now) {
    text += " -> " + value.after;
  }
  if (!value.loss.empty() && row.fate != Fate::kDropped) text += " LOSS: " + value.loss;
  return text;
}

// "converted      LineStops : INT -> DINT", and after it or below, whatever fits in
// 80 columns, live value and reason.
std::string row_text(const FateRow& row, std::string rest) {
  std::string text = online_change::fate_name(row.fate);
  text.resize(12, ' ');
  if (row.count > 1) text += "x" + std::to_string(row.count);
  text.resize(std::max<size_t>(text.size() + 1, 19), ' ');
  text += row.path;
  if (std::string type = type_change(row); !type.empty()) text += " : " + type;
  if (!row.reason.empty()) rest += (rest.empty() ? "(" : "  (") + row.reason + ")";
  if (rest.empty()) return text + "\n";
  if (text.size() + 2 + rest.size() <= kWidth) return text + "  " + rest + "\n";
  text += "\n";
  for (const std::string& line : base::wrapped(rest, kWidth - 21)) {
    text += std::string(21, ' ') + line + "\n";
  }
  return text;
}

std::string row_text(const FateRow& row, const LiveValues& live) {
  auto found = live.find(live_key(row));
  if (found != live.end()) return row_text(row, value_change(row, found->second));
  return row_text(row, std::string(row.may_lose && row.fate != Fate::kDropped ? "may lose" : ""));
}

// "at 1234", "1234 -> 1300".
std::string address_text(const FateLine& line) {
  if (line.old_address == 0 || line.new_address == line.old_address) {
    return "at " + std::to_string(line.new_address);
  }
  if (line.new_address == 0) return "was at " + std::to_string(line.old_address);
  return std::to_string(line.old_address) + " -> " + std::to_string(line.new_address);
}

// In the same line where it fits; else below.
std::string with_remark(std::string text, const std::string& remark) {
  if (text.size() + 2 + remark.size() <= kWidth) return text + "  " + remark + "\n";
  text += "\n";
  for (const std::string& line : base::wrapped(remark, kWidth - 21)) {
    text += std::string(21, ' ') + line + "\n";
  }
  return text;
}

// "code               Motor  (body; 3 instances keep their values: outputs may jump)"
std::string edit_text(const PouEdit& edit) {
  std::string text = "code";
  text.resize(19, ' ');
  text += edit.pou;
  std::string rest = std::string("(") + online_change::pou_change_name(edit.change);
  if (!edit.what.empty()) rest += ": " + edit.what;
  if (edit.instances != 0) {
    rest += "; " + std::to_string(edit.instances) +
            (edit.instances == 1 ? " instance keeps its" : " instances keep their") +
            " values: outputs may jump";
  }
  return with_remark(std::move(text), rest + ")");
}

// "code               2 others  (compiled anew, their text is the same: Main, Fill)": code that
// they take in, a type or a constant is another one.
std::string following_text(const PouEdits& edits) {
  size_t count = 0;
  std::string names;
  for (const PouEdit& edit : edits) {
    if (edit.change != PouChange::kFollows) continue;
    if (count++ < kNamedFollowers) names += (names.empty() ? "" : ", ") + edit.pou;
  }
  if (count == 0) return {};
  if (count > kNamedFollowers) names += ", ...";
  std::string text = "code";
  text.resize(19, ' ');
  text += std::to_string(count) + (count == 1 ? " other" : " others");
  return with_remark(std::move(text), "(compiled anew, their text is the same: " + names + ")");
}

}  // namespace

std::string duration(int64_t ns) {
  static constexpr struct {
    int64_t unit;
    const char* name;
  } kUnits[] = {{1'000'000'000, "s"}, {1'000'000, "ms"}, {1'000, "us"}};
  char text[32];
  for (auto [unit, name] : kUnits) {
    if (ns < unit) continue;
    std::snprintf(text, sizeof text, "%.3g %s", static_cast<double>(ns) / static_cast<double>(unit),
                  name);
    return text;
  }
  std::snprintf(text, sizeof text, "%lld ns", static_cast<long long>(ns));
  return text;
}

std::string fate_report(const online_change::Plan& plan, const LiveValues& live,
                        const PouEdits& edits, const SystemEdits& system) {
  std::string out;
  Table counts({"fate", "> variables"});
  for (auto [name, field] : kCounts) counts.row({name, std::to_string(plan.counts.*field)});
  out += counts.text() + "\n";
  for (const FateRow& row : plan.fates) {
    if (row.fate != Fate::kKept || !row.reason.empty()) out += row_text(row, live);
  }
  for (const PouEdit& edit : edits) {
    if (edit.change != PouChange::kFollows) out += edit_text(edit);
  }
  out += following_text(edits);
  for (const online_change::SystemEdit& edit : system) {
    out += edit.kind + std::string(19 - std::min<size_t>(edit.kind.size(), 18), ' ') + edit.name +
           "  (" + edit.what + ")\n";
  }
  out += "\npredicted pause " + duration(plan.predicted_pause_ns) + " (" +
         std::to_string(plan.boundary_bytes) + " bytes written at the boundary)\n";
  return base::visible_lines(out);  // names of an image that somebody sent
}

void fate_report(const online_change::Plan& plan, const LiveValues& live, const PouEdits& edits,
                 const SystemEdits& system, JsonWriter& json) {
  json.key("counts").begin_object();
  for (auto [name, field] : kCounts) json.field(name, plan.counts.*field);
  json.end_object();
  json.field("predicted_pause_ns", plan.predicted_pause_ns);
  json.field("boundary_bytes", plan.boundary_bytes);
  json.key("fates").begin_array();
  for (const FateRow& row : plan.fates) {
    json.begin_object();
    json.field("variable", row.path).field("fate", online_change::fate_name(row.fate));
    json.field("count", row.count).field("old_type", row.old_type).field("new_type", row.new_type);
    json.field("may_lose", row.may_lose).field("reason", row.reason);
    if (auto found = live.find(live_key(row)); found != live.end()) {
      json.field("live", found->second.now).field("after", found->second.after);
      json.field("loss", found->second.loss);
    }
    json.end_object();
  }
  json.end_array().key("code").begin_array();
  for (const PouEdit& edit : edits) {
    json.begin_object().field("pou", edit.pou);
    json.field("change", online_change::pou_change_name(edit.change));
    json.field("instances", edit.instances).field("what", edit.what).end_object();
  }
  json.end_array().key("system").begin_array();
  for (const online_change::SystemEdit& edit : system) {
    json.begin_object().field("kind", edit.kind).field("name", edit.name);
    json.field("what", edit.what).end_object();
  }
  json.end_array();
}

std::string every_fate_text(std::span<const FateLine> lines) {
  std::string out;
  for (const FateLine& line : lines) {
    FateRow row = line.row;
    std::string why = address_text(line);
    if (!row.old_path.empty()) why += "; was `" + row.old_path + "`";
    if (!row.reason.empty()) why += "; " + row.reason;
    row.reason = std::move(why);
    const bool told = !line.live.now.empty() || !line.live.after.empty();
    out += row_text(row, told ? value_change(row, line.live) : std::string());
  }
  return base::visible_lines(out);
}

void every_fate(std::span<const FateLine> lines, JsonWriter& json) {
  json.key("variables").begin_array();
  for (const FateLine& line : lines) {
    json.begin_object().field("variable", line.row.path);
    json.field("fate", online_change::fate_name(line.row.fate));
    if (!line.row.old_path.empty()) json.field("old_variable", line.row.old_path);
    if (line.old_address != 0) json.field("old_address", line.old_address);
    if (line.new_address != 0) json.field("new_address", line.new_address);
    json.field("old_type", line.row.old_type).field("new_type", line.row.new_type);
    json.field("live", line.live.now).field("after", line.live.after);
    json.field("loss", line.live.loss).field("reason", line.row.reason).end_object();
  }
  json.end_array();
}

std::vector<FateLine> every_line(const online_change::Plan& plan, const ir::Image& old_image,
                                 const ir::Image& new_image) {
  std::vector<FateLine> lines;
  const ir::OldUnderNewNames renamed(old_image, new_image);
  const ir::Image& before = renamed.image();
  const online_change::EveryFate every(plan, before, new_image);
  const OldNames old_names(old_image, before);
  every.visit_from(0, [&](const online_change::VariableFate& variable) {
    lines.push_back(every_line(variable, before, new_image));
    old_names.tell(lines.back());
    return true;
  });
  return lines;
}

FateLine every_line(const online_change::VariableFate& variable, const ir::Image& old_image,
                    const ir::Image& new_image) {
  FateLine out;
  out.row.fate = variable.fate;
  out.row.path = variable.path;
  out.row.old_path = variable.old_path;
  out.row.reason = variable.reason;
  out.row.may_lose = variable.loses;
  out.old_address = variable.old_address;
  out.new_address = variable.new_address;
  if (variable.old_address != 0) out.row.old_type = old_image.types.text(variable.old_type);
  if (variable.new_address != 0) out.row.new_type = new_image.types.text(variable.new_type);
  return out;
}

}  // namespace tools
