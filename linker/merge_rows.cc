#include "linker/merge_rows.h"

#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "base/bytes.h"
#include "base/name_case.h"
#include "ir/bytecode/canonical_value.h"
#include "linker/initial_differences.h"

namespace linker {
namespace {

using ir::Kind;
using ir::PartKind;
using ir::Type;
using ir::TypeId;

PartKind part_of(Kind kind) {
  const bool block =
      kind == Kind::kFunctionBlock || kind == Kind::kProgram || kind == Kind::kInterface;
  return block ? PartKind::kBlock : PartKind::kType;
}

class RowMerger {
 public:
  RowMerger(const MergeInput& input, const PartChoice& choice, const Unlinked& edited,
            const Unlinked& target)
      : input_(input), choice_(choice), edited_(edited), target_(target) {}

  base::Result<MergedRows> run() {
    out_.merged = std::make_unique<ir::Program>();
    ir::Program& merged = *out_.merged;
    merged.name = target_.program.name;
    merged.types = target_.program.types;
    merged.constants = target_.program.constants;
    merged.globals = target_.program.globals;
    declare_types();
    make_translators();
    fill_types();
    fill_globals();
    out_.from_edited->settle();
    out_.from_target->settle();
    give_initial_values();
    merge_tasks();
    merge_programs();
    merge_tables();
    if (std::string why = problem(); !why.empty()) {
      return base::Error{base::Refusal::kCannotRelink, "the declarations name " + why};
    }
    return std::move(out_);
  }

 private:
  ir::Program& merged() { return *out_.merged; }

  std::string problem() const {
    if (!problem_.empty()) return problem_;
    const std::string& edited = out_.from_edited->problem();
    return edited.empty() ? out_.from_target->problem() : edited;
  }
  void fail(std::string what) {
    if (problem_.empty()) problem_ = std::move(what);
  }

  // --- types --------------------------------------------------------------------

  static bool is_declared(const Type& type) {
    return !type.name.empty() && type.kind != Kind::kGlobals;
  }

  // New ones have their names now, so that others can refer to them.
  void declare_types() {
    std::map<std::string, TypeId> known;
    for (uint32_t i = ir::kElementaryCount; i < merged().types.size(); ++i) {
      const Type& type = merged().types[TypeId(i)];
      if (is_declared(type)) known.emplace(ir::fold_name(type.name), TypeId(i));
    }
    const ir::TypeTable& types = edited_.program.types;
    for (uint32_t i = ir::kElementaryCount; i < types.size(); ++i) {
      const Type& type = types[TypeId(i)];
      if (!is_declared(type) || !choice_.takes(part_of(type.kind), type.name)) continue;
      const auto [found, added] = known.try_emplace(ir::fold_name(type.name), TypeId());
      if (added) {
        Type named;
        named.kind = type.kind;
        named.name = type.name;
        found->second = merged().types.declare(std::move(named));
      }
      taken_types_.emplace_back(TypeId(i), found->second);
    }
  }

  // What code names must be what it was made for: what the edit brings, or what is the same there
  // (E-10).
  void make_translators() {
    struct Compared {
      const PartChoice& choice;
      std::vector<ir::Part> made_for;
      std::vector<ir::Part> there;
    };
    const auto compared = std::make_shared<Compared>(
        Compared{choice_, ir::parts_of(input_.edited), ir::parts_of(input_.target)});
    const auto differs = [compared](PartKind kind, const std::string& name) {
      if (compared->choice.takes(kind, name)) return false;
      const ir::Part* const there = ir::find_part(compared->there, kind, name);
      const ir::Part* const made_for = ir::find_part(compared->made_for, kind, name);
      return there == nullptr || made_for == nullptr || there->identity != made_for->identity;
    };
    out_.from_edited = std::make_unique<Translator>(
        edited_.program, merged(), false,
        Translator::Checks{
            [differs](const Type& type) { return differs(part_of(type.kind), type.name); },
            [differs](const ir::Member& member) {
              return differs(PartKind::kGlobal, member.name);
            }});
    out_.from_target = std::make_unique<Translator>(
        target_.program, merged(), true,
        Translator::Checks{[compared](const Type& type) {
                             return compared->choice.drops(part_of(type.kind), type.name);
                           },
                           [](const ir::Member&) { return false; }});
  }

  void fill_types() {
    for (const auto& [from, to] : taken_types_) {
      Type type = edited_.program.types[from];
      type.base = out_.from_edited->type(type.base);
      for (ir::Member& member : type.members) member = out_.from_edited->member_of(member);
      for (TypeId& interface : type.interfaces) interface = out_.from_edited->type(interface);
      for (ir::EnumLiteral& literal : type.literals) {
        literal.old_name = out_.from_edited->rule(literal.old_name);
      }
      type.init = {};
      type.old_name = out_.from_edited->rule(type.old_name);
      merged().types.edit(to) = std::move(type);
      is_taken_[to.index] = true;
    }
  }

  struct Global {
    Translator* from;
    const ir::Member* member;
  };

  // Globals of the target come in their order, then those that the edit adds in theirs.
  void fill_globals() {
    const std::vector<ir::Member>& edited = edited_.program.types[edited_.program.globals].members;
    std::map<std::string, const ir::Member*> taken;
    for (const ir::Member& member : edited) {
      if (choice_.takes(PartKind::kGlobal, member.name)) {
        taken.emplace(ir::fold_name(member.name), &member);
      }
    }
    for (const ir::Member& member : target_.program.types[target_.program.globals].members) {
      if (choice_.drops(PartKind::kGlobal, member.name)) continue;
      const auto found = taken.find(ir::fold_name(member.name));
      if (found == taken.end()) {
        globals_.push_back({out_.from_target.get(), &member});
      } else {
        globals_.push_back({out_.from_edited.get(), found->second});
        taken.erase(found);
      }
    }
    for (const ir::Member& member : edited) {
      if (taken.contains(ir::fold_name(member.name))) {
        globals_.push_back({out_.from_edited.get(), &member});
      }
    }
    std::vector<ir::Member> members;
    for (const Global& global : globals_) members.push_back(global.from->member_of(*global.member));
    merged().types.edit(merged().globals).members = std::move(members);
  }

  void give_initial_values() {
    for (size_t i = 0; i < globals_.size(); ++i) {
      const ir::Member& member = *globals_[i].member;
      const ir::ConstId init = globals_[i].from->constant(member.type, member.init);
      merged().types.edit(merged().globals).members[i].init = init;
    }
    for (const auto& [from, to] : taken_types_) {
      give_initial_values(*out_.from_edited, edited_.program.types[from], from, to);
    }
    const ir::TypeTable& own = target_.program.types;
    for (uint32_t i = ir::kElementaryCount; i < own.size(); ++i) {
      const TypeId id(i);
      const bool stays = own[id].kind != Kind::kGlobals && !is_taken_.contains(i);
      if (!stays) continue;
      if (is_declared(own[id]) && choice_.drops(part_of(own[id].kind), own[id].name)) {
        drop(id);
      } else if (is_declared(own[id])) {
        (void)out_.from_target->type(id);  // is all that it is made of still there?
        give_initial_values(*out_.from_target, own[id], id, id);
      }
    }
  }

  void give_initial_values(Translator& translator, const Type& before, TypeId from, TypeId to) {
    for (size_t i = 0; i < before.members.size(); ++i) {
      const ir::Member& member = before.members[i];
      const ir::ConstId init = translator.constant(member.type, member.init);
      merged().types.edit(to).members[i].init = init;
    }
    const ir::ConstId init = translator.constant(from, before.init);
    merged().types.edit(to).init = init;
  }

  // Nothing is of it any more, but others keep their numbers.
  void drop(TypeId id) {
    Type nothing;
    nothing.kind = Kind::kSubrange;
    nothing.base = merged().types.elementary(Kind::kByte);
    merged().types.edit(id) = std::move(nothing);
  }

  // --- tasks and programs -------------------------------------------------------

  uint32_t global_number(const ir::Program& from, uint32_t member) {
    if (member == ir::kNoEvent) return member;
    const std::string& name = from.types[from.globals].members[member].name;
    const int32_t number = merged().types.find_member(merged().globals, name);
    if (number < 0) fail("`" + name + "`, which is not there");
    return number < 0 ? 0 : static_cast<uint32_t>(number);
  }

  // The rows of the target with those that the edit takes in their places, then those that it adds.
  template <class Row, class Name, class Add>
  void merge_list(PartKind kind, const std::vector<Row>& edited, const std::vector<Row>& target,
                  const Name& name, const Add& add) const {
    const auto find = [&](const std::vector<Row>& rows, const std::string& wanted) {
      return std::find_if(rows.begin(), rows.end(),
                          [&](const Row& row) { return ir::same_name(name(row), wanted); });
    };
    for (const Row& row : target) {
      if (choice_.drops(kind, name(row))) continue;
      const bool takes = choice_.takes(kind, name(row));
      takes ? add(*find(edited, name(row)), true) : add(row, false);
    }
    for (const Row& row : edited) {
      const bool added = choice_.takes(kind, name(row)) && find(target, name(row)) == target.end();
      if (added) add(row, true);
    }
  }

  void merge_tasks() {
    merge_list(
        PartKind::kTask, edited_.program.tasks, target_.program.tasks,
        [](const ir::Task& task) { return task.name; },
        [this](const ir::Task& task, bool taken) {
          ir::Task row = task;
          row.event = global_number(taken ? edited_.program : target_.program, task.event);
          merged().tasks.push_back(std::move(row));
        });
  }

  uint32_t task_number(const ir::Program& from, uint32_t task) {
    if (task == ir::kNoTask) return task;
    const std::string& name = from.tasks[task].name;
    for (uint32_t i = 0; i < merged().tasks.size(); ++i) {
      if (ir::same_name(merged().tasks[i].name, name)) return i;
    }
    fail("the task `" + name + "`, which is not there");
    return 0;
  }

  void merge_programs() {
    std::map<std::string, uint32_t> numbers;
    merge_list(
        PartKind::kProgram, edited_.program.instances, target_.program.instances,
        [](const ir::ProgramInstance& row) { return row.name; },
        [&](const ir::ProgramInstance& row, bool taken) {
          const ir::Program& from = taken ? edited_.program : target_.program;
          Translator& translator = taken ? *out_.from_edited : *out_.from_target;
          ir::ProgramInstance instance = row;
          instance.type = translator.type(row.type);
          instance.task = task_number(from, row.task);
          instance.init = taken ? translator.constant(row.type, row.init) : init_of(row);
          instance.old_name = translator.rule(row.old_name);
          const auto number = static_cast<uint32_t>(merged().instances.size());
          merged().instances.push_back(std::move(instance));
          add_block_tasks(from, translator, row.name, number);
        });
  }

  void add_block_tasks(const ir::Program& from, Translator& translator, const std::string& program,
                       uint32_t number) {
    for (const ir::BlockTask& row : from.block_tasks) {
      const ir::ProgramInstance& instance = from.instances[row.program];
      if (!ir::same_name(instance.name, program)) continue;
      const std::optional<uint32_t> member = translator.member(instance.type, row.member);
      if (!member) fail("a block of `" + program + "` that has a task, and is not there");
      merged().block_tasks.push_back({number, member.value_or(0), task_number(from, row.task)});
    }
  }

  // What the declaration of one instance gives it is no part of its own: the edit's, if that
  // differs from what the edit was made on, else the target's.
  ir::ConstId init_of(const ir::ProgramInstance& row) {
    const std::optional<base::Bytes> before = original_init(row.name);
    for (const ir::ProgramInstance& edited : edited_.program.instances) {
      if (!ir::same_name(edited.name, row.name) || !before) continue;
      const base::Bytes after = init_bytes(edited_.program, edited.type, edited.init);
      if (after == *before) break;
      const base::Bytes here = init_bytes(target_.program, row.type, row.init);
      if (here != *before && here != after) {
        fail("other initial values of `" + row.name + "` than here");
      }
      return out_.from_edited->constant(edited.type, edited.init);
    }
    return out_.from_target->constant(row.type, row.init);
  }

  static base::Bytes init_bytes(const ir::Program& program, TypeId type, ir::ConstId init) {
    base::ByteWriter out;
    ir::write_canonical(out, program.types, program.constants, type, init);
    return out.take();
  }

  std::optional<base::Bytes> original_init(const std::string& name) const {
    for (const uint32_t id : input_.original.program_ids()) {
      const ir::Instance& row = input_.original.instances[id];
      if (!ir::same_name(row.name, name)) continue;
      ir::ConstTable constants = *input_.original.constants;
      const ir::ConstId init = initial_difference(input_.original, constants, id);
      base::ByteWriter out;
      ir::write_canonical(out, input_.original.types, constants, row.type, init);
      return out.take();
    }
    return std::nullopt;
  }

  // --- the rest -----------------------------------------------------------------

  void merge_tables() {
    merge_list(
        PartKind::kAccess, edited_.program.access, target_.program.access,
        [](const ir::AccessPath& row) { return row.name; },
        [this](const ir::AccessPath& row, bool) { merged().access.push_back(row); });
    merge_list(
        PartKind::kAddress, edited_.program.located, target_.program.located,
        [](const ir::LocatedPath& row) { return row.path; },
        [this](const ir::LocatedPath& row, bool) { merged().located.push_back(row); });
    merge_list(
        PartKind::kDevice, edited_.devices, target_.devices,
        [](const ir::Device& row) { return row.name; },
        [this](const ir::Device& row, bool) { out_.devices.push_back(row); });
    merge_list(PartKind::kSafe, edited_.safe, target_.safe, ir::safe_name,
               [this](const ir::SafeOutput& row, bool) { out_.safe.push_back(row); });
    std::sort(out_.safe.begin(), out_.safe.end(),
              [](const auto& a, const auto& b) { return a.bit_offset < b.bit_offset; });
    const bool schedule = choice_.takes(PartKind::kSchedule, "");
    merged().schedule = schedule ? edited_.program.schedule : target_.program.schedule;
    merge_shared();
  }

  // By name; written where either writes it.
  void merge_shared() {
    std::map<uint32_t, bool> rows;
    const std::pair<const ir::Program&, bool> programs[] = {{target_.program, false},
                                                            {edited_.program, true}};
    for (const auto& [program, edited] : programs) {
      for (const ir::SharedGlobal& row : program.shared) {
        const std::string& name = program.types[program.globals].members[row.member].name;
        const int32_t number = merged().types.find_member(merged().globals, name);
        if (number < 0) continue;
        if (edited && !choice_.takes(PartKind::kGlobal, name)) continue;
        bool& written = rows[static_cast<uint32_t>(number)];
        written = written || row.written;
      }
    }
    for (const auto& [member, written] : rows) merged().shared.push_back({member, written});
  }

  const MergeInput& input_;
  const PartChoice& choice_;
  const Unlinked& edited_;
  const Unlinked& target_;
  MergedRows out_;
  std::vector<std::pair<TypeId, TypeId>> taken_types_;  // of the edit, merged
  std::map<uint32_t, bool> is_taken_;                   // by merged number
  std::vector<Global> globals_;
  std::string problem_;
};

}  // namespace

base::Result<MergedRows> merge_rows(const MergeInput& input, const PartChoice& choice,
                                    const Unlinked& edited, const Unlinked& target) {
  return RowMerger(input, choice, edited, target).run();
}

}  // namespace linker
