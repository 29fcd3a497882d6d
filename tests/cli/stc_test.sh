#!/bin/sh
# stc test: tests in the language on virtual time.
. "$(dirname "$0")/lib.sh"

cat >pump.st <<'ST'
FUNCTION ReadTemperature : REAL
VAR_INPUT channel : INT; END_VAR
ReadTemperature := 20.0 + INT_TO_REAL(channel);
END_FUNCTION

FUNCTION_BLOCK Pump
VAR_INPUT run : BOOL; END_VAR
VAR_OUTPUT speed : INT; hot : BOOL; END_VAR
VAR delay : TON; END_VAR
delay(IN := run, PT := T#5s);
IF delay.Q THEN speed := 10; ELSE speed := 0; END_IF
hot := ReadTemperature(1) > 50.0;
END_FUNCTION_BLOCK
ST

cat >pump_test.st <<'ST'
SETUP
VAR uut : Pump; END_VAR
uut(run := FALSE);
END_SETUP

TEST 'starts after five seconds'
uut(run := TRUE);
ASSERT_EQ(uut.speed, 0);
ADVANCE_TIME(T#5s);
uut(run := TRUE);
ASSERT_EQ(uut.speed, 10);
END_TEST

TEST 'every test begins anew'
ASSERT_EQ(uut.speed, 0);
ASSERT_NEQ(uut.speed, 1);
ASSERT_LT(uut.speed, 1);
ASSERT_LE(uut.speed, 0);
ASSERT_GT(1, uut.speed);
ASSERT_GE(0, uut.speed);
ASSERT_FALSE(uut.hot);
ASSERT_NEAR(ReadTemperature(2), 22.01, 0.02);
END_TEST

TEST 'a mocked function'
MOCK_FUNCTION ReadTemperature RETURNS 77.0;
uut();
ASSERT_TRUE(uut.hot);
MOCK_VERIFY_CALLED(ReadTemperature);
MOCK_VERIFY_CALL_COUNT(ReadTemperature, 2);
END_TEST

TEST 'a mocked function with a body'
MOCK_FUNCTION ReadTemperature : REAL
VAR_INPUT channel : INT; END_VAR
ReadTemperature := INT_TO_REAL(channel) * 100.0;
END_MOCK_FUNCTION
ASSERT_EQ(ReadTemperature(3), 300.0);
END_TEST

TEST 'a mocked block'
MOCK uut;
uut(run := TRUE);
ADVANCE_TIME(T#9s);
uut(run := TRUE);
ASSERT_EQ(uut.speed, 0);
MOCK_VERIFY_CALL_COUNT(uut, 3);
END_TEST
ST

expect 0 stc test pump.st pump_test.st
said '5 passed, 0 failed'
said 'PASS .*starts after five seconds.*pump_test.st:6'

cat >wrong_test.st <<'ST'
TEST 'too early'
VAR uut : Pump; END_VAR
uut(run := TRUE);
ASSERT_EQ(uut.speed, 10, 'speed & delay');
END_TEST

TEST 'strings'
ASSERT_EQ(CONCAT('ab', 'c'), 'abd');
END_TEST

TEST 'division'
VAR a, b : INT; END_VAR
a := 1 / b;
END_TEST

TEST 'endless'
WHILE TRUE DO ; END_WHILE
END_TEST
ST
expect 1 stc test pump.st wrong_test.st
said '0 passed, 2 failed, 2 stopped by a trap'
said 'wrong_test.st:4: speed & delay: expected 10, got 0'
said "wrong_test.st:8: expected 'abd', got 'abc'"
said 'wrong_test.st:13: division or MOD by zero'
said 'wrong_test.st:17: the task ran too long'

expect 0 stc test pump.st pump_test.st --filter '*mocked b*'
said '1 passed'
expect 1 stc test pump.st pump_test.st --filter nothing
said 'no test matches'
expect 0 stc test pump.st pump_test.st --list
said 'pump_test.st:6: starts after five seconds'

expect 1 stc test pump.st wrong_test.st --format tap
said '^1\.\.4'
said '^not ok 1 - too early'
expect 1 stc test pump.st wrong_test.st --format junit
said 'tests="4" failures="2" errors="2"'
said 'message="speed &amp; delay: expected 10, got 0"'
expect 1 stc test pump.st wrong_test.st --format json
said '"failed":2'
expect 1 stc test pump.st wrong_test.st --format junit --output report.xml
said '0 passed, 2 failed'
grep -q '</testsuites>' report.xml || fail "no report"
# What cannot be run is no pass, and the report of the run before does not stay.
printf 'FUNCTION f : INT f := x; END_FUNCTION\n' >broken.st
expect 1 stc test pump.st pump_test.st broken.st --format junit --output report.xml
grep -q 'tests="1" failures="0" errors="1"' report.xml || fail "$(cat report.xml)"
grep -q '<error type="E[0-9]*" message=.*>broken.st:1: ' report.xml || fail "$(cat report.xml)"
expect 1 stc test pump.st pump_test.st broken.st --format tap
said '^not ok 1 - broken.st:1 compiles'
expect 7 stc test nothing_there.st --format junit --output report.xml
grep -q '<error type="R0501" message="nothing_there.st: no such .*">nothing_there.st: no' report.xml ||
  fail "$(cat report.xml)"
expect 7 stc test nothing_there.st --output report.txt
grep -q 'nothing_there.st: no such' report.txt || fail "no report"
expect 2 stc test pump.st pump_test.st --format xml
said 'is text, tap, junit or json, not .xml.'

# Outside of tests nothing may set the clock; a plain build takes no notice of tests.
printf 'PROGRAM p ADVANCE_TIME(T#1s); END_PROGRAM\n' >outside.st
expect 1 stc check outside.st
said 'E8002'
printf 'TEST %s MOCK_FUNCTION SIN RETURNS 0.5; END_TEST\n' "'m'" >mock.st
expect 1 stc test mock.st
said 'E8001'
printf 'PROGRAM Main VAR n : INT; END_VAR n := n + 1; END_PROGRAM\n' >main.st
expect 0 stc build main.st pump.st pump_test.st -o main.img

# TEARDOWN runs behind whatever the test did, and a trap keeps its place.
cat >teardown_test.st <<'ST'
FUNCTION_BLOCK Gate
VAR_INPUT d : INT; END_VAR
VAR_OUTPUT q : INT; closed : INT; END_VAR
q := 10 / d;
END_FUNCTION_BLOCK
SETUP
VAR g : Gate; END_VAR
END_SETUP
TEARDOWN
g.d := 1;
ASSERT_NEQ(g.q, 5, 'the teardown saw 5');
END_TEARDOWN
TEST 'a trap'
g(d := 0);
END_TEST
TEST 'a return'
g(d := 2);
IF g.q = 5 THEN RETURN; END_IF
END_TEST
TEST 'fine'
g(d := 5);
END_TEST
ST
expect 1 stc test teardown_test.st
said '1 passed, 1 failed, 1 stopped by a trap'
said 'teardown_test.st:4: division or MOD by zero'
said 'teardown_test.st:11: the teardown saw 5'

# Methods, FB_Init with arguments, calls through references to a base, mocks of derived blocks.
cat >objects_test.st <<'ST'
FUNCTION_BLOCK Pump
VAR_INPUT run : BOOL; END_VAR
VAR_OUTPUT speed : INT; END_VAR
VAR start : INT; END_VAR
METHOD FB_Init : BOOL VAR_INPUT bInitRetains, bInCopyCode : BOOL; s : INT; END_VAR start := s; END_METHOD
METHOD Stop speed := 0; END_METHOD
IF run THEN speed := start; END_IF
END_FUNCTION_BLOCK
FUNCTION_BLOCK Turbo EXTENDS Pump
METHOD OVERRIDE Stop speed := -1; END_METHOD
SUPER^();
END_FUNCTION_BLOCK
TEST 'methods'
VAR uut : Turbo(10); plain : Pump(3); r : REFERENCE TO Pump; END_VAR
uut(run := TRUE); ASSERT_EQ(uut.speed, 10);
r REF= uut; r.Stop(); ASSERT_EQ(uut.speed, -1);
plain(run := TRUE); plain.Stop(); ASSERT_EQ(plain.speed, 0);
MOCK uut; uut(run := TRUE); ASSERT_EQ(uut.speed, -1);
MOCK_VERIFY_CALL_COUNT(uut, 2);
END_TEST
ST
expect 0 stc test objects_test.st
said '1 passed, 0 failed'

# Namespaces: a test inside of one sees its INTERNAL names; MOCK_FUNCTION takes whole names.
cat >space_test.st <<'ST'
NAMESPACE Plant
FUNCTION Read : INT Read := 1; END_FUNCTION
FUNCTION INTERNAL Sum : INT VAR_INPUT a : INT; END_VAR Sum := a + Read(); END_FUNCTION
FUNCTION_BLOCK Pump VAR_OUTPUT n : INT; END_VAR n := Sum(10); END_FUNCTION_BLOCK
TEST 'inside' MOCK_FUNCTION Read RETURNS 5; ASSERT_EQ(Sum(1), 6); MOCK_VERIFY_CALL_COUNT(Plant.Read, 1); END_TEST
END_NAMESPACE
FUNCTION Read : INT Read := 100; END_FUNCTION
TEST 'outside'
VAR p : Plant.Pump; END_VAR
MOCK_FUNCTION Plant.Read : INT Read := 7; END_MOCK_FUNCTION
p();
ASSERT_EQ(p.n, 17);
ASSERT_EQ(Read(), 100);
END_TEST
TEST 'with USING'
USING Plant;
VAR p : Pump; END_VAR
MOCK p;
MOCK_FUNCTION Plant.Read RETURNS 2;
p();
ASSERT_EQ(p.n, 0);
ASSERT_EQ(Plant.Read(), 2);
ASSERT_EQ(Read(), 100);
END_TEST
ST
expect 0 stc test space_test.st
said '3 passed, 0 failed'
