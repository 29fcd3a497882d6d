#!/bin/sh
# Failed assertions show values as people write them in ST, on one line; structures and arrays are
# compared member by member, and the message says which member differs.
. "$(dirname "$0")/lib.sh"
cat >v_test.st <<'ST'
TYPE Mode : (Stop, Run, Fast := 7); Word3 : WORD; END_TYPE
TYPE Inner : STRUCT n : INT; t : STRING(8); END_STRUCT; END_TYPE
TYPE Outer : STRUCT a : REAL; m : Mode; list : ARRAY[1..3] OF Inner; grid : ARRAY[0..1, 5..6] OF BYTE; END_STRUCT; END_TYPE
TEST 'blanks' VAR s : STRING := 'ab '; END_VAR ASSERT_EQ(s, 'ab'); END_TEST
TEST 'lines' VAR s : STRING := 'a$L"b"'; END_VAR ASSERT_NEQ(s, s, 'text'); END_TEST
TEST 'marks' VAR s : STRING := '$0E$$x$0F'; END_VAR ASSERT_EQ(s, '$0F, got y'); END_TEST
TEST 'wide' VAR s : WSTRING := "ab$L"; END_VAR ASSERT_EQ(s, "ab"); END_TEST
TEST 'mode' VAR m : Mode := Run; END_VAR ASSERT_EQ(m, Mode.Stop); END_TEST
TEST 'no mode' VAR m, n : Mode; END_VAR m := TO_Mode(3); ASSERT_EQ(m, Fast); END_TEST
TEST 'word' VAR w : WORD := 16#8000; END_VAR ASSERT_EQ(w, 16#1); END_TEST
TEST 'byte' VAR w : BYTE := 16#8; END_VAR ASSERT_LT(w, BYTE#7); END_TEST
TEST 'lword' VAR w : LWORD := 16#FEDCBA9876543210; END_VAR ASSERT_EQ(w, 0); END_TEST
TEST 'time' VAR t : TIME := T#1M5S; END_VAR ASSERT_EQ(t, T#5S); END_TEST
TEST 'char' VAR c : CHAR := 'q'; d : CHAR := '$L'; END_VAR ASSERT_EQ(c, d); END_TEST
TEST 'member' VAR a, b : Outer; END_VAR b.m := Run; ASSERT_EQ(a, b, 'all'); END_TEST
TEST 'element' VAR a, b : Outer; END_VAR a.list[2].t := 'x '; ASSERT_EQ(a, b); END_TEST
TEST 'grid' VAR a, b : Outer; END_VAR a.grid[1, 5] := 10; ASSERT_EQ(a.grid, b.grid); END_TEST
TEST 'array' VAR a, b : ARRAY[1..2] OF INT; END_VAR a[2] := 7; ASSERT_EQ(a, b); END_TEST
TEST 'no difference' VAR a, b : Outer; END_VAR ASSERT_NEQ(a, b, 'same'); END_TEST
TEST 'equal' VAR a, b : Outer; END_VAR ASSERT_EQ(a, b); a.list[3].n := 1; ASSERT_NEQ(a, b); END_TEST
ST
cat >>v_test.st <<'ST'
TEST 'long' VAR s : STRING(600); END_VAR WHILE LEN(s) < 500 DO s := CONCAT(s, 'abcdefgh'); END_WHILE ASSERT_EQ(s, 'x'); END_TEST
ST
expect 1 stc test v_test.st
for text in "expected 'ab', got 'ab '" "text: expected anything but 'a\\\$L\"b\"', got 'a\\\$L\"b\"'" \
  "expected '\\\$0F, got y', got '\\\$0E\\\$\\\$x\\\$0F'" 'expected "ab", got "ab\$L"' \
  'expected Stop, got Run' 'expected Fast, got 3' 'expected 16#0001, got 16#8000' \
  'expected less than 16#07, got 16#08' 'expected 16#0000000000000000, got 16#FEDCBA9876543210' \
  'expected T#5s, got T#1m5s' "expected '\\\$L', got 'q'" 'all: expected Run, got Stop in \.m$' \
  "expected '', got 'x ' in \\.list\\[2\\]\\.t\$" 'expected 16#00, got 16#0A in \[1, 5\]$' \
  'expected 0, got 7 in \[2\]$' "expected 'x', got '(abcdefgh)+[a-h]*'\.\.\.\$" 'same: expected a difference, got none' '^PASS   equal'; do
  said "$text"
done
said '1 passed, 17 failed'
expect 1 stc test v_test.st --format junit --filter lines
said "message=\"text: expected anything but 'a\\\$L&quot;b&quot;', got"

cat >x_test.st <<'ST'
TYPE U : UNION a : INT; b : WORD; END_UNION; END_TYPE
FUNCTION_BLOCK F END_FUNCTION_BLOCK
TYPE S : STRUCT f : F; END_STRUCT; END_TYPE
TEST 'union' VAR a, b : U; END_VAR ASSERT_EQ(a, b); END_TEST
TEST 'instances' VAR a, b : S; END_VAR ASSERT_EQ(a, b); END_TEST
TEST 'order' VAR a, b : ARRAY[1..2] OF INT; END_VAR ASSERT_LT(a, b); END_TEST
ST
expect 1 stc test x_test.st
for line in 4 5 6; do said "x_test.st:$line:.*E4006"; done
said 'help: compare its members or elements, one ASSERT_EQ for each'
