// Finds out whose names are visible.
#include "frontend/sema/sema.h"

namespace frontend {

Sema::Within::Within(Sema& sema, uint32_t pou) : sema_(sema), saved_(sema.scope_) {
  sema_.scope_ = pou == kNoPou ? PouScope() : PouScope(sema_.declared.pous[pou]);
}

Sema::Within::~Within() { sema_.scope_ = saved_; }

}  // namespace frontend
