#include "ir/bytecode/constant_range.h"

#include <algorithm>

namespace ir {

ConstantRange changed_constants(base::ByteSpan before, base::ByteSpan after) {
  ConstantRange out{0, std::min(before.size(), after.size())};
  while (out.begin < out.end && before[out.begin] == after[out.begin]) ++out.begin;
  while (out.begin < out.end && before[out.end - 1] == after[out.end - 1]) --out.end;
  return out;
}

}  // namespace ir
