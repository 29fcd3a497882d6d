#include "tests/differential/changes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <set>
#include <optional>
#include <sstream>

#include "ir/program/evaluate.h"
#include "ir/types/handle.h"
#include "ir/types/shared_bytes.h"
#include "ir/types/value_text.h"
#include "online_change/plan/every_fate.h"
#include "tests/differential/compiled.h"
#include "tests/differential/random.h"
#include "tests/differential/rig.h"
#include "tests/golden/runner/evaluator_engine.h"

namespace differential {
namespace {

using Wide = __int128;

bool is_whole(const ir::TypeTable& types, ir::TypeId type) {
  if (!types.is_scalar(type) || types[type].kind == ir::Kind::kEnum) return false;
  ir::Group group = ir::elementary_group(types.root_kind(type));
  return group == ir::Group::kSigned || group == ir::Group::kUnsigned || group == ir::Group::kBit;
}

// What a whole number becomes in another whole type (A14): itself, or the nearest that fits.
std::optional<std::string> expected_whole(const ir::TypeTable& from_types, const Leaf& from,
                                          const ir::TypeTable& to_types, const Leaf& to,
                                          uint64_t bits) {
  if (!is_whole(from_types, from.symbol.type) || !is_whole(to_types, to.symbol.type)) {
    return std::nullopt;
  }
  ir::Scalar source = from_types.scalar(from.symbol.type);
  ir::Scalar target = to_types.scalar(to.symbol.type);
  Wide value = ir::is_signed(source) ? Wide{static_cast<int64_t>(bits)} : Wide{bits};
  uint32_t width = target == ir::Scalar::kBool ? 1 : ir::scalar_size(target) * 8;
  Wide low = ir::is_signed(target) ? -(Wide{1} << (width - 1)) : Wide{0};
  Wide high = (Wide{1} << (ir::is_signed(target) ? width - 1 : width)) - 1;
  if (to_types[to.symbol.type].kind == ir::Kind::kSubrange) {
    low = to_types[to.symbol.type].low;
    high = to_types[to.symbol.type].high;
  }
  // Every number but 0 is TRUE.
  if (target == ir::Scalar::kBool && value < 0) value = 1;
  value = std::min(high, std::max(low, value));
  return ir::scalar_text(to_types, to.symbol.type, static_cast<uint64_t>(value));
}

// Is `name` one of the names in `path`?
bool names(const std::string& path, const std::string& name) {
  for (size_t at = path.find(name); at != std::string::npos; at = path.find(name, at + 1)) {
    size_t end = at + name.size();
    bool begins = at == 0 || path[at - 1] == '.';
    if (begins && (end == path.size() || path[end] == '.' || path[end] == '[')) return true;
  }
  return false;
}

class Examination {
 public:
  Examination(const golden::Program& first, const golden::Program& second,
              online_change::Strategy strategy)
      : first_(first), second_(second), strategy_(strategy) {}

  Finding run(const ChangeScript& script) {
    base::Result<std::unique_ptr<Rig>> rig = Rig::start(first_, strategy_);
    if (!rig.ok()) return failure("start", base::to_string(rig.error()));
    rig_ = std::move(*rig);
    period_ns_ = golden::base_period_ns(first_.program);
    // The standby strategy's second area is a scan old at the switch.
    const int before_arming = strategy_ == online_change::Strategy::kStandby ? 1 : 0;
    for (int i = before_arming; i < script.scans_before; ++i) {
      if (!scan().empty()) return skipped();
    }
    base::Status armed = rig_->arm(second_);
    if (!armed.ok()) return change_refused(armed.error());
    for (int i = 0; i < before_arming; ++i) {
      if (!scan().empty()) return skipped();
    }
    old_types_ = rig_->image().types;
    old_image_ = rig_->image();
    before_ = rig_->leaves();
    remember_targets();
    base::Status changed = rig_->make_switch();
    if (!changed.ok()) return change_refused(changed.error());
    after_ = rig_->leaves();
    check_switch();
    if (!out_.failed) check_fates();
    // The oracle does not know what level an event had.
    auto event = [](const ir::Task& task) { return task.event != ir::kNoEvent; };
    const std::vector<ir::Task>& tasks = second_.program.tasks;
    if (std::any_of(tasks.begin(), tasks.end(), event) || leads_between()) return out_;
    if (!out_.failed) check_run(script.scans_after);
    if (!out_.failed && !trapped_) check_undo();
    return out_;
  }

 private:
  std::string scan() {
    now_ns_ += period_ns_;
    return rig_->scan();
  }

  Finding change_refused(const base::Error& error) {
    bool legal =
        error.refusal == base::Refusal::kNoChange || error.refusal == base::Refusal::kOutOfMemory;
    if (legal) return skipped();
    return failure("refused " + base::to_string(error).substr(0, 5), base::to_string(error));
  }

  void wrong(const std::string& key, const std::string& path, const std::string& is,
             const std::string& should) {
    if (out_.failed) return;
    out_ = failure(key, key + ": " + path + " is " + is + ", should be " + should);
    out_.expected = path + "=" + should;
  }

  // A union that became another one begins anew, as a whole.
  void check_switch() {
    base::Result<std::unique_ptr<Rig>> cold = Rig::start(second_);
    if (!cold.ok()) {
      out_ = failure("cold start", base::to_string(cold.error()));
      return;
    }
    Leaves fresh = (*cold)->leaves();
    const ir::TypeTable& types = rig_->image().types;
    for (const auto& [path, leaf] : after_) {
      auto old = before_.find(path);
      const bool shared = leaf.shared || (old != before_.end() && old->second.shared);
      if (shared && (old == before_.end() || said_moved(path))) {
        const std::string& initial = fresh.at(path).value;
        bool kept = old != before_.end() && old->second.value == leaf.value;
        if (leaf.value != initial && !kept) wrong("value in a union", path, leaf.value, initial);
        continue;
      }
      if (leaf.symbol.constant || old == before_.end()) {
        const std::string& initial = fresh.at(path).value;
        if (leaf.value != initial && !is_unbound(leaf)) {
          wrong("initial value", path, leaf.value, initial);
        }
      } else if (old->second.type == leaf.type) {
        check_kept(path, old->second, leaf);
      } else if (std::optional<std::string> expected =
                     expected_whole(old_types_, old->second, types, leaf, old->second.bits)) {
        if (leaf.value != *expected) wrong("converted value", path, leaf.value, *expected);
      }
    }
  }

  // X1: the report has one fate for each variable of either version, and that is what happened.
  void check_fates() {
    const online_change::EveryFate every(rig_->plan(), old_image_, rig_->image());
    std::set<std::string> listed;
    every.visit_from(0, [&](const online_change::VariableFate& variable) {
      // Of a method and the one that it overrides: two variables have this path.
      if (variable.path.find('#') != std::string::npos) return listed.insert(variable.path), true;
      if (!listed.insert(variable.path).second) {
        wrong("fate", variable.path, "listed twice", "listed once");
      }
      if (!variable.old_path.empty()) listed.insert(variable.old_path);
      check_fate(variable);
      return !out_.failed;
    });
    for (const Leaves* all : {&before_, &after_}) {
      for (const auto& [path, leaf] : *all) {
        if (!out_.failed && !listed.contains(path)) wrong("fate", path, "none", "one");
      }
    }
  }
  void check_fate(const online_change::VariableFate& variable) {
    using online_change::Fate;
    const std::string& path = variable.path;
    const auto after = after_.find(path);
    const auto before = before_.find(variable.old_path.empty() ? path : variable.old_path);
    const std::string fate = online_change::fate_name(variable.fate);
    if ((variable.fate == Fate::kDropped) != (after == after_.end())) {
      return wrong("fate", path, fate, "of a variable that is there, or not");
    }
    if (after == after_.end()) return;
    if (after->second.symbol.data != variable.new_address) {
      return wrong("fate", path, std::to_string(variable.new_address), "the new address");
    }
    const bool stays = variable.fate == Fate::kKept || variable.fate == Fate::kMoved;
    if (!stays || after->second.shared || after->second.symbol.constant) return;
    if (before == before_.end() || before->second.symbol.data != variable.old_address) {
      return wrong("fate", path, fate, "of a variable that was there");
    }
    const bool same_place = variable.new_address == variable.old_address;
    if (variable.fate == Fate::kKept && !same_place) return wrong("fate", path, fate, "moved");
    if (rig_->image().types.is_reference(after->second.symbol.type)) return;
    if (!same_value(before->second, after->second)) {
      wrong("fate", path, fate + " with another value", "with its value");
    }
  }

  // The number of an enumeration that has no name is compared as such.
  static bool same_value(const Leaf& a, const Leaf& b) {
    const bool number = a.value.find_first_not_of("-0123456789") == std::string::npos;
    return number ? a.bits == b.bits : a.value == b.value;
  }

  // The types of what references lead to.
  void remember_targets() {
    for (const auto& [path, leaf] : before_) {
      if (!old_types_.is_reference(leaf.symbol.type)) continue;
      base::Result<ir::Symbol> target = ir::find_symbol(rig_->image(), leaf.value);
      if (target.ok()) old_types_of_[leaf.value] = old_types_.text(target->type);
    }
  }

  // A reference leads to the variable of the same path; to nothing when that is gone or has another
  // type. What lies between the bytes of variables has no path.
  void check_reference(const std::string& path, const Leaf& old, const Leaf& now) {
    if (now.value == old.value || old.value == "ref" || old.value.find('+') != std::string::npos) {
      return;
    }
    base::Result<ir::Symbol> target = ir::find_symbol(rig_->image(), old.value);
    const auto before = before_.find(old.value);
    const auto after = after_.find(old.value);
    bool alike = target.ok();
    if (alike && before != before_.end() && after != after_.end()) {
      alike = before->second.type == after->second.type && !after->second.shared;
    } else if (alike) {
      alike = old_types_of_.at(old.value) == rig_->image().types.text(target->type);
    }
    alike = alike && !in_union(old.value);
    if (alike || now.value != "NULL") wrong("reference", path, now.value, old.value);
  }

  bool in_union(const std::string& path) const {
    for (size_t end = path.find_first_of(".["); end != std::string::npos;
         end = path.find_first_of(".[", end + 1)) {
      base::Result<ir::Symbol> whole = ir::find_symbol(rig_->image(), path.substr(0, end));
      if (whole.ok() && rig_->image().types.overlaps(whole->type)) return true;
    }
    return false;
  }

  // A reference with an initial value: code of the next cycle sets it.
  bool is_unbound(const Leaf& leaf) const {
    return rig_->image().types.is_reference(leaf.symbol.type) && leaf.bits != 0 &&
           ir::handle_segment(leaf.bits) == 0;
  }

  // Of a reference to something else than a variable: its bytes are nobody's.
  bool leads_between() const {
    return std::any_of(after_.begin(), after_.end(), [this](const auto& entry) {
      const std::string& value = entry.second.value;
      bool nowhere = value == "ref" || value.find('+') != std::string::npos;
      return nowhere && !is_unbound(entry.second) &&
             rig_->image().types.is_reference(entry.second.symbol.type);
    });
  }

  // An enumeration is carried by name, so its text stays too.
  void check_kept(const std::string& path, const Leaf& old, const Leaf& now) {
    if (old.symbol.constant) return;
    const ir::TypeTable& types = rig_->image().types;
    // A number that is no literal has no place in an enumeration with other numbers.
    const bool number = old.value.find_first_not_of("-0123456789") == std::string::npos;
    const bool unnamed = number && types[now.symbol.type].kind == ir::Kind::kEnum;
    if (unnamed && said_moved(path)) return;
    if (types.is_reference(now.symbol.type)) {
      check_reference(path, old, now);
    } else if (!same_value(old, now)) {
      return wrong("kept value", path, now.value, old.value);
    }
    if (now.symbol.data != old.symbol.data && !said_moved(path)) {
      wrong("kept place", path, std::to_string(now.symbol.data), std::to_string(old.symbol.data));
    }
  }

  bool shares_bytes(const std::string& path) const {
    const ir::Image& image = rig_->image();
    return ir::find_shared(image.types, image.globals, path).has_value();
  }

  // A row of the plan may stand for several alike, and names one of them: the variable's own name
  // decides. Names are unique in a random program.
  bool said_moved(const std::string& path) const {
    for (const online_change::FateRow& row : rig_->plan().fates) {
      if (row.fate == online_change::Fate::kKept) continue;
      // An area takes all its variables along, in every instance of its type.
      if (row.reason.starts_with("area")) return true;
      // Shared bytes stand in one row, by their address.
      if (row.path.starts_with("%") && shares_bytes(path)) return true;
      std::string name = row.path.substr(row.path.rfind('.') + 1);
      if (names(path, name.substr(0, name.find('[')))) return true;
    }
    return false;
  }

  // From the values that the switch left, the evaluator goes on in the same way.
  void check_run(int scans) {
    ir::Evaluator oracle(second_.program, golden::memory_of(rig_->image(), second_.program.types));
    // Structures first: the padding of one that goes into a union can be seen there.
    for (const Leaf& whole : rig_->structures()) {
      base::Status done = oracle.set_bytes(whole.type, rig_->bytes(whole));
      if (!done.ok()) return wrong("oracle", whole.type, base::to_string(done.error()), "settable");
    }
    for (const auto& [path, leaf] : after_) {
      base::Status done = oracle.set_bytes(path, rig_->bytes(leaf));
      if (!done.ok()) return wrong("oracle", path, base::to_string(done.error()), "settable");
    }
    oracle.run_start();
    int64_t now_ns = now_ns_;
    for (int i = 0; i < scans && !out_.failed && !trapped_; ++i) {
      std::string trap = scan();
      std::string expected;
      for (const ir::EvalTrap& one : oracle.scan(now_ns, 20'000'000)) {
        if (!expected.empty()) continue;
        expected =
            std::string(ir::trap_name(one.kind)) + " " + one.pou + ":" + std::to_string(one.line);
      }
      now_ns += period_ns_;
      trapped_ = !trap.empty();
      if (trap != expected) return wrong("trap after change", "trap", trap, expected);
      compare_states(oracle.state());
    }
  }

  // Programs that the change added stand elsewhere in the controller.
  static std::string sorted(const std::string& state) {
    std::istringstream stream(state);
    std::vector<std::string> lines;
    for (std::string line; std::getline(stream, line);) lines.push_back(line + "\n");
    std::sort(lines.begin(), lines.end());
    return std::accumulate(lines.begin(), lines.end(), std::string());
  }

  void compare_states(const std::string& oracle) {
    const std::string expected = sorted(oracle);
    const std::string now = sorted(rig_->state());
    if (now == expected) return;
    Finding found = first_difference(expected, now);
    found.failed = true;
    found.key = "state after change";
    found.text = found.key + ": " + found.text;
    out_ = std::move(found);
  }

  void check_undo() {
    Leaves last = rig_->leaves();
    base::Status undone = rig_->undo();
    if (!undone.ok()) {
      out_ = failure("undo refused", base::to_string(undone.error()));
      return;
    }
    for (const auto& [path, leaf] : rig_->leaves()) {
      auto now = last.find(path);
      const std::string& was = before_.at(path).value;
      if (leaf.shared || (now != last.end() && now->second.shared)) continue;
      if (now == last.end() || leaf.symbol.constant) {
        if (leaf.value != was) wrong("undo of dropped", path, leaf.value, was);
      } else if (now->second.value == after_.at(path).value) {
        if (leaf.value != was) wrong("undo of unwritten", path, leaf.value, was);
      } else if (rig_->image().types.is_reference(leaf.symbol.type)) {
        bool lost = leaf.value == "NULL" || !before_.contains(now->second.value);
        if (!lost && leaf.value != now->second.value)
          wrong("undo of a reference", path, leaf.value, now->second.value);
      } else if (now->second.type == leaf.type && !same_value(now->second, leaf)) {
        wrong("undo of kept", path, leaf.value, now->second.value);
      }
    }
  }

  const golden::Program& first_;
  const golden::Program& second_;
  online_change::Strategy strategy_;
  std::unique_ptr<Rig> rig_;
  ir::Image old_image_;
  ir::TypeTable old_types_;
  Leaves before_;
  std::map<std::string, std::string> old_types_of_;  // by path
  Leaves after_;
  int64_t period_ns_ = 0;
  int64_t now_ns_ = 0;
  bool trapped_ = false;
  Finding out_;
};

}  // namespace

ChangeScript change_script(uint64_t seed) {
  Random random(seed ^ 0x5ca1ab1e);
  int before = 1 + static_cast<int>(random.below(4));
  return {before, random.one_in(3) ? 0 : 1 + static_cast<int>(random.below(4))};
}

Finding examine_change(const std::string& first, const std::string& second,
                       const ChangeScript& script, const Build& build) {
  if (first == second) return skipped();
  const base::Result<golden::Program> a = compiled(first, build);
  const base::Result<golden::Program> b = compiled(second, build);
  if (!a.ok() || !b.ok()) return skipped();
  Finding found = Examination(*a, *b, online_change::Strategy::kInPlace).run(script);
  if (found.failed) return found;
  Finding other = Examination(*a, *b, online_change::Strategy::kStandby).run(script);
  if (!other.failed) return found;
  other.key += " (standby)";
  return other;
}

}  // namespace differential
