#include "tests/differential/edit.h"

#include <algorithm>
#include <cctype>

#include "tests/differential/generator.h"
#include "tests/differential/random.h"

namespace differential {
namespace {

bool is_name(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; }

bool mentions(const std::string& pattern, const std::string& name) {
  for (size_t at = pattern.find(name); at != std::string::npos; at = pattern.find(name, at + 1)) {
    bool begins = at == 0 || !is_name(pattern[at - 1]);
    size_t end = at + name.size();
    if (begins && (end == pattern.size() || !is_name(pattern[end]))) return true;
  }
  return false;
}

bool mentions(const Expr& expr, const std::string& name) {
  return mentions(expr.pattern, name) ||
         std::any_of(expr.operands.begin(), expr.operands.end(),
                     [&](const Expr& operand) { return mentions(operand, name); });
}

class Editor {
 public:
  Editor(Program program, uint64_t seed) : program_(std::move(program)), random_(seed) {}

  Program run() {
    for (uint32_t n = 1 + random_.below(4); n > 0; --n) edit();
    return std::move(program_);
  }

 private:
  void edit() {
    switch (random_.below(11)) {
      case 0:
      case 1:
        return add_variable();
      case 2:
        return remove_variable();
      case 3:
      case 4:
        return retype_variable();
      case 5:
        return reorder();
      case 6:
        return change_type();
      case 7:
        return remove_method();
      case 8:
        return add_override();
      default:
        return change_body();
    }
  }

  template <class T>
  T* pick(std::vector<T>& list) {
    return list.empty() ? nullptr : &list[random_.below(static_cast<uint32_t>(list.size()))];
  }

  // Variables that live on: of programs, function blocks, globals and structures.
  std::vector<Variable>* pick_list() {
    std::vector<std::vector<Variable>*> lists;
    auto lasting = [](Section kind) {
      return kind == Section::kLocal || kind == Section::kRetain || kind == Section::kGlobal ||
             kind == Section::kGlobalRetain;
    };
    for (VarBlock& block : program_.globals) {
      if (lasting(block.section) && !block.variables.empty()) lists.push_back(&block.variables);
    }
    for (TypeRef type : program_.declared) {
      if (program_[type].form == Form::kStruct) lists.push_back(&program_.types[type].members);
    }
    for (Pou& pou : program_.pous) {
      if (pou.kind == PouKind::kFunction) continue;
      for (VarBlock& block : pou.blocks) {
        if (lasting(block.section)) lists.push_back(&block.variables);
      }
    }
    std::vector<Variable>** found = pick(lists);
    return found == nullptr ? nullptr : *found;
  }

  TypeRef any_type() {
    TypeRef any = random_.below(static_cast<uint32_t>(program_.types.size()));
    bool whole = program_[any].form <= Form::kPointer;
    return whole && random_.one_in(4) ? any : random_.below(ir::kElementaryCount);
  }

  void add_variable() {
    std::vector<Variable>* list = pick_list();
    if (list == nullptr) return;
    Variable fresh{"added" + std::to_string(next_++), any_type(), std::nullopt, {}, {}};
    list->insert(list->begin() + random_.below(static_cast<uint32_t>(list->size()) + 1),
                 std::move(fresh));
  }

  void remove_variable() {
    std::vector<Variable>* list = pick_list();
    if (list == nullptr || list->size() < 2) return;
    uint32_t at = random_.below(static_cast<uint32_t>(list->size()));
    std::string name = (*list)[at].name;
    if (is_counter(name)) return;
    list->erase(list->begin() + at);
    forget(name);
  }

  // Loop counters and the guards of WHILE.
  static bool is_counter(const std::string& name) {
    return name.starts_with("loop") || name == "guard" || name == "spare";
  }

  // From scalar to scalar: what a structure becomes when its variable gets another type is left
  // to change_type().
  void retype_variable() {
    std::vector<Variable>* list = pick_list();
    Variable* one = list == nullptr ? nullptr : pick(*list);
    if (one == nullptr || is_counter(one->name) || !one->address.empty()) return;
    const Form form = program_[one->type].form;
    if (form >= Form::kArray) return;
    one->bit = false;
    one->type = random_.below(ir::kElementaryCount);
    one->initial.reset();
    forget(one->name);
  }

  void reorder() {
    std::vector<Variable>* list = pick_list();
    if (list == nullptr) return;
    for (size_t i = list->size(); i > 1; --i) {
      std::swap((*list)[i - 1], (*list)[random_.below(static_cast<uint32_t>(i))]);
    }
  }

  // Bounds, capacities, ranges and literals of a declared type.
  void change_type() {
    TypeRef* ref = pick(program_.declared);
    if (ref == nullptr) return;
    Type& type = program_.types[*ref];
    switch (type.form) {
      case Form::kArray:
        type.dims[0].high += random_.one_in(2) ? 1 : 2;
        if (random_.one_in(3)) type.dims[0].low -= 1;
        return;
      case Form::kEnum:
        if (random_.one_in(2)) return add_literal(type);
        return std::reverse(type.values.begin(), type.values.end());
      case Form::kSubrange:
        if (type.high < 100) type.high += 5;
        return;
      default:
        return;
    }
  }

  void add_literal(Type& type) {
    type.literals.push_back("LitAdded" + std::to_string(next_++));
    type.values.push_back(*std::max_element(type.values.begin(), type.values.end()) + 1);
  }

  Pou* pick_class() {
    std::vector<Pou*> classes;
    for (Pou& pou : program_.pous) {
      if (!pou.methods.empty() && pou.kind != PouKind::kInterface) classes.push_back(&pou);
    }
    Pou** found = pick(classes);
    return found == nullptr ? nullptr : *found;
  }

  static bool has_method(const Pou& pou, const std::string& name) {
    return std::any_of(pou.methods.begin(), pou.methods.end(),
                       [&](const Pou& method) { return method.name == name; });
  }

  // An override: the base's one runs again. Otherwise its calls go, too.
  void remove_method() {
    Pou* pou = pick_class();
    if (pou == nullptr) return;
    uint32_t at = random_.below(static_cast<uint32_t>(pou->methods.size()));
    std::string name = pou->methods[at].name;
    pou->methods.erase(pou->methods.begin() + at);
    bool elsewhere = std::any_of(program_.pous.begin(), program_.pous.end(),
                                 [&](const Pou& one) { return has_method(one, name); });
    if (!elsewhere) forget(name);
  }

  // What extends the class gets a copy of one of its methods, with one statement less.
  void add_override() {
    Pou* base = pick_class();
    if (base == nullptr) return;
    Pou copy = base->methods[random_.below(static_cast<uint32_t>(base->methods.size()))];
    if (copy.words.find("ABSTRACT") != std::string::npos) return;
    if (copy.body.size() > 2 && !copy.body[1].pinned) copy.body.erase(copy.body.begin() + 1);
    for (Pou& pou : program_.pous) {
      bool extends = mentions(pou.relations, base->name) && pou.kind == base->kind;
      if (!extends || has_method(pou, copy.name)) continue;
      pou.methods.push_back(std::move(copy));
      return;
    }
  }

  std::vector<std::vector<Stmt>*> bodies() {
    std::vector<std::vector<Stmt>*> out;
    for (Pou& pou : program_.pous) collect(pou, out);
    return out;
  }
  void collect(Pou& pou, std::vector<std::vector<Stmt>*>& out) {
    collect(pou.body, out);
    collect(pou.members, out);
    for (Pou& method : pou.methods) collect(method, out);
  }
  void collect(std::vector<Stmt>& list, std::vector<std::vector<Stmt>*>& out) {
    out.push_back(&list);
    for (Stmt& one : list) {
      for (Clause& clause : one.clauses) collect(clause.body, out);
    }
  }

  void change_body() {
    std::vector<std::vector<Stmt>*> lists = bodies();
    std::vector<Stmt>** found = pick(lists);
    if (found == nullptr || (*found)->empty()) return;
    std::vector<Stmt>& list = **found;
    uint32_t at = random_.below(static_cast<uint32_t>(list.size()));
    if (list[at].pinned) return;
    switch (random_.below(3)) {
      case 0:
        list.erase(list.begin() + at);
        return;
      case 1: {
        // Twice, if it is cheap: loops multiply.
        Stmt again = list[at];
        if (again.clauses.size() == 1 && again.tail.empty()) {
          list.insert(list.begin() + at, std::move(again));
        }
        return;
      }
      default:
        if (at + 1 < list.size() && !list[at + 1].pinned) std::swap(list[at], list[at + 1]);
        return;
    }
  }

  // Removes statements and initial values that name it; a branch whose condition does goes whole.
  void forget(const std::string& name) {
    for (Pou& pou : program_.pous) forget(pou, name);
    std::erase_if(program_.accesses, [&](const auto& one) { return mentions(one, name); });
    std::erase_if(program_.configured, [&](const auto& one) { return mentions(one, name); });
    for (VarBlock& block : program_.globals) forget(block.variables, name);
    for (TypeRef type : program_.declared) forget(program_.types[type].members, name);
  }
  void forget(Pou& pou, const std::string& name) {
    forget(pou.body, name);
    forget(pou.members, name);
    for (VarBlock& block : pou.blocks) forget(block.variables, name);
    for (Pou& method : pou.methods) forget(method, name);
  }
  void forget(std::vector<Variable>& list, const std::string& name) {
    for (Variable& one : list) {
      if (one.initial && mentions(*one.initial, name)) one.initial.reset();
    }
  }
  void forget(std::vector<Stmt>& list, const std::string& name) {
    std::erase_if(list, [&](const Stmt& one) {
      return std::any_of(one.clauses.begin(), one.clauses.end(), [&](const Clause& clause) {
        return mentions(clause.head, name) ||
               std::any_of(clause.operands.begin(), clause.operands.end(),
                           [&](const Expr& operand) { return mentions(operand, name); });
      });
    });
    for (Stmt& one : list) {
      for (Clause& clause : one.clauses) forget(clause.body, name);
    }
  }

  Program program_;
  Random random_;
  uint32_t next_ = 0;
};

}  // namespace

Program edited(Program program, uint64_t seed) { return Editor(std::move(program), seed).run(); }

}  // namespace differential
