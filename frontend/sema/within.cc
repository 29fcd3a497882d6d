// Finds out whose names are visible.
#include "frontend/sema/sema.h"

namespace frontend {

Sema::Within::Within(Sema& sema, uint32_t pou)
    : sema_(sema), saved_(sema.current_pou_), saved_meaning_(sema.meaning_) {
  sema_.current_pou_ = pou;
  sema_.meaning_ = pou == kNoPou ? nullptr : sema_.pous[pou].meaning.get();
}

Sema::Within::~Within() {
  sema_.current_pou_ = saved_;
  sema_.meaning_ = saved_meaning_;
}

}  // namespace frontend
