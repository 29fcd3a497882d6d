#include "frontend/lower/body.h"
#include "frontend/lower/chart.h"
#include "frontend/lower/frame.h"
#include "frontend/lower/mock_code.h"
#include "frontend/lower/pool_code.h"
#include "frontend/lower/start_code.h"
#include "frontend/lower/statements.h"
#include "frontend/lower/try_code.h"

namespace frontend {
namespace {

// A body from its first instruction to its last.
class WholeBody : public BodyPhase {
 public:
  using BodyPhase::BodyPhase;
  void write();

 private:
  void begin();
  void write_before_test();
  void write_code();
  void end();
};

void WholeBody::begin() {
  const PouDecl& decl = *info_.decl;
  const base::SourceLocation head = sema_.sources.locate(decl.span.begin);
  body_.out.file = head.file;
  body_.out.line = head.line;
  body_.lines.begin(decl.span.begin, head.line);
  if (info_.made == MadeCode::kNone) body_.out.content = decl.content;
  build_.set_line(head.line);
}

void WholeBody::write() {
  begin();
  ask<Frame>().initialise_locals();
  ask<Frame>().connect_inputs();
  ask<Frame>().detect_edges();
  ask<MockCode>().mock_prologue();
  const bool written = info_.made == MadeCode::kNone && !info_.test && !info_.library;
  if (written) body_.counting.begin(sema_.options.coverage, body_.out.name);
  if (info_.test && info_.decl->kind == PouKind::kProgram) write_before_test();
  if (!info_.connections.empty()) body_.flow.exit = build_.new_block();
  write_code();
  end();
}

// SETUP. And TEARDOWN, which is a run of its own, so that nothing that ends the test is in its way.
void WholeBody::write_before_test() {
  const auto due = [&] { return global_place(sema_.tests.teardown); };
  if (info_.teardown != nullptr) {
    const ir::BlockId teardown = build_.new_block();
    const ir::BlockId test = build_.new_block();
    build_.branch(build_.load(due(), ir::Scalar::kBool), teardown, test);
    build_.start(teardown);
    ask<Statements>().write(info_.teardown->body);
    if (build_.reachable()) build_.ret();
    build_.start(test);
  }
  ask<MockCode>().activate_mock_bodies();
  if (info_.setup != nullptr) ask<Statements>().write(info_.setup->body);
  if (info_.teardown != nullptr && build_.reachable()) {
    build_.store(due(), ir::Scalar::kBool, build_.constant(ir::Scalar::kBool, 1));
  }
}

void WholeBody::write_code() {
  const PouDecl& decl = *info_.decl;
  if (info_.made == MadeCode::kStart) {
    ask<StartCode>().run();
  } else if (info_.made == MadeCode::kReset) {
    ask<PoolCode>().reset_method();
  } else if (info_.made == MadeCode::kLeave) {
    ask<PoolCode>().leave_method();
  } else if (decl.chart != kNoChart) {
    ChartBody(body_, scope_, tree_.charts[decl.chart]).run();
  } else {
    ask<Statements>().write(decl.body);
  }
}

void WholeBody::end() {
  const PouDecl& decl = *info_.decl;
  // A prototype: no virtual call ends here.
  const bool prototype =
      info_.owner != kNoPou &&
      (decl.is_abstract || sema_.declared.pous[info_.owner].decl->kind == PouKind::kInterface);
  if (prototype && build_.reachable()) build_.trap(ir::TrapKind::kReference);
  set_line({decl.span.end, decl.span.end});
  if (body_.flow.exit.valid()) {
    if (build_.reachable()) build_.jump(body_.flow.exit);
    build_.start(body_.flow.exit);
    ask<Frame>().connect_outputs();
  }
  build_.finish();
}

// Does it write outside of its instance, call others there, or give them a reference to itself?
bool reaches_out(const ir::Pou& pou) {
  std::vector<bool> own(pou.values.size());  // references to the instance or a part of it
  const auto is_own = [&](ir::ValueId value) { return value.valid() && own[value.index]; };
  const auto is_outside = [&](const ir::Place& place) {
    const bool through = std::ranges::any_of(
        place.steps, [](const ir::Step& step) { return step.kind == ir::StepKind::kDeref; });
    const bool target = place.base == ir::PlaceBase::kTarget && !is_own(place.value);
    return through || target || place.base == ir::PlaceBase::kGlobal ||
           place.base == ir::PlaceBase::kPointee;
  };
  for (const ir::Block& block : pou.blocks) {
    for (const ir::Inst& inst : block.insts) {
      const ir::Place place = inst.place.valid() ? pou.places[inst.place.index] : ir::Place();
      switch (inst.op) {
        case ir::Op::kThis:
        case ir::Op::kHandle:
          own[inst.result.index] = inst.op == ir::Op::kThis || !is_outside(place);
          break;
        case ir::Op::kStore:
          if (is_outside(place)) return true;
          if (place.base == ir::PlaceBase::kArg && is_own(inst.operands[0])) return true;
          break;
        case ir::Op::kCopy:
        case ir::Op::kInit:
        case ir::Op::kCallInstance:
          if (is_outside(place)) return true;
          break;
        case ir::Op::kCallMethod:
          if (inst.place.valid() && is_outside(place)) return true;
          if (!inst.operands.empty() && !is_own(inst.operands[0])) return true;
          break;
        case ir::Op::kCallVirtual:
        case ir::Op::kCallReference:
          if (!is_own(inst.operands[0])) return true;
          break;
        default:
          break;
      }
    }
  }
  return false;
}

}  // namespace

void write_body(Sema& sema, uint32_t pou) {
  PouInfo& info = sema.declared.pous[pou];
  Lowering body(sema, info, pou, sema.program.pous[info.id.index]);
  WholeBody(body, PouScope(info)).write();
  if (info.usual_depth != 0) body.out.recursion_depth = info.usual_depth;
  const bool begins = info.owner != kNoPou && ir::same_name(info.decl->name.text, kFbInit);
  info.reaches_out = begins && reaches_out(body.out);
  sema.program.pous[info.id.index] = std::move(body.out);
}

}  // namespace frontend
