// Fused handlers and their instantiation. The parts (fused_*.cc) have every fourth row of
// fusions.def each, so that they compile at the same time: each defines what its own rows are. Rows
// of other parts are gone before they are parsed.
#pragma once

#include "vm/exec/semantics_arithmetic.h"
#include "vm/exec/semantics_compare.h"
#include "vm/exec/semantics_control.h"
#include "vm/exec/semantics_convert.h"
#include "vm/exec/semantics_logic.h"
#include "vm/exec/semantics_memory.h"
#include "vm/exec/step.h"

namespace vm {

template <class S>
using ResultOf = ValueOf<typename Semantics<S::kOp>::Result>;

template <size_t i, auto written, class Values, class... S>
struct Steps {
  STC_INLINE Flow take(Machine&, Values&) { return Flow::kOn; }
};
template <size_t i, auto written, class Values, class First, class... Rest>
struct Steps<i, written, Values, First, Rest...> {
  STC_INLINE Flow take(Machine& m, Values& values) {
    const Flow flow = take_step<First::kOp, written[i], First::kA, First::kB, First::kC>(
        m, values, std::get<i>(values));
    if (flow != Flow::kOn) return flow;
    return Steps<i + 1, written, Values, Rest...>::take(m, values);
  }
};

template <class... S>
void fused(STC_HANDLER_ARGS) {
  using Values = std::tuple<ResultOf<S>...>;
  Machine m = STC_MACHINE;
  Values values;
  const Flow flow = Steps<0, written_bases<S...>(), Values, S...>::take(m, values);
  if (stops(flow)) [[unlikely]]
    return leave(m, flow);
  STC_GO(m.pc, m.frame, m.self);
}

namespace fusion_rows {
namespace {

#ifndef STC_ROW_0
#define STC_ROW_0(...)
#endif
#ifndef STC_ROW_1
#define STC_ROW_1(...)
#endif
#ifndef STC_ROW_2
#define STC_ROW_2(...)
#endif
#ifndef STC_ROW_3
#define STC_ROW_3(...)
#endif

// Keeps the handlers of this part; handlers.cc names them.
[[gnu::used]] constinit const Handler kPart[] = {
#define FUSION(part, ...) STC_ROW_##part(__VA_ARGS__)
#include "vm/exec/fusions.def"
#undef FUSION
    nullptr};

}  // namespace
}  // namespace fusion_rows

}  // namespace vm
