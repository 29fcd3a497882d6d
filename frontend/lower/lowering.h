// Store: one body on its way to code. The POU that it belongs to, the IR that is written, and what
// stands around the current statement. It reports nothing and decides nothing: the phases of
// lowering (body_phase.h) share it, and it lives as long as one body is lowered.
#pragma once

#include <array>
#include <unordered_map>
#include <utility>
#include <vector>

#include "frontend/lower/builder.h"
#include "frontend/lower/counting.h"
#include "frontend/lower/line_finder.h"
#include "frontend/lower/value_code.h"
#include "frontend/sema/sema.h"

namespace frontend {

// What surrounds the current statement, innermost last: where EXIT, CONTINUE, RETURN and JMP go,
// and through which __FINALLY.
struct Flow {
  struct Loop {
    ir::BlockId again;
    ir::BlockId exit;
    size_t tries;  // that are around it
    bool left;     // by EXIT, RETURN or JMP in its body
  };
  using Labels = NameMap<ir::BlockId>;
  struct LabelList {  // of a list of statements
    Labels labels;
    size_t tries;
  };
  struct Try {           // a __TRY whose body the current statement stands in
    struct Exit {        // a way out that goes on after the __FINALLY
      ir::BlockId to;    // invalid: out of the POU
      size_t tries = 0;  // scopes that are around it
    };
    ir::BlockId outer;  // the handler around it
    ir::BlockId finally;
    ir::Place where;  // trap kind, or kTrapCount + number of an exit
    std::vector<Exit> exits;
    bool eno = false;  // of a call with ENO: string functions out of range trap
  };

  std::vector<Loop> loops;
  std::vector<LabelList> labels;
  std::vector<Try> tries;
  ir::BlockId exit;  // what RETURN goes to; invalid: out of the POU
  std::vector<VarId> for_variables;
};

struct Lowering {
  Lowering(Sema& all, PouInfo& pou_info, uint32_t pou_number, ir::Pou pou)
      : sema(all), info(pou_info), number(pou_number), out(std::move(pou)) {}
  Lowering(const Lowering&) = delete;
  Lowering& operator=(const Lowering&) = delete;

  Sema& sema;
  PouInfo& info;
  const uint32_t number;    // in Declarations::pous; kNoPou: an expression that is evaluated
  bool evaluating = false;  // then names stand for their initial values

  ir::Pou out;
  Builder build{out};
  LineFinder lines{sema.sources};
  Counting counting{build, sema.tree, info};
  ValueCode code{build, sema.program.types, sema.options.dialect};

  Flow flow;
  // The current results of an instruction list, by number of the kResult.
  std::unordered_map<uint32_t, Typed> result_values;
  std::unordered_map<uint32_t, ir::Place> result_places;
  // Locals that messages of failed assertions are put together in.
  static constexpr uint32_t kNoLocal = 0xffffffffu;
  std::array<uint32_t, 3> message_buffers{kNoLocal, kNoLocal, kNoLocal};
};

}  // namespace frontend
