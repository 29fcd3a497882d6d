// What every answer of a consumer must be: there, or a refusal that says why.
#pragma once

#include "base/check.h"
#include "base/result.h"

namespace fuzz {

inline void must_say_why(const base::Error& error) {
  base::check(!error.text.empty() || error.refusal == base::Refusal::kNoMemory, "a reason");
  base::check(error.refusal != base::Refusal::kInternal,
              "a reason that one can do something about");
}
template <class T>
bool answered(const base::Result<T>& result) {
  if (!result.ok()) must_say_why(result.error());
  return result.ok();
}
inline bool answered(const base::Status& status) {
  if (!status.ok()) must_say_why(status.error());
  return status.ok();
}

}  // namespace fuzz
