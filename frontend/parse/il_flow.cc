// Where the current result is still needed: the next instruction that matters uses it or
// replaces it; labels let it pass, JMP takes it along.
#include "frontend/parse/instruction_list.h"
#include "ir/types/types.h"

namespace frontend {

Parser::InstructionList::Need Parser::InstructionList::need_of(const Instruction& in) {
  switch (in.kind) {
    case Kind::kLabel:
      return Need::kUnknown;
    case Kind::kCall:
    case Kind::kDamaged:
      return Need::kNo;
    case Kind::kOpen:
    case Kind::kClose:
    case Kind::kFunction:
      return Need::kYes;
    case Kind::kOperator:
      break;
  }
  if (in.op->conditional) return Need::kYes;
  switch (in.op->action) {
    case IlAction::kJump:
      return Need::kUnknown;
    case IlAction::kLoad:
    case IlAction::kCall:
    case IlAction::kReturn:
      return Need::kNo;
    default:
      return Need::kYes;
  }
}

// Every instruction is looked at once: a walk stops where it is known, and all that it passed
// become known with it. A circle of jumps needs nothing.
void Parser::InstructionList::find_needs() {
  needs_.assign(list_.size() + 1, Need::kUnknown);
  needs_.back() = Need::kNo;
  for (size_t i = 0; i < list_.size(); ++i) {
    if (list_[i].kind != Kind::kLabel) continue;
    Label found;
    found.index = i;
    labels_.try_emplace(ir::fold_name(list_[i].word.text), found);
  }
  std::vector<bool> passed(list_.size());
  std::vector<size_t> path;
  for (size_t begin = 0; begin < list_.size(); ++begin) {
    size_t at = begin;
    Need need = needs_[at];
    path.clear();
    while (need == Need::kUnknown) {
      need = passed[at] ? Need::kNo : need_of(list_[at]);
      passed[at] = true;
      path.push_back(at);
      if (need != Need::kUnknown) break;
      const Label* target = list_[at].kind == Kind::kLabel ? nullptr : find_label(list_[at].target);
      bool lost = list_[at].kind != Kind::kLabel && target == nullptr;
      at = target == nullptr ? at + 1 : target->index;
      need = lost ? Need::kNo : needs_[at];
    }
    for (size_t i : path) needs_[i] = need;
  }
}

Parser::InstructionList::Label* Parser::InstructionList::find_label(const Name& name) {
  auto found = labels_.find(ir::fold_name(name.text));
  return found == labels_.end() ? nullptr : &found->second;
}

}  // namespace frontend
