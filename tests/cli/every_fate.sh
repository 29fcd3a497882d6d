#!/bin/sh
# X1, totality: --all has a line for each variable of both versions, also for one whose name a block
# or a structure has taken, and says what the running program calls it. One row of the report that
# stands for several instances says how many there are (case65).
. "$(dirname "$0")/lib.sh"
cat >v1.st <<'ST'
FUNCTION_BLOCK Cell VAR a : INT; kept : INT; END_VAR a := a + 1; END_FUNCTION_BLOCK
PROGRAM P VAR taken : UDINT := 9; split : INT := 8; c : ARRAY[1..3] OF Cell; END_VAR c[1](); END_PROGRAM
CONFIGURATION X RESOURCE R ON cpu TASK T (INTERVAL := T#10ms); PROGRAM old WITH T : P;
END_RESOURCE END_CONFIGURATION
ST
cat >v2.st <<'ST'
TYPE Parts : STRUCT low : INT; END_STRUCT END_TYPE
FUNCTION_BLOCK Cell VAR {renamed from := 'a'} b : INT; END_VAR VAR RETAIN kept : INT; END_VAR
  b := b + 1;
END_FUNCTION_BLOCK
PROGRAM P VAR taken : Cell; split : Parts; c : ARRAY[1..3] OF Cell; END_VAR c[1](); END_PROGRAM
CONFIGURATION X RESOURCE R ON cpu TASK T (INTERVAL := T#10ms);
  {renamed from := 'old'} PROGRAM new WITH T : P;
END_RESOURCE END_CONFIGURATION
ST
# line VARIABLE FATE OLD: there is such a line, of a variable with this old name.
line() {
  tr '{' '\n' <out | grep -F "\"variable\":\"$1\",\"fate\":\"$2\"" | grep -qF "$3" ||
    fail "no line: $1 $2 $3"
}
all_lines() {
  line new.taken dropped '"old_variable":"old.taken"'
  line new.taken.b initialised '"old_type":""'
  line new.split dropped '"old_variable":"old.split"'
  line new.split.low initialised '"old_type":""'
  line 'new.c[2].b' kept '"old_variable":"old.c[2].a"'
  line 'new.c[2].kept' kept '"old_variable":"old.c[2].kept"'
}
expect 0 stc diff v1.st v2.st --all --format json
tr -d ' \n' <out >flat && mv flat out
all_lines
expect 0 stc diff v1.st v2.st
said '^variable +new.c\[1\].kept  \(now RETAIN; and 2 more like it\)$'
serve plc v1.st
expect 7 stvm change v2.st --dir plc --all --format json --dry-run
tr -d ' \n' <out >flat && mv flat out
all_lines
# The new block's row is not the loss of what it takes the place of.
tr '{' '\n' <out | grep -F '"variable":"new.taken","fate":"initialised"' | grep -qF '"loss":"isdropped"' &&
  fail "a new block is told to be a loss"
exit 0
