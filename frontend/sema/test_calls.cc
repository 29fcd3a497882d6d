#include "frontend/sema/test_calls.h"

#include "ir/types/types.h"

namespace frontend {
namespace {

constexpr TestCallRow kRows[] = {
#define TEST_CALL(id, name, fewest, most, parameters) \
  {TestCall::id, name, fewest, most, parameters},
#include "frontend/sema/test_calls.def"
#undef TEST_CALL
};

}  // namespace

const TestCallRow* find_test_call(std::string_view name) {
  for (const TestCallRow& row : kRows) {
    if (ir::same_name(row.name, name)) return &row;
  }
  return nullptr;
}

}  // namespace frontend
