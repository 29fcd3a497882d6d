// Which method a virtual call runs, from the names of methods and the chains of bases.
#include "ir/program/overrides.h"

#include <map>
#include <utility>

#include "base/limits.h"

namespace ir {
namespace {

// "start" of the method "Motor.start", "Speed.GET" of "Motor.Speed.GET"; folded.
std::string method_name(const Program& program, const Pou& pou) {
  const std::string name = fold_name(pou.name);
  const std::string block = fold_name(program.types[pou.self].name) + ".";
  return name.starts_with(block) ? name.substr(block.size()) : name;
}

class Finder {
 public:
  Finder(const Program& program, std::set<PouId> prototypes)
      : program_(program), prototypes_(std::move(prototypes)) {
    for (uint32_t i = 0; i < program.pous.size(); ++i) {
      const Pou& pou = program.pous[i];
      if (pou.kind == PouKind::kMethod && program.types.contains(pou.self)) {
        methods_.emplace(std::pair(pou.self.index, method_name(program, pou)), PouId(i));
      }
      collect_prototypes(pou);
    }
  }

  std::vector<Override> run() const {
    std::vector<Override> rows;
    for (uint32_t i = 0; i < program_.types.size(); ++i) {
      if (program_.types[TypeId(i)].kind != Kind::kFunctionBlock) {
        continue;
      }
      for (const PouId prototype : prototypes_) {
        add_row(TypeId(i), prototype, rows);
      }
    }
    return rows;
  }

 private:
  void collect_prototypes(const Pou& pou) {
    for (const Block& block : pou.blocks) {
      for (const Inst& inst : block.insts) {
        if (inst.op == Op::kCallVirtual && inst.pou.index < program_.pous.size()) {
          prototypes_.insert(inst.pou);
        }
      }
    }
  }

  void add_row(TypeId type, PouId prototype, std::vector<Override>& rows) const {
    const Pou& pou = program_.pous[prototype.index];
    if (!program_.types.is_a(type, pou.self)) {
      return;
    }
    const PouId target = method_of(type, method_name(program_, pou));
    if (target.valid()) {
      rows.push_back({type, prototype, target});
    }
  }

  PouId method_of(TypeId type, const std::string& name) const {
    for (uint32_t depth = 0; depth < base::kMaxNesting && type.valid(); ++depth) {
      if (const auto found = methods_.find({type.index, name}); found != methods_.end()) {
        return found->second;
      }
      type = program_.types[type].base;
    }
    return PouId();
  }

  const Program& program_;
  std::map<std::pair<uint32_t, std::string>, PouId> methods_;
  std::set<PouId> prototypes_;
};

}  // namespace

std::vector<Override> find_overrides(const Program& program, std::set<PouId> prototypes) {
  return Finder(program, std::move(prototypes)).run();
}

std::vector<Override> find_overrides(const Program& program) { return find_overrides(program, {}); }

}  // namespace ir
