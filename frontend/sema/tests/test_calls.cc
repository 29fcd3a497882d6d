#include "frontend/sema/tests/test_calls.h"

#include "ir/types/types.h"

namespace frontend {
namespace {

constexpr TestCallRow kTestCalls[] = {
#define TEST_CALL(id, name, fewest, most, parameters, meaning) \
  {TestCall::id, name, fewest, most, parameters, meaning},
#include "frontend/sema/tests/test_calls.def"
#undef TEST_CALL
};

}  // namespace

std::span<const TestCallRow> test_calls() { return kTestCalls; }

const TestCallRow* find_test_call(std::string_view name) {
  for (const TestCallRow& row : kTestCalls) {
    if (ir::same_name(row.name, name)) return &row;
  }
  return nullptr;
}

}  // namespace frontend
