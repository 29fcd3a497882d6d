// Initial values as trees that know nothing of layout. A ConstTable owns them.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "ir/types/types.h"

namespace ir {

struct ConstElement {
  uint32_t first = 0;  // member index, or flat element index (last dimension fastest)
  uint32_t count = 1;  // how many consecutive elements take this value
  ConstId value;
};

// Which field counts follows from the type that the value is for.
struct ConstValue {
  uint64_t bits = 0;                   // scalars: low bytes, sign-extended; REAL as f32 bits
  std::string text;                    // STRING: its bytes; WSTRING: UTF-16LE bytes
  std::vector<ConstElement> elements;  // aggregates and function block instances; what
                                       // is not named takes the type's default
};

class ConstTable {
 public:
  ConstId add(ConstValue value) {
    if (next_ == size()) {
      values_.push_back(std::move(value));
    } else {
      values_[next_] = std::move(value);
    }
    return ConstId(next_++);
  }
  // The number that the next value gets. Setting it back lets code that is made anew give its
  // constants the numbers that they had.
  uint32_t next() const { return next_; }
  void set_next(uint32_t next) { next_ = next; }
  ConstId scalar(uint64_t bits) { return add({bits, {}, {}}); }
  const ConstValue& operator[](ConstId id) const { return values_[id.index]; }
  uint32_t size() const { return static_cast<uint32_t>(values_.size()); }
  void reserve(uint32_t count) { values_.reserve(count); }
  bool contains(ConstId id) const { return id.index < values_.size(); }

 private:
  std::vector<ConstValue> values_;
  uint32_t next_ = 0;
};

// The initial value of a type whose members overlap (TypeTable::overlaps): what is written to
// which member, each time over all of its bytes, one after the other. First members that say
// nothing, the last one first; then those declared with an initial value; then what the type's
// own list names, then what `value` names.
struct MemberInit {
  size_t member = 0;
  ConstId value;  // invalid: the default of the member's type
};
std::vector<MemberInit> overlap_inits(const TypeTable& types, const ConstTable& constants,
                                      TypeId type, ConstId value);

}  // namespace ir
