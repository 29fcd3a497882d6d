// The program around the bodies, and the order in which the parts are checked.
#include "ir/program/verify.h"

#include <algorithm>
#include <string>

#include "ir/program/shape.h"
#include "ir/program/verify_parts.h"

namespace ir {
namespace {

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
    require(!program_.tasks.empty(), "a program has at least one task");
    for (const Task& task : program_.tasks) {
      require(task.period_ns > 0 && task.watchdog_ns >= 0,
              "task " + task.name + " has no period, or a negative watchdog time");
    }
    for (const ProgramInstance& instance : program_.instances) {
      require(instance.task < program_.tasks.size(),
              "instance " + instance.name + " runs in a task that does not exist");
      require(program_.pou_of_instance_type(instance.type).valid(),
              "instance " + instance.name + " has no code");
    }
  }

  void check_pou(size_t index, const Pou& pou) {
    const std::string where = "POU " + pou.name + ": ";
    const TypeTable& types = program_.types;
    if (pou.kind == PouKind::kFunction) {
      require(!pou.self.valid(), where + "a function has no instance");
    } else {
      const Kind kind = pou.kind == PouKind::kProgram ? Kind::kProgram : Kind::kFunctionBlock;
      require(types.contains(pou.self) && types[pou.self].kind == kind,
              where + "its instance type is of another kind");
      require(program_.pou_of_instance_type(pou.self) == PouId(static_cast<uint32_t>(index)),
              where + "its instance type has code already");
    }
    for (const Local& local : pou.locals) {
      check_local(pou, local, where + "local " + local.name);
    }
  }

  // Instances live in areas of their own, so a frame can only refer to them.
  void check_local(const Pou& pou, const Local& local, const std::string& where) {
    require(program_.types.contains(local.type), where + " has a type that does not exist");
    require(pou.kind == PouKind::kFunction || local.kind == LocalKind::kTemp,
            where + " is a parameter outside of a function");
    if (reason_.empty() && local.kind != LocalKind::kInOut) {
      require(!holds_instance(program_.types, local.type), where + " is or holds an instance");
    }
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
