#include "tests/differential/shrink.h"

#include <algorithm>

namespace differential {
namespace {

// The places of a program where something can go, always in the same order: a position found in
// one copy is the same position in another.
struct Lists {
  std::vector<std::vector<Stmt>*> statements;
  std::vector<Stmt*> single;
  std::vector<std::vector<Variable>*> variables;
  std::vector<Variable*> declarations;
  std::vector<Expr*> expressions;
  std::vector<std::vector<Pou>*> methods;

  explicit Lists(Program& program) {
    for (VarBlock& block : program.globals) add(block.variables);
    for (TypeRef type : program.declared) add(program.types[type].members);
    for (Pou& pou : program.pous) add(pou);
  }

  void add(Pou& pou) {
    for (VarBlock& block : pou.blocks) add(block.variables);
    add(pou.body);
    add(pou.members);
    methods.push_back(&pou.methods);
    for (Pou& method : pou.methods) add(method);
  }

  void add(std::vector<Variable>& list) {
    variables.push_back(&list);
    for (Variable& one : list) {
      declarations.push_back(&one);
      if (one.initial) add(*one.initial);
    }
  }
  void add(std::vector<Stmt>& list) {
    statements.push_back(&list);
    for (Stmt& one : list) {
      single.push_back(&one);
      for (Clause& clause : one.clauses) {
        for (Expr& expr : clause.operands) add(expr);
        add(clause.body);
      }
    }
  }
  void add(Expr& expr) {
    expressions.push_back(&expr);
    for (Expr& operand : expr.operands) add(operand);
  }
};

class Shrinker {
 public:
  Shrinker(Program program, const StillFails& fails)
      : program_(std::move(program)), fails_(fails) {}

  Program run() {
    for (bool changed = true; changed;) {
      changed = pous();
      changed = statements() || changed;
      changed = clauses() || changed;
      changed = expressions() || changed;
      changed = declarations() || changed;
    }
    return std::move(program_);
  }

 private:
  // Keeps the copy that `change` made, if it still fails.
  template <class Change>
  bool attempt(const Change& change) {
    Program copy = program_;
    if (!change(copy) || !fails_(copy)) return false;
    program_ = std::move(copy);
    return true;
  }

  // Removes runs of a list, long ones first. `list_of` finds it in a copy.
  template <class ListOf>
  bool thin(const ListOf& list_of) {
    bool changed = false;
    size_t size = list_of(program_).size();
    for (size_t run = size; run > 0; run /= 2) {
      for (size_t at = 0; at < list_of(program_).size();) {
        bool gone = attempt([&](Program& copy) {
          auto& list = list_of(copy);
          size_t end = std::min(list.size(), at + run);
          for (size_t i = at; i < end; ++i) {
            if (pinned(list[i])) return false;
          }
          list.erase(list.begin() + static_cast<ptrdiff_t>(at),
                     list.begin() + static_cast<ptrdiff_t>(end));
          return true;
        });
        changed = changed || gone;
        if (!gone) at += run;
      }
    }
    return changed;
  }

  template <class Item>
  static bool pinned(const Item&) {
    return false;
  }
  static bool pinned(const Stmt& one) { return one.pinned; }
  static bool pinned(const Clause& one) {
    return std::any_of(one.body.begin(), one.body.end(),
                       [](const Stmt& inner) { return inner.pinned; });
  }
  // Of a loop that counts down, or of the roof over it: only both together may go.
  static bool pinned_inside(const Stmt& one) {
    return std::any_of(one.clauses.begin(), one.clauses.end(),
                       [](const Clause& clause) { return pinned(clause); });
  }

  bool pous() {
    bool changed = thin([](Program& p) -> auto& { return p.pous; });
    for (size_t i = 0; i < Lists(program_).methods.size(); ++i) {
      changed = thin([i](Program& p) -> auto& { return *Lists(p).methods[i]; }) || changed;
    }
    changed = thin([](Program& p) -> auto& { return p.accesses; }) || changed;
    changed = thin([](Program& p) -> auto& { return p.configured; }) || changed;
    changed = thin([](Program& p) -> auto& { return p.tasks; }) || changed;
    changed = thin([](Program& p) -> auto& { return p.declared; }) || changed;
    return thin([](Program& p) -> auto& { return p.globals; }) || changed;
  }

  bool statements() {
    bool changed = false;
    for (size_t i = 0; i < Lists(program_).statements.size(); ++i) {
      changed = thin([i](Program& p) -> auto& { return *Lists(p).statements[i]; }) || changed;
    }
    return changed;
  }

  // Drops branches; puts the body of a branch in the statement's place.
  bool clauses() {
    bool changed = false;
    for (size_t i = 0; i < Lists(program_).single.size(); ++i) {
      changed = thin([i](Program& p) -> auto& { return Lists(p).single[i]->clauses; }) || changed;
    }
    for (size_t i = 0; i < Lists(program_).statements.size(); ++i) {
      for (size_t at = 0; at < Lists(program_).statements[i]->size(); ++at) {
        changed = hoist(i, at) || changed;
      }
    }
    return changed;
  }

  bool hoist(size_t list, size_t at) {
    size_t count = (*Lists(program_).statements[list])[at].clauses.size();
    for (size_t branch = 0; branch < count; ++branch) {
      bool done = attempt([&](Program& copy) {
        std::vector<Stmt>& target = *Lists(copy).statements[list];
        std::vector<Stmt> body = target[at].clauses[branch].body;
        if (body.empty() || pinned_inside(target[at])) return false;
        auto place = target.erase(target.begin() + static_cast<ptrdiff_t>(at));
        target.insert(place, body.begin(), body.end());
        return true;
      });
      if (done) return true;
    }
    return false;
  }

  bool expressions() {
    bool changed = false;
    for (size_t i = 0; i < Lists(program_).expressions.size(); ++i) {
      while (simplify(i)) changed = true;
    }
    return changed;
  }

  bool simplify(size_t at) {
    const Expr& expr = *Lists(program_).expressions[at];
    if (expr.operands.empty() && expr.pattern.size() <= 4) return false;
    if (expr.type != kNoType && !expr.fixed) {
      if (!expr.operands.empty() || !expr.constant) {
        bool done = attempt([&](Program& copy) {
          Expr& place = *Lists(copy).expressions[at];
          std::string plain = plainest(copy, place.type);
          if (plain.empty() || plain == place.pattern) return false;
          place = Expr{place.type, plain, {}, true, false};
          return true;
        });
        if (done) return true;
      }
      for (size_t operand = 0; operand < expr.operands.size(); ++operand) {
        if (replace_by_operand(at, operand)) return true;
      }
    }
    if (expr.pattern.find("@*") == std::string::npos) return false;
    return thin([at](Program& p) -> auto& { return Lists(p).expressions[at]->operands; });
  }

  bool replace_by_operand(size_t at, size_t operand) {
    return attempt([&](Program& copy) {
      Expr& place = *Lists(copy).expressions[at];
      Expr inner = place.operands[operand];
      if (inner.type != place.type) return false;
      place = std::move(inner);
      return true;
    });
  }

  static std::string plainest(const Program& program, TypeRef ref) {
    const Type& type = program[ref];
    switch (type.form) {
      case Form::kString:
        return "''";
      case Form::kWstring:
        return "\"\"";
      case Form::kEnum:
        return type.literals[0];
      case Form::kSubrange:
        return std::to_string(std::max<int64_t>(type.low, std::min<int64_t>(type.high, 1)));
      case Form::kElementary:
        break;
      default:
        return "";
    }
    switch (ir::elementary_group(static_cast<ir::Kind>(ref))) {
      case ir::Group::kBit:
        return ref == elementary(ir::Kind::kBool) ? "TRUE" : type.name + "#1";
      case ir::Group::kSigned:
      case ir::Group::kUnsigned:
        return type.name + "#1";
      case ir::Group::kReal:
        return type.name + "#1.0";
      case ir::Group::kDuration:
        return ref == elementary(ir::Kind::kTime) ? "T#1s" : "LT#1s";
      default:
        return "";
    }
  }

  bool declarations() {
    bool changed = false;
    for (size_t i = 0; i < Lists(program_).variables.size(); ++i) {
      changed = thin([i](Program& p) -> auto& { return *Lists(p).variables[i]; }) || changed;
    }
    for (size_t i = 0; i < Lists(program_).declarations.size(); ++i) {
      changed = attempt([&](Program& copy) {
                  Variable& one = *Lists(copy).declarations[i];
                  if (!one.initial && one.address.empty()) return false;
                  one.initial.reset();
                  one.address.clear();
                  return true;
                }) ||
                changed;
    }
    return changed;
  }

  Program program_;
  const StillFails& fails_;
};

}  // namespace

Program shrink(Program program, const StillFails& fails) {
  return Shrinker(std::move(program), fails).run();
}

}  // namespace differential
