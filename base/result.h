// Result<T>: a value or an Error. The only way failure crosses a module
// boundary; no exceptions. An Error carries a refusal code from refusals.def
// and one sentence that says what happened, where, and what to do.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <variant>

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

template <class T>
class [[nodiscard]] Result {
 public:
  Result(T value) : data_(std::in_place_index<0>, std::move(value)) {}
  Result(Error error) : data_(std::in_place_index<1>, std::move(error)) {}

  bool ok() const { return data_.index() == 0; }
  explicit operator bool() const { return ok(); }

  T& value() & {
    check(ok(), "value() of a failed Result");
    return *std::get_if<0>(&data_);
  }
  const T& value() const& {
    check(ok(), "value() of a failed Result");
    return *std::get_if<0>(&data_);
  }
  T&& value() && {
    check(ok(), "value() of a failed Result");
    return std::move(*std::get_if<0>(&data_));
  }
  const Error& error() const {
    check(!ok(), "error() of a good Result");
    return *std::get_if<1>(&data_);
  }
  T* operator->() { return &value(); }
  const T* operator->() const { return &value(); }
  T& operator*() & { return value(); }
  const T& operator*() const& { return value(); }
  T&& operator*() && { return std::move(*this).value(); }

 private:
  std::variant<T, Error> data_;
};

struct Ok {};
using Status = Result<Ok>;

}  // namespace base
