#include "frontend/finished_bodies.h"

#include <algorithm>

#include "frontend/sema/phase.h"
#include "frontend/sema/types/conversion.h"

namespace frontend {

namespace {

constexpr uint32_t kKept = 0xffffffffu;

// May a call that is lowered later need this body again, for other types of its parameters?
bool may_have_instances(Sema& sema, const PouInfo& info) {
  return info.open || std::any_of(info.variables.begin(), info.variables.end(), [&](VarId id) {
           const Variable& variable = Phase(sema).resolve(id);
           return variable.section == VarSection::kInOut &&
                  (!variable.type.valid() || is_string(sema.program.types, variable.type));
         });
}

}  // namespace

FinishedBodies::FinishedBodies(Sema& sema, Tree& tree) : sema_(sema), tree_(tree) {
  constexpr uint32_t kChunk = ExprStore::kChunk;
  left_.resize(tree.pous.size());
  open_.resize((tree.exprs.of_bodies() + kChunk - 1) / kChunk);
  for (uint32_t top = 0; top < tree.pous.size(); ++top) {
    const PouDecl& pou = tree.pous[top];
    number(pou, top);
    if (pou.exprs.count == 0) continue;
    const uint32_t last = (pou.exprs.first + pou.exprs.count - 1) / kChunk;
    for (uint32_t chunk = pou.exprs.first / kChunk; chunk <= last; ++chunk) ++open_[chunk];
  }
  for (const PouInfo& info : sema.declared.pous) {
    const auto top = top_of_.find(info.decl);
    if (top == top_of_.end()) continue;
    uint32_t& left = left_[top->second];
    const bool kept = left == kKept || !info.id.valid() || may_have_instances(sema, info);
    left = kept ? kKept : left + 1;
  }
}

void FinishedBodies::number(const PouDecl& pou, uint32_t top) {
  top_of_.emplace(&pou, top);
  for (const PouDecl& member : pou.members) number(member, top);
}

void FinishedBodies::finish(uint32_t pou) {
  const auto top = top_of_.find(sema_.declared.pous[pou].decl);
  if (top == top_of_.end()) return;
  uint32_t& left = left_[top->second];
  // A body that came later (an instance, or one of the library) was not counted: its POU stays.
  if (left == kKept || left == 0) return;
  if (--left == 0) give_back(tree_.pous[top->second]);
}

void FinishedBodies::give_back(const PouDecl& pou) {
  constexpr uint32_t kChunk = ExprStore::kChunk;
  if (pou.exprs.count == 0) return;
  const uint32_t last = (pou.exprs.first + pou.exprs.count - 1) / kChunk;
  for (uint32_t chunk = pou.exprs.first / kChunk; chunk <= last; ++chunk) {
    if (--open_[chunk] != 0) continue;
    sema_.facts.notes.drop(tree_.exprs.chunk_of_bodies(chunk));
    tree_.exprs.give_back_bodies(chunk);
  }
}

}  // namespace frontend
