// The program around the bodies, and the order in which the parts are checked.
#include "ir/program/verify.h"

#include <algorithm>
#include <string>

#include "base/limits.h"
#include "ir/program/verify_parts.h"
#include "ir/types/parts.h"

namespace ir {
namespace {

const std::vector<Member> kNoMembers;

class ProgramVerifier {
 public:
  explicit ProgramVerifier(const Program& program)
      : program_(program), constants_(program.types, program.constants) {}

  base::Status verify_declarations() {
    check_globals();
    check_initial_values();
    check_tasks();
    for (size_t i = 0; i < program_.pous.size(); ++i) {
      check_pou(i, program_.pous[i]);
    }
    for (size_t i = 0; i < program_.overrides.size(); ++i) {
      check_override(i);
    }
    return reason_.empty() ? base::Status(base::Ok{}) : not_verified(reason_);
  }

  base::Status verify_inits(const Pou& pou) {
    for (size_t b = 0; b < pou.blocks.size(); ++b) {
      for (size_t i = 0; i < pou.blocks[b].insts.size(); ++i) {
        check_inst_constants(pou, b, i);
      }
    }
    return reason_.empty() ? base::Status(base::Ok{}) : not_verified(reason_);
  }

 private:
  void require(bool holds, const std::string& reason) {
    if (!holds && reason_.empty()) {
      reason_ = reason;
    }
  }

  void require_fit(TypeId type, ConstId constant, const std::string& where) {
    const base::Status status = constants_.fits(type, constant);
    require(status.ok(), where + (status.ok() ? "" : ": " + status.error().text));
  }

  void check_globals() {
    const TypeTable& types = program_.types;
    require(types.contains(program_.globals), "the program has no globals type");
    uint32_t count = 0;
    for (uint32_t i = 0; i < types.size(); ++i) {
      count += types[TypeId(i)].kind == Kind::kGlobals;
    }
    require(count == 1 && reason_.empty() && types[program_.globals].kind == Kind::kGlobals,
            "a program has exactly one globals type");
    for (const Member& member : reason_.empty() ? types[program_.globals].members : kNoMembers) {
      require(types[member.type].kind != Kind::kProgram || names_program(member),
              "global " + member.name + " names no program instance of its name and type");
    }
  }

  bool names_program(const Member& member) const {
    return !member.init.valid() && !member.retain &&
           std::any_of(program_.instances.begin(), program_.instances.end(),
                       [&member](const ProgramInstance& instance) {
                         return instance.type == member.type &&
                                same_name(instance.name, member.name);
                       });
  }

  void check_initial_values() {
    const TypeTable& types = program_.types;
    for (uint32_t i = 0; i < types.size(); ++i) {
      require_fit(TypeId(i), types[TypeId(i)].init, "type " + types.text(TypeId(i)));
      for (const Member& member : types[TypeId(i)].members) {
        require_fit(member.type, member.init, "member " + member.name);
      }
    }
    for (const ProgramInstance& instance : program_.instances) {
      require(types.contains(instance.type) && types[instance.type].kind == Kind::kProgram,
              "instance " + instance.name + " is of no program type");
      if (reason_.empty()) {
        require_fit(instance.type, instance.init, "instance " + instance.name);
      }
    }
  }

  void check_tasks() {
    require(std::any_of(program_.tasks.begin(), program_.tasks.end(),
                        [](const Task& task) { return !task.once; }),
            "a program has at least one task with a period");
    for (const Task& task : program_.tasks) {
      const bool event = task.event != kNoEvent;
      const bool no_period = task.once || task.policy.freewheeling;
      require((no_period ? task.period_ns == 0 : task.period_ns > 0 || event) &&
                  task.period_ns >= 0 && task.watchdog_ns >= 0,
              "task " + task.name + " has no period, or a negative watchdog time");
      const std::vector<Member>& globals = program_.types[program_.globals].members;
      require(!event || (task.event < globals.size() &&
                         program_.types.root_kind(globals[task.event].type) == Kind::kBool),
              "the event of task " + task.name + " is no BOOL global");
    }
    for (const ProgramInstance& instance : program_.instances) {
      require(instance.task < program_.tasks.size() || instance.task == kNoTask,
              "instance " + instance.name + " runs in a task that does not exist");
      require(program_.pou_of_instance_type(instance.type).valid(),
              "instance " + instance.name + " has no code");
    }
    for (const BlockTask& block : program_.block_tasks) {
      const bool program = block.program < program_.instances.size();
      require(program && block.task < program_.tasks.size(), "a block's task does not exist");
      if (!reason_.empty()) return;
      const Type& owner = program_.types[program_.instances[block.program].type];
      require(block.member < owner.members.size() &&
                  program_.types[owner.members[block.member].type].kind == Kind::kFunctionBlock,
              "a task runs what is no function block");
    }
  }

  void check_pou(size_t index, const Pou& pou) {
    const std::string where = "POU " + pou.name + ": ";
    const TypeTable& types = program_.types;
    if (pou.kind == PouKind::kFunction) {
      require(!pou.self.valid(), where + "a function has no instance");
    } else if (pou.kind == PouKind::kMethod) {
      require(types.is_instance(pou.self) ||
                  (types.contains(pou.self) && types[pou.self].kind == Kind::kInterface),
              where + "a method belongs to a block or an interface");
    } else {
      const Kind kind = pou.kind == PouKind::kProgram ? Kind::kProgram : Kind::kFunctionBlock;
      require(types.contains(pou.self) && types[pou.self].kind == kind,
              where + "its instance type is of another kind");
      require(program_.pou_of_instance_type(pou.self) == PouId(static_cast<uint32_t>(index)),
              where + "its instance type has code already");
    }
    require(pou.recursion_depth <= base::kMaxCallDepth,
            where + "its recursion depth is above the limit");
    for (const Local& local : pou.locals) {
      check_local(pou, local, where + "local " + local.name);
    }
  }

  // Instances live in areas of their own, so a frame can only refer to them.
  void check_local(const Pou& pou, const Local& local, const std::string& where) {
    require(program_.types.contains(local.type), where + " has a type that does not exist");
    require(has_parameters(pou.kind) || local.kind == LocalKind::kTemp,
            where + " is a parameter outside of a function");
    if (reason_.empty() && local.kind != LocalKind::kInOut) {
      require(!holds_instance(program_.types, local.type), where + " is or holds an instance");
    }
  }

  void check_override(size_t index) {
    const Override& row = program_.overrides[index];
    require(is_method(row.prototype) && is_method(row.target) &&
                program_.types.contains(row.type) &&
                program_.types[row.type].kind == Kind::kFunctionBlock,
            "an override names what is no method or no block");
    if (!reason_.empty()) {
      return;
    }
    const Pou& prototype = program_.pous[row.prototype.index];
    const Pou& target = program_.pous[row.target.index];
    const std::string where = "override of " + prototype.name + " by " + target.name + ": ";
    require(program_.types.is_a(row.type, prototype.self) &&
                program_.types.is_a(row.type, target.self) &&
                program_.types.is_instance(target.self),
            where + "the block has not both methods");
    require(same_parameters(prototype, target), where + "their parameters differ");
    if (index != 0) {
      const Override& before = program_.overrides[index - 1];
      require(std::pair(before.type, before.prototype) < std::pair(row.type, row.prototype),
              where + "rows are out of order");
    }
  }

  bool is_method(PouId id) const {
    return id.index < program_.pous.size() && program_.pous[id.index].kind == PouKind::kMethod;
  }

  // Slot for slot: the caller of one writes the frame of the other.
  static bool same_parameters(const Pou& a, const Pou& b) {
    const auto parameters = [](const Pou& pou) {
      return std::count_if(pou.locals.begin(), pou.locals.end(),
                           [](const Local& local) { return local.kind != LocalKind::kTemp; });
    };
    const auto count = parameters(a);
    return count == parameters(b) &&
           std::equal(
               a.locals.begin(), a.locals.begin() + count, b.locals.begin(),
               [](const Local& x, const Local& y) { return x.kind == y.kind && x.type == y.type; });
  }

  void check_inst_constants(const Pou& pou, size_t block, size_t index) {
    const Inst& inst = pou.blocks[block].insts[index];
    if (inst.op == Op::kInit) {
      require_fit(pou.places[inst.place.index].type, inst.constant, inst_place(pou, block, index));
    }
    for (const PlaceId id : {inst.place, inst.place2}) {
      if (id.valid() && pou.places[id.index].base == PlaceBase::kConst) {
        const Place& place = pou.places[id.index];
        require_fit(place.base_type, place.constant, inst_place(pou, block, index));
      }
    }
  }

  const Program& program_;
  ConstantCheck constants_;
  std::string reason_;
};

base::Status verify_body(ProgramVerifier& verifier, const Program& program, const Pou& pou) {
  if (base::Status status = verify_instructions(program, pou); !status.ok()) {
    return status;
  }
  if (base::Status status = verifier.verify_inits(pou); !status.ok()) {
    return status;
  }
  if (base::Status status = verify_dominance(pou); !status.ok()) {
    return status;
  }
  if (base::Status status = verify_tries(pou); !status.ok()) {
    return status;
  }
  return verify_calls(program, pou);
}

}  // namespace

base::Status verify(const Program& program) {
  if (base::Status status = verify_types(program.types); !status.ok()) {
    return status;
  }
  ProgramVerifier verifier(program);
  if (base::Status status = verifier.verify_declarations(); !status.ok()) {
    return status;
  }
  for (const Pou& pou : program.pous) {
    if (base::Status status = verify_body(verifier, program, pou); !status.ok()) {
      return status;
    }
  }
  return base::Ok{};
}

base::Status verify(const Program& program, const Pou& pou) {
  ProgramVerifier verifier(program);
  return verify_body(verifier, program, pou);
}

}  // namespace ir
