// What tests may call (test_calls.def): assertions, virtual time, questions to mocks.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

namespace frontend {

enum class TestCall : uint8_t {
#define TEST_CALL(id, name, fewest, most, parameters, meaning) id,
#include "frontend/sema/tests/test_calls.def"
#undef TEST_CALL
};

struct TestCallRow {
  TestCall call;
  std::string_view name;
  uint32_t fewest;
  uint32_t most;
  std::string_view parameters;
  std::string_view meaning;
};

std::span<const TestCallRow> test_calls();
// Without case; null when there is none.
const TestCallRow* find_test_call(std::string_view name);

}  // namespace frontend
