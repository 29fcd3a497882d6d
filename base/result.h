// Result<T>: a value or an Error. The only way failure crosses a module
// boundary; no exceptions. An Error carries a refusal code from refusals.def
// and one sentence that says what happened, where, and what to do.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>

#include "base/check.h"

namespace base {

// Every reason for which the linker, the verifier, a change, the controller or
// a tool refuses something. The table is refusals.def; `stc explain` reads it.
enum class Refusal : uint16_t {
#define NAME(id) id,
#include "base/refusals.def.names"
#undef NAME
};

const char* refusal_code(Refusal refusal);   // "R0101"
const char* refusal_title(Refusal refusal);  // short, one line
const char* refusal_help(Refusal refusal);   // what to do about it
std::optional<Refusal> refusal_from_code(std::string_view code);

struct Error {
  Refusal refusal;
  std::string text;
};

// "R0101: text", the form in which tools print an Error.
std::string to_string(const Error& error);

// A union of its own: hundreds of types are results, and std::variant would make some sixty
// functions for each.
template <class T>
class [[nodiscard]] Result {
 public:
  Result(T value) : ok_(true), value_(std::move(value)) {}
  Result(Error error) : ok_(false), error_(std::move(error)) {}
  Result(const Result& other) : ok_(other.ok_) { take(other); }
  Result(Result&& other) noexcept(std::is_nothrow_move_constructible_v<T>) : ok_(other.ok_) {
    take(std::move(other));
  }
  Result& operator=(Result other) noexcept(std::is_nothrow_move_constructible_v<T>) {
    clear();
    ok_ = other.ok_;
    take(std::move(other));
    return *this;
  }
  ~Result() { clear(); }

  bool ok() const { return ok_; }
  explicit operator bool() const { return ok_; }

  T& value() & {
    check(ok_, "value() of a failed Result");
    return value_;
  }
  const T& value() const& {
    check(ok_, "value() of a failed Result");
    return value_;
  }
  T&& value() && {
    check(ok_, "value() of a failed Result");
    return std::move(value_);
  }
  const Error& error() const {
    check(!ok_, "error() of a good Result");
    return error_;
  }
  T* operator->() { return &value(); }
  const T* operator->() const { return &value(); }
  T& operator*() & { return value(); }
  const T& operator*() const& { return value(); }
  T&& operator*() && { return std::move(*this).value(); }

 private:
  template <class Other>
  void take(Other&& other) {
    if (ok_) {
      new (&value_) T(std::forward<Other>(other).value_);
    } else {
      new (&error_) Error(std::forward<Other>(other).error_);
    }
  }
  void clear() {
    if (ok_) {
      value_.~T();
    } else {
      error_.~Error();
    }
  }

  bool ok_;
  union {
    T value_;
    Error error_;
  };
};

struct Ok {};
using Status = Result<Ok>;

}  // namespace base
