#!/bin/sh
# R-11: each mistake that people make in unit tests has a message that says the way out.
. "$(dirname "$0")/lib.sh"
cat >pump.st <<'ST'
FUNCTION_BLOCK Pump
VAR_INPUT run : BOOL; END_VAR
VAR_OUTPUT speed : INT; END_VAR
VAR_IN_OUT tank : INT; END_VAR
VAR_EXTERNAL level : INT; END_VAR
VAR_TEMP t : INT; END_VAR
  t := level + tank;
  IF run THEN speed := t; END_IF
END_FUNCTION_BLOCK
VAR_GLOBAL level : INT; END_VAR
FUNCTION ReadLevel : INT ReadLevel := 3; END_FUNCTION
PROGRAM Main VAR n : INT; in AT %IW2 : WORD; END_VAR n := n + WORD_TO_INT(in); END_PROGRAM
ST
# wrong TEXT REGEX...: each is said of it.
wrong() {
  printf '%s\n' "$1" >x_test.st
  expect 1 stc test pump.st x_test.st
  shift
  for regex in "$@"; do said "$regex"; done
}
body() { text=$1; shift; wrong "TEST 'a' $text END_TEST" "$@"; }

wrong 'TEST pump ; END_TEST' 'E1012' "help: a test has its name in quotes: TEST 'pump starts'"
wrong "TEST '' ; END_TEST" 'E1008.*the test has no name'
wrong "TEST 'a' ; END_TEST TEST 'a' ; END_TEST" 'E2002.*a second test `a`; the first is in line 1' \
  'reports and --filter know tests by it'
wrong "MOCK ReadLevel; TEST 'a' ; END_TEST" 'E1012' \
  'help: put this statement into a TEST or its SETUP'
wrong "SETUP ; END_SETUP SETUP ; END_SETUP TEST 'a' ; END_TEST" 'a second SETUP or TEARDOWN'
wrong 'SETUP ; END_SETUP' 'W0003.*the file has no TEST' 'put it into the file of its tests' \
  'no test in these sources'
body 'ASSERT_EQUAL(1, 2);' 'did you mean `ASSERT_EQ`'
body 'ASSERT_EQ(actual := 1, expected := 2);' 'E4010.*values without a name' \
  'it takes, in this order: actual, expected, message'
body 'ASSERT_TRUE(TRUE, 5);' 'E4006.*the message is `DINT`' 'the text that a failure shows'
body 'ADVANCE_TIME(5);' 'E4006.*the duration is `DINT`' 'write a TIME: ADVANCE_TIME\(T#5s\)'
body 'ADVANCE_TIME(T#-5s);' 'time does not go back'
body 'VAR x : INT; END_VAR MOCK x;' 'E8001.*`INT` is no function block' 'a variable is just set'
body 'MOCK Pump;' 'E8001.*`Pump` is a type, not an instance' 'MOCK uut.sensor;'
body 'MOCK ReadLevel;' 'E8001.*`ReadLevel` is a function' \
  'write MOCK_FUNCTION ReadLevel RETURNS value;'
body 'MOCK_VERIFY_CALLED(ReadLevel);' 'no test mocks the function `ReadLevel`' \
  'MOCK_FUNCTION names the function'
body 'VAR p : Pump; END_VAR ASSERT_EQ(p.t, 1);' '`t` lives only while `Pump` runs' \
  'keep what the test asks for in VAR or VAR_OUTPUT'
body 'VAR p : Pump; END_VAR ASSERT_EQ(p.tank, 1);' '`tank` lies outside of `Pump`'
body 'VAR p : Pump; END_VAR ASSERT_EQ(p.level, 1);' 'name the variable that it stands for'
body '%IW2 := 5;' 'E2014.*`in` has this input, too' 'name the variable: `in`, `instance.in`'
wrong "FUNCTION_BLOCK F VAR p : Main; END_VAR p(); END_FUNCTION_BLOCK TEST 'a' ; END_TEST" \
  'E3001.*`Main` is a program; a variable cannot be one' 'or the variable in a TEST'

# A duration that only the test knows may be negative, too.
cat >back.st <<'ST'
TEST 'back'
  VAR d : TIME := T#2s; END_VAR
  ADVANCE_TIME(d);
  d := d - T#3s;
  ADVANCE_TIME(d);
END_TEST
ST
expect 1 stc test back.st
said 'back.st:5'
said 'time does not go back: ADVANCE_TIME got (LTIME#|LT#|T#)?-1s'

# Where no tests run, their words are refused.
echo 'PROGRAM q VAR x : Pump; n : INT; END_VAR MOCK x; x(tank := n); END_PROGRAM' >q.st
expect 1 stc check pump.st q.st
said 'E8002.*mocks are for tests only'
echo 'PROGRAM q VAR p : Main; END_VAR p(); END_PROGRAM' >q.st
expect 1 stc check pump.st q.st
said 'E3001.*is a program'
echo 'PROGRAM q ADVANCE_TIME(T#1s); Main.n := 5; END_PROGRAM' >q.st
expect 1 stc check pump.st q.st
said 'E8002.*is for tests only'
said 'E4001.*`n` is private to `Main`, and others only read it'

# Assertions compare as expressions do: what is computed below 32 bits is a DINT (docs/LANGUAGE.md).
wrong "TEST 'a' VAR a : INT := 20000; END_VAR ASSERT_EQ(a * 3, a); END_TEST" \
  'expected 20000, got 60000'
