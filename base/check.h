// check(): an invariant that stays on in every build; a failure prints what was expected and
// aborts. dcheck(): the same where asking costs: in hot loops, and for walks over whole tables. It
// is on in debug builds, under sanitizers, and in the hard mode (preset `hard`), in which all tests
// run. Neither is for bad input: that gets an Error or a diagnostic.
//
// A boundary is checked in pairs: who writes a table checks what the reader will rely on, and the
// reader checks it again, by the same function where there is one.
#pragma once

#include <source_location>
#include <type_traits>

namespace base {

#if defined(NDEBUG) && !defined(STC_HARD)
inline constexpr bool kHardChecks = false;
#else
inline constexpr bool kHardChecks = true;
#endif

[[noreturn]] void check_failed(const char* what, std::source_location where);

inline void check(bool holds, const char* what,
                  std::source_location where = std::source_location::current()) {
  if (!holds) [[unlikely]] {
    check_failed(what, where);
  }
}

inline void dcheck(bool holds, const char* what,
                   std::source_location where = std::source_location::current()) {
  if constexpr (kHardChecks) check(holds, what, where);
}

// `holds` is called only where dcheck() is on.
template <class Holds>
  requires std::is_invocable_r_v<bool, const Holds&>
inline void dcheck(const Holds& holds, const char* what,
                   std::source_location where = std::source_location::current()) {
  if constexpr (kHardChecks) check(holds(), what, where);
}

}  // namespace base
