#include "online_change/plan/system_edits.h"

#include <algorithm>
#include <iterator>
#include <map>

#include "ir/bytecode/located_layouts.h"
#include "ir/program/task_policy.h"
#include "ir/types/address_text.h"
#include "ir/types/location.h"
#include "ir/types/value_text.h"
#include "online_change/diff/areas.h"
#include "online_change/diff/fates.h"
#include "online_change/diff/instance_match.h"

namespace online_change {
namespace {

const std::string kNoTaskNow = "none: it runs only where others call it";

std::string from_to(const std::string& before, const std::string& after) {
  return before + " -> " + after;
}

class SystemEdits {
 public:
  SystemEdits(const ir::Image& old_image, const ir::Image& new_image)
      : old_(old_image),
        new_(new_image),
        same_instances_(old_image.types.is_one_with(new_image.types) &&
                        old_image.instances.is_one_with(new_image.instances)) {}

  std::vector<SystemEdit> run() {
    attributes();
    addresses();
    schedule();
    tasks();
    programs();
    safe_outputs();
    std::ranges::move(device_edits(old_, new_), std::back_inserter(rows_));
    std::ranges::move(chart_edits(old_, new_), std::back_inserter(rows_));
    return std::move(rows_);
  }

 private:
  void add(const char* kind, std::string name, std::string what) {
    rows_.push_back({kind, std::move(name), std::move(what)});
  }

  // RETAIN and CONSTANT belong to types, so the first instance of each stands for all, and says how
  // many there are.
  void attributes() {
    if (same_instances_) return;
    match_ = match_instances(old_, new_);
    std::map<std::pair<uint32_t, uint32_t>, uint64_t> instances;  // by types
    std::vector<uint32_t> first;
    for (const uint32_t id : match_.new_order) {
      const uint32_t twin = match_.old_of_new[id];
      if (twin == kNoInstance) continue;
      if (instances[types_of(id)]++ == 0) first.push_back(id);
    }
    for (const uint32_t id : first) attributes_of(id, instances[types_of(id)] - 1);
  }
  std::pair<uint32_t, uint32_t> types_of(uint32_t id) const {
    return {old_.instances[match_.old_of_new[id]].type.index, new_.instances[id].type.index};
  }
  void attributes_of(uint32_t id, uint64_t more) {
    const auto [before, after] = types_of(id);
    std::map<std::string, const ir::Member*> old_members;
    for (const ir::Member& member : old_.types[ir::TypeId(before)].members) {
      old_members[ir::fold_name(member.name)] = &member;
    }
    const std::string owner = new_.instance_path(id);
    for (const ir::Member& member : new_.types[ir::TypeId(after)].members) {
      const auto found = old_members.find(ir::fold_name(member.name));
      if (found == old_members.end()) continue;
      const std::string path = owner.empty() ? member.name : owner + "." + member.name;
      told(path, more, found->second->retain, member.retain, "RETAIN");
      told(path, more, found->second->constant, member.constant, "CONSTANT");
    }
  }
  void told(const std::string& path, uint64_t more, bool was, bool is, const char* attribute) {
    if (was == is) return;
    std::string what = (is ? "now " : "no longer ") + std::string(attribute);
    if (more != 0) what += "; and " + std::to_string(more) + std::string(kMoreLikeIt);
    add("variable", path, std::move(what));
  }

  // By path: what is at an address in only one version may be elsewhere in the other, or nowhere.
  void addresses() {
    if (same_instances_ && old_.layouts.is_one_with(new_.layouts) && old_.globals == new_.globals &&
        old_.io == new_.io) {
      return;
    }
    old_natural_ = ir::located_layouts(old_);
    new_natural_ = ir::located_layouts(new_);
    const std::map<std::string, const ir::IoBinding*> before = bindings(old_);
    const std::map<std::string, const ir::IoBinding*> after = bindings(new_);
    const Ranges outputs = outputs_after();
    for (const auto& [path, binding] : before) {
      const auto found = after.find(path);
      const ir::IoBinding* now = found == after.end() ? nullptr : found->second;
      if (now != nullptr && now->address == binding->address) continue;
      std::string what = from_to(ir::address_text(binding->address),
                                 now == nullptr ? "no address" : ir::address_text(now->address));
      if (is_left(*binding, outputs)) {
        what += "; " + ir::address_text(binding->address) + " is no longer written by any code";
      }
      add("variable", path, std::move(what));
    }
    for (const auto& [path, binding] : after) {
      if (before.contains(path)) continue;
      add("variable", path, from_to("no address", ir::address_text(binding->address)));
    }
  }
  static std::map<std::string, const ir::IoBinding*> bindings(const ir::Image& image) {
    const Areas areas(image);
    std::map<std::string, const ir::IoBinding*> out;
    for (const ir::IoBinding& row : image.io) out[areas.path_at(row.data)] = &row;
    return out;
  }
  // Outputs of the new version, as sorted ranges of bits that do not touch.
  using Ranges = std::map<uint64_t, uint64_t>;  // end by begin
  Ranges outputs_after() const {
    std::vector<std::pair<uint64_t, uint64_t>> all;
    for (const ir::IoBinding& row : new_.io) {
      if (row.address.area != ir::DirectArea::kOutput) continue;
      all.push_back({row.address.bit_offset, end_of(new_, new_natural_, row)});
    }
    std::sort(all.begin(), all.end());
    Ranges out;
    for (const auto& [begin, end] : all) {
      if (!out.empty() && begin <= out.rbegin()->second) {
        out.rbegin()->second = std::max(out.rbegin()->second, end);
      } else {
        out.emplace_hint(out.end(), begin, end);
      }
    }
    return out;
  }
  // Does nothing of the new version write there?
  bool is_left(const ir::IoBinding& binding, const Ranges& outputs) const {
    if (binding.address.area != ir::DirectArea::kOutput) return false;
    const auto after = outputs.lower_bound(end_of(old_, old_natural_, binding));
    return after == outputs.begin() || std::prev(after)->second <= binding.address.bit_offset;
  }
  // A located array or structure takes more bits than its address says.
  static uint64_t end_of(const ir::Image& image, const ir::Layouts& natural,
                         const ir::IoBinding& row) {
    return row.address.bit_offset + ir::located_bits(image.types, natural, row.type, row.address);
  }

  void schedule() {
    if (old_.schedule == new_.schedule) return;
    add("resource", new_.name,
        "schedule " + from_to(std::string(ir::schedule_text(old_.schedule)),
                              std::string(ir::schedule_text(new_.schedule))));
  }

  void tasks() {
    for (const ir::ImageTask& task : new_.tasks) {
      if (task.once) continue;
      if (const ir::ImageTask* before = task_of(old_, task.name)) {
        compare(*before, task);
      } else {
        add("task", task.name, "new, " + interval(task) + ", priority " + number(task.priority));
      }
    }
    for (const ir::ImageTask& task : old_.tasks) {
      if (!task.once && task_of(new_, task.name) == nullptr) add("task", task.name, "removed");
    }
  }
  void compare(const ir::ImageTask& before, const ir::ImageTask& after) {
    const auto told = [&](const char* what, const std::string& was, const std::string& is) {
      if (was != is) add("task", after.name, what + from_to(was, is));
    };
    told("interval ", interval(before), interval(after));
    told("priority ", number(before.priority), number(after.priority));
    told("watchdog ", watchdog(before), watchdog(after));
    told("policy ", policy(before), policy(after));
  }
  static std::string number(uint32_t value) { return std::to_string(value); }
  static std::string interval(const ir::ImageTask& task) {
    if (task.period_ns != 0) return ir::duration_text(task.period_ns);
    return task.event != 0 ? "by event" : "none";
  }
  static std::string watchdog(const ir::ImageTask& task) {
    return task.watchdog_ns == 0 ? "none" : ir::duration_text(task.watchdog_ns);
  }
  static std::string policy(const ir::ImageTask& task) {
    const std::string text = ir::policy_text(task.policy);
    return text.empty() ? "none" : text.substr(1);
  }
  static const ir::ImageTask* task_of(const ir::Image& image, const std::string& name) {
    for (const ir::ImageTask& task : image.tasks) {
      if (!task.once && ir::same_name(task.name, name)) return &task;
    }
    return nullptr;
  }

  // Programs in both versions that another task runs, or none, or in another order.
  void programs() {
    const std::map<std::string, std::string> before = tasks_by_program(old_);
    const std::map<std::string, std::string> after = tasks_by_program(new_);
    const std::map<std::string, std::string> were = program_names(old_);
    for (const auto& [folded, name] : program_names(new_)) {
      if (!were.contains(folded)) continue;
      const std::string* const was = find(before, folded);
      const std::string* const is = find(after, folded);
      if (was == nullptr ? is == nullptr : is != nullptr && ir::same_name(*was, *is)) continue;
      add("program", name, "task " + from_to(was ? *was : "none", is ? *is : kNoTaskNow));
    }
    for (const ir::ImageTask& task : new_.tasks) {
      const ir::ImageTask* twin = task_of(old_, task.name);
      if (twin == nullptr || task.once) continue;
      const std::string was = order(old_, *twin, after, task.name);
      const std::string is = order(new_, task, before, task.name);
      if (was != is) add("task", task.name, "order " + from_to(was, is));
    }
  }
  static const std::string* find(const std::map<std::string, std::string>& in,
                                 const std::string& key) {
    const auto found = in.find(key);
    return found == in.end() ? nullptr : &found->second;
  }
  static std::map<std::string, std::string> program_names(const ir::Image& image) {
    std::map<std::string, std::string> out;
    for (const uint32_t id : image.program_ids()) {
      out.emplace(ir::fold_name(image.instances[id].name), image.instances[id].name);
    }
    return out;
  }
  static std::map<std::string, std::string> tasks_by_program(const ir::Image& image) {
    std::map<std::string, std::string> out;
    for (const ir::ImageTask& task : image.tasks) {
      if (task.once) continue;
      for (const uint32_t id : task.programs) {
        out[ir::fold_name(image.instance_path(id))] = task.name;
      }
    }
    return out;
  }
  // The order of those programs that the task runs in the other version, too.
  static std::string order(const ir::Image& image, const ir::ImageTask& task,
                           const std::map<std::string, std::string>& other,
                           const std::string& name) {
    std::string out;
    for (const uint32_t id : task.programs) {
      const std::string path = image.instance_path(id);
      const auto found = other.find(ir::fold_name(path));
      if (found == other.end() || !ir::same_name(found->second, name)) continue;
      out += (out.empty() ? "" : ", ") + path;
    }
    return out;
  }

  void safe_outputs() {
    const std::map<std::string, std::string> before = safe_of(old_);
    const std::map<std::string, std::string> after = safe_of(new_);
    for (const auto& [output, value] : before) {
      const auto found = after.find(output);
      const std::string now = found == after.end() ? "0" : found->second;
      if (now != value) add("output", output, "safe value " + from_to(value, now));
    }
    for (const auto& [output, value] : after) {
      if (!before.contains(output) && value != "0") {
        add("output", output, "safe value " + from_to("0", value));
      }
    }
  }
  static std::map<std::string, std::string> safe_of(const ir::Image& image) {
    std::map<std::string, std::string> out;
    for (const ir::SafeOutput& row : image.safe) {
      const ir::DirectAddress address{ir::DirectArea::kOutput, row.bit_offset, row.bits};
      std::string value = std::to_string(row.value);
      if (row.kind == ir::SafeKind::kHold) value = "held";
      if (row.kind == ir::SafeKind::kHoldThenValue) {
        value = "held for " + ir::duration_text(row.hold_ns) + ", then " + value;
      }
      out[ir::address_text(address)] = value;
    }
    return out;
  }

  const ir::Image& old_;
  const ir::Image& new_;
  const bool same_instances_;  // known without a look at them
  ir::Layouts old_natural_;    // of addresses()
  ir::Layouts new_natural_;
  InstanceMatch match_;  // of attributes()
  std::vector<SystemEdit> rows_;
};

}  // namespace

std::vector<SystemEdit> system_edits(const ir::Image& old_image, const ir::Image& new_image) {
  return SystemEdits(old_image, new_image).run();
}

}  // namespace online_change
