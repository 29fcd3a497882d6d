#!/bin/sh
# R-11: what tests reach: private variables and methods, programs and their instances, inputs and
# outputs, nested mocks. Every test begins with fresh values.
. "$(dirname "$0")/lib.sh"
cat >plant.st <<'ST'
FUNCTION_BLOCK Counter
VAR_INPUT b : BOOL; END_VAR
VAR_STAT total : INT; END_VAR
VAR_OUTPUT o : INT; END_VAR
VAR started : INT; END_VAR
VAR PRIVATE p : INT := 3; END_VAR
METHOD FB_Init : BOOL VAR_INPUT bInitRetains, bInCopyCode : BOOL; END_VAR started := 42; END_METHOD
METHOD PRIVATE Hidden : INT Hidden := 5 + p; END_METHOD
METHOD PROTECTED Kept : INT VAR_INST k : INT; END_VAR k := k + 1; Kept := k; END_METHOD
  total := total + 1;
  o := started;
END_FUNCTION_BLOCK
FUNCTION_BLOCK Derived EXTENDS Counter
VAR own : ARRAY[1..2] OF Counter; END_VAR
  SUPER^();
  own[2]();
END_FUNCTION_BLOCK
PROGRAM Main
VAR c : Counter; in AT %IW2 : WORD; q AT %QW4 : WORD; x : INT; open AT %I* : BOOL; END_VAR
VAR_TEMP t : INT; END_VAR
  c();
  t := c.o;
  x := t;
  q := in;
  IF open THEN x := -1; END_IF
END_PROGRAM
PROGRAM Other
VAR_INPUT go : BOOL; END_VAR
VAR_OUTPUT r : INT; END_VAR
  Main();
  IF go THEN r := r + 1; END_IF
END_PROGRAM
VAR_CONFIG Main.open AT %IX7.0 : BOOL; END_VAR
ST
cat >plant_test.st <<'ST'
TEST 'private variables and methods'
VAR u : Derived; END_VAR
  u();
  ASSERT_EQ(u.started, 42);
  ASSERT_EQ(u.own[2].started, 42);
  ASSERT_EQ(u.p, 3);
  u.p := 4;
  ASSERT_EQ(u.Hidden(), 9);
  ASSERT_EQ(u.Kept(), 1);
  ASSERT_EQ(u.own[1].o, 0);
  u.o := 7;
  ASSERT_EQ(u.o, 7);
END_TEST
TEST 'the program of that name'
  Main.in := 16#1234;
  Main();
  ASSERT_EQ(Main.x, 42);
  ASSERT_EQ(Main.c.total, 1);
  ASSERT_EQ(Main.q, 16#1234);
  Main.open := TRUE;
  Main();
  ASSERT_EQ(Main.x, -1);
END_TEST
TEST 'instances of programs'
VAR a, b : Main; o : Other; END_VAR
  a();
  a();
  ASSERT_EQ(a.x, 42);
  ASSERT_EQ(b.x, 0);
  o(go := TRUE);
  ASSERT_EQ(o.r, 1);
  ASSERT_EQ(Main.c.total, 3);
  MOCK o;
  o(go := TRUE);
  ASSERT_EQ(o.r, 1);
  MOCK_VERIFY_CALL_COUNT(o, 2);
END_TEST
TEST 'a mock inside of an array'
VAR d : Derived; END_VAR
  MOCK d.own[2];
  d();
  ASSERT_EQ(d.own[2].o, 0);
  MOCK_VERIFY_CALL_COUNT(d.own[2], 1);
  MOCK_VERIFY_CALL_COUNT(d.own[1], 0);
END_TEST
TEST 'fresh values, and a nested mock'
VAR a : Main; END_VAR
  ASSERT_EQ(a.c.total, 0);
  ASSERT_EQ(Main.x, 0);
  MOCK a.c;
  a.c.o := 99;
  a();
  ASSERT_EQ(a.x, 99);
  MOCK_VERIFY_CALL_COUNT(a.c, 1);
  Main();
  ASSERT_EQ(Main.x, 42);
END_TEST
ST
expect 0 stc test plant.st plant_test.st
said '5 passed, 0 failed'
# The program itself is what it was.
expect 0 stc build plant.st plant_test.st -o with.img
expect 0 stc build plant.st -o without.img
expect 0 stvm run with.img --scans 3 --virtual-time --print Main.x
said 'Main.x=42'
