// check(): an invariant that stays on in every build; a failure prints what was
// expected and aborts. dcheck(): the same for hot loops, only in debug builds.
// Neither is for bad input: that gets an Error or a diagnostic.
#pragma once

#include <source_location>

namespace base {

[[noreturn]] void check_failed(const char* what, std::source_location where);

inline void check(bool holds, const char* what,
                  std::source_location where = std::source_location::current()) {
  if (!holds) [[unlikely]] {
    check_failed(what, where);
  }
}

#ifdef NDEBUG
inline void dcheck(bool, const char*) {}
#else
inline void dcheck(bool holds, const char* what,
                   std::source_location where = std::source_location::current()) {
  check(holds, what, where);
}
#endif

}  // namespace base
