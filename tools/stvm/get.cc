// stvm get: values of variables, all of one boundary; or the list of variables.
#include <cstdio>

#include "tools/common/exit.h"
#include "tools/common/json.h"
#include "tools/stvm/commands.h"
#include "tools/stvm/controller_client.h"
#include "tools/stvm/names.h"
#include "tools/stvm/values.h"

namespace stvm {
namespace {

constexpr tools::OptionRow kGetOptions[] = {
    {"--list", nullptr, "list variables and their types; NAMES are patterns with * and ?", "",
     "--forces"},
    {"--forces", nullptr, "list forced variables, and whether they hold everywhere"},
    STVM_CONTROLLER_OPTIONS,
    STVM_FORMAT_OPTION,
};
constexpr tools::Command kGetCommand{"get", "NAMES...", "Shows values of variables.", kGetOptions};

void print_list(const vm::Values& values, bool json) {
  if (!json) {
    for (const vm::ValueRow& row : values.rows) {
      std::printf("%s : %s\n", row.path.c_str(), row.type.c_str());
    }
    return;
  }
  tools::JsonWriter out;
  out.begin_array();
  for (const vm::ValueRow& row : values.rows) {
    out.begin_object().field("path", row.path).field("type", row.type).end_object();
  }
  out.end_array();
  std::fputs(out.finish().c_str(), stdout);
}

base::Status list(const tools::Options& options, ControllerClient& client, bool json) {
  std::vector<std::string> patterns = options.arguments();
  if (patterns.empty()) patterns = {"*"};
  vm::Values all;
  for (const std::string& pattern : patterns) {
    base::Result<vm::Values> values = client.list(pattern);
    if (!values.ok()) return values.error();
    std::move(values->rows.begin(), values->rows.end(), std::back_inserter(all.rows));
  }
  print_list(all, json);
  return base::Ok{};
}

base::Status show_values(const tools::Options& options) {
  const bool json = wants_json(options);
  bool whole = options.has("--list") || options.has("--forces");
  if (options.arguments().empty() && !whole) {
    return base::Error{base::Refusal::kUsage, "get: needs NAMES, or --list"};
  }
  base::Result<ControllerClient> client = ControllerClient::connect(options);
  if (!client.ok()) return client.error();
  if (options.has("--list")) return list(options, *client, json);
  if (options.has("--forces")) {
    base::Result<vm::ForceRows> forces = client->forces();
    if (!forces.ok()) return forces.error();
    std::fputs((json ? forces_json(*forces) : forces_text(*forces)).c_str(), stdout);
    return base::Ok{};
  }
  base::Result<Names> names = matching(*client, options.arguments());
  if (!names.ok()) return names.error();
  base::Result<vm::Values> values = client->get(std::move(*names));
  if (!values.ok()) return values.error();
  std::fputs((json ? values_json(*values) : values_text(*values)).c_str(), stdout);
  if (!json && values->last_cycle != values->cycle) {
    std::fprintf(stderr,
                 "note: too much for one boundary: these are values of cycles %llu to %llu\n",
                 static_cast<unsigned long long>(values->cycle),
                 static_cast<unsigned long long>(values->last_cycle));
  }
  return base::Ok{};
}

int run_get(const tools::Options& options) {
  base::Status shown = show_values(options);
  return shown.ok() ? tools::kOk : refuse(shown.error());
}

}  // namespace

const Entry kGet{&kGetCommand, run_get};

}  // namespace stvm
