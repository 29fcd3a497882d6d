// stvm edits: what is on trial, oldest first; each edit with what it touches.
#include <algorithm>
#include <cstdio>

#include "tools/common/exit.h"
#include "tools/common/json.h"
#include "tools/stvm/commands.h"
#include "tools/stvm/controller_client.h"
#include "tools/stvm/controller_service.h"

namespace stvm {
namespace {

constexpr tools::OptionRow kEditsOptions[] = {STVM_CONTROLLER_OPTIONS, STVM_FORMAT_OPTION};
constexpr tools::Command kEditsCommand{
    "edits",       "", "Shows the edits on trial, newest last, and those that redo brings again.",
    kEditsOptions, 0,  0};

constexpr size_t kColumns = 80;

// "  POUs       Main (body), Pump (added)", wrapped below its first word.
class Line {
 public:
  explicit Line(const char* title) : text_(std::string("  ") + title) {
    text_.resize(kIndent, ' ');
    column_ = kIndent;
  }
  void add(const std::string& item) {
    const bool first = !any_;
    if (!first) text_ += ",";
    if (!first && column_ + 2 + item.size() > kColumns - 1) {
      text_ += "\n" + std::string(kIndent, ' ');
      column_ = kIndent;
    } else if (!first) {
      text_ += " ";
      column_ += 2;
    }
    text_ += item;
    column_ += item.size();
    any_ = true;
  }
  void rest(uint64_t count, size_t shown) {
    if (count > shown) add(std::to_string(count - shown) + " more");
  }
  void print() const {
    if (any_) std::printf("%s\n", text_.c_str());
  }

 private:
  static constexpr size_t kIndent = 13;
  std::string text_;
  size_t column_ = 0;
  bool any_ = false;
};

void print_text(const TrialEdit& edit) {
  std::printf("%s%s  %s  cycle %llu%s%s\n", edit.name.c_str(), edit.undone ? "  undone" : "",
              time_text(edit.time_ns).c_str(), static_cast<unsigned long long>(edit.cycle),
              edit.who.empty() ? "" : "  by ", edit.who.c_str());
  std::printf("  program    %s -> %s\n", base::short_hex(edit.from).c_str(),
              base::short_hex(edit.to).c_str());
  Line pous("POUs");
  for (const auto& pou : edit.pous) {
    pous.add(pou.pou + " (" + online_change::pou_change_name(pou.change) + ")");
  }
  pous.rest(edit.pou_count, edit.pous.size());
  pous.print();
  Line types("types");
  for (const auto& type : edit.types) {
    types.add(type.type + " (" + online_change::type_change_name(type.change) + ")");
  }
  types.rest(edit.type_count, edit.types.size());
  types.print();
  Line variables("variables");
  for (const online_change::FateRow& row : edit.variables) {
    const std::string what = online_change::is_renamed(row)
                                 ? row.reason.substr(0, row.reason.find_first_of(",;"))
                                 : online_change::fate_name(row.fate);
    variables.add(row.path + " (" + what + ")");
  }
  variables.rest(edit.variable_count, edit.variables.size());
  variables.print();
}

void edit_json(tools::JsonWriter& json, const TrialEdit& edit) {
  json.begin_object().field("name", edit.name).field("undone", edit.undone);
  json.field("from", base::to_hex(edit.from));
  json.field("to", base::to_hex(edit.to)).field("time", time_text(edit.time_ns));
  json.field("cycle", edit.cycle).field("by", edit.who);
  json.field("pou_count", edit.pou_count).key("pous").begin_array();
  for (const auto& pou : edit.pous) {
    json.begin_object().field("pou", pou.pou);
    json.field("change", online_change::pou_change_name(pou.change));
    json.field("instances", pou.instances).field("what", pou.what).end_object();
  }
  json.end_array().field("type_count", edit.type_count).key("types").begin_array();
  for (const auto& type : edit.types) {
    json.begin_object().field("type", type.type);
    json.field("change", online_change::type_change_name(type.change)).end_object();
  }
  json.end_array().field("variable_count", edit.variable_count).key("variables").begin_array();
  for (const online_change::FateRow& row : edit.variables) {
    json.begin_object().field("variable", row.path);
    json.field("fate", online_change::fate_name(row.fate));
    json.field("old_type", row.old_type).field("new_type", row.new_type);
    json.field("count", row.count).field("reason", row.reason).end_object();
  }
  json.end_array().end_object();
}

base::Status show_edits(const tools::Options& options) {
  base::Result<bool> json = wants_json(options);
  if (!json.ok()) return json.error();
  base::Result<ControllerClient> client = ControllerClient::connect(options);
  if (!client.ok()) return client.error();
  base::Result<std::vector<TrialEdit>> edits = client->edits();
  if (!edits.ok()) return edits.error();
  if (!*json) {
    const bool any = std::any_of(edits->begin(), edits->end(),
                                 [](const TrialEdit& edit) { return !edit.undone; });
    if (!any) std::puts("no edit is on trial");
    for (const TrialEdit& edit : *edits) print_text(edit);
    return base::Ok{};
  }
  tools::JsonWriter out;
  out.begin_object().key("edits").begin_array();
  for (const TrialEdit& edit : *edits) edit_json(out, edit);
  out.end_array().end_object();
  std::fputs(out.finish().c_str(), stdout);
  return base::Ok{};
}

int run_edits(const tools::Options& options) {
  base::Status shown = show_edits(options);
  return shown.ok() ? tools::kOk : refuse(shown.error());
}

}  // namespace

const Entry kEdits{&kEditsCommand, run_edits};

}  // namespace stvm
