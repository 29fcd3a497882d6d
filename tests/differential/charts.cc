// Sequential function charts: steps with actions of all qualifiers, sequences, alternatives and
// simultaneous branches that come together again, and the way back to the first step.
#include "tests/differential/builder.h"

namespace differential {
namespace {

constexpr const char* kQualifiers[] = {"N", "S", "R", "P", "P0", "P1", "L", "D", "SD", "DS", "SL"};
constexpr uint32_t kUntimed = 6;  // those in front take no time

}  // namespace

void Builder::chart(Pou& pou) {
  actions_.clear();
  uint32_t own = 1 + below(3);
  for (uint32_t i = 0; i < own; ++i) actions_.push_back(fresh("Act"));
  std::vector<Variable> flags;
  for (uint32_t i = 0; i < 2; ++i) {
    flags.push_back(declare(pou, Section::kLocal, elementary(ir::Kind::kBool)));
    actions_.push_back(flags.back().name);
  }
  std::string first = step(pou, true);
  std::string last = first;
  for (uint32_t n = 1 + below(4); n > 0; --n) last = segment(pou, last);
  if (last == first) last = step(pou, false);
  transition(pou, last, first);
  for (uint32_t i = 0; i < own; ++i) {
    see({actions_[i] + ".Q", elementary(ir::Kind::kBool)}, false);
  }
  for (uint32_t i = 0; i < own; ++i) {
    Stmt out;
    out.tail = "END_ACTION";
    out.clauses.push_back({"ACTION " + actions_[i] + ":", {}, statements(1 + below(2), 2), false});
    pou.members.push_back(std::move(out));
    pou.body[0].clauses[0].body.push_back(simple(actions_[i] + "(" + qualifier() + ");", {}));
  }
}

std::string Builder::qualifier() {
  uint32_t which = below(11);
  std::string out = kQualifiers[which];
  if (which >= kUntimed) out += ", T#" + std::to_string(10 * below(6)) + "ms";
  return out;
}

std::string Builder::step(Pou& pou, bool initial) {
  std::string name = fresh("Step");
  Stmt out;
  out.tail = "END_STEP";
  out.clauses.push_back({(initial ? "INITIAL_STEP " : "STEP ") + name + ":", {}, {}, false});
  for (uint32_t n = below(3); n > 0; --n) {
    const std::string& which = actions_[below(count(actions_))];
    out.clauses[0].body.push_back(simple(which + "(" + qualifier() + ");", {}));
  }
  pou.body.push_back(std::move(out));
  see({name + ".X", elementary(ir::Kind::kBool)}, false);
  see({name + ".T", elementary(ir::Kind::kTime)}, false);
  return name;
}

void Builder::transition(Pou& pou, const std::string& from, const std::string& to) {
  std::string head = "TRANSITION ";
  if (one_in(4)) head += fresh("go") + " ";
  if (one_in(4)) head += "(PRIORITY := " + std::to_string(1 + below(9)) + ") ";
  head += "FROM " + from + " TO " + to;
  TypeRef boolean = elementary(ir::Kind::kBool);
  if (one_in(6)) {
    pou.body.push_back(simple(head + " : LD @0 END_TRANSITION", {read(boolean)}));
    return;
  }
  std::vector<Expr> condition;
  if (one_in(3)) {
    std::string step = from[0] == '(' ? from.substr(1, from.find(',') - 1) : from;
    condition.push_back(
        node(boolean, step + ".T >= T#" + std::to_string(10 * below(5)) + "ms", {}));
  } else if (one_in(3)) {
    condition.push_back(node(boolean, "TRUE", {}));
  } else {
    condition.push_back(expression(boolean, 2));
  }
  pou.body.push_back(simple(head + " := @0; END_TRANSITION", std::move(condition)));
}

// From the last step to a new one.
std::string Builder::segment(Pou& pou, const std::string& from) {
  std::string left = step(pou, false);
  switch (below(4)) {
    case 0: {  // one of two
      std::string right = step(pou, false);
      std::string joined = step(pou, false);
      transition(pou, from, left);
      transition(pou, from, right);
      transition(pou, left, joined);
      transition(pou, right, joined);
      return joined;
    }
    case 1: {  // both
      std::string right = step(pou, false);
      std::string joined = step(pou, false);
      transition(pou, from, "(" + left + ", " + right + ")");
      if (one_in(2)) {
        std::string next = step(pou, false);
        transition(pou, left, next);
        left = next;
      }
      transition(pou, "(" + left + ", " + right + ")", joined);
      return joined;
    }
    case 2:
      transition(pou, from, left);
      transition(pou, left, left);
      return left;
    default:
      transition(pou, from, left);
      return left;
  }
}

}  // namespace differential
