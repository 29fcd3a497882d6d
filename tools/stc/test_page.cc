#include "tools/stc/test_page.h"

#include "frontend/sema/tests/test_calls.h"

namespace stc {
namespace {

constexpr const char* kTestPage =
    R"(Unit tests are written in ST, and `stc test` runs them. docs/UNIT-TESTS.md has
examples.

  TEST 'pump starts'          a test; it starts from fresh values, at time 0
  VAR uut : Pump; END_VAR     instances of function blocks, and of PROGRAMs
    uut(run := TRUE);         one scan; then 5 s of virtual time
    ADVANCE_TIME(T#5s);
    uut(run := TRUE);
    ASSERT_EQ(uut.speed, 10);
  END_TEST

Around tests
  SETUP ... END_SETUP         in front of each test of the file; its variables
                              are variables of each test
  TEARDOWN ... END_TEARDOWN   behind each test of the file, also after a failure

What a test reaches
  uut.sensor.level            all variables inside, private ones and outputs, to
                              read and to set; PRIVATE and PROTECTED methods
  Main(); Main.presses        a program by its name, and what is inside
  Button := TRUE;             inputs (%I) are set as variables are

Mocks
  MOCK uut.sensor;            the body of this instance does nothing; calls are
                              counted, outputs are what the test sets
  MOCK_FUNCTION F RETURNS 3;  from here on F gives 3
  MOCK_FUNCTION F : INT       F with another body, for this test; outside of a
    VAR_INPUT a : INT; END_VAR  TEST for all tests of the file
    F := a + 1;
  END_MOCK_FUNCTION

Calls of tests
)";

}  // namespace

std::string test_page() {
  std::string page = kTestPage;
  for (const frontend::TestCallRow& row : frontend::test_calls()) {
    std::string parameters(row.parameters);
    const size_t last = parameters.rfind(", message");
    if (last != std::string::npos) parameters.replace(last, std::string::npos, " [, message]");
    page += "  " + std::string(row.name) + "(" + parameters + ")\n      " +
            std::string(row.meaning) + "\n";
  }
  return page;
}

}  // namespace stc
