// Memory that runs out is an answer, not the end: the one place that knows that containers throw.
#pragma once

#include <new>

namespace base {

// The result of `step`; when memory runs out in it, that of `otherwise`, which must not need any.
template <class Step, class Otherwise>
auto within_memory(Step step, Otherwise otherwise) -> decltype(step()) {
  try {
    return step();
  } catch (const std::bad_alloc&) {
    return otherwise();
  }
}

}  // namespace base
