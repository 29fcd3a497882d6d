#!/bin/sh
# A trap says the value that it is about, and none where it knows none.
. "$(dirname "$0")/lib.sh"
# trap STATEMENT REGEX: what stvm says of it in the second scan.
trap_of() {
  cat >t.st <<ST
PROGRAM Main
  VAR r : REAL; i : INT := -1; w : WORD := 16#0A; u : UINT; l : LWORD; n : BOOL; d : DATE; END_VAR
  IF n THEN $1 END_IF
  r := 1.0E9; n := TRUE;
END_PROGRAM
ST
  expect 0 stc build t.st -o t.stcimg
  stvm run t.stcimg --scans 2 >out 2>err && fail "no trap: $1"
  said "$2"
}
trap_of 'i := REAL_TO_INT(r);' 'value cannot be expressed in the target type: 1\.0E\+09'
trap_of 'u := WORD_BCD_TO_UINT(w);' 'value cannot be expressed in the target type( |$|\))'
trap_of 'w := INT_TO_BCD_WORD(i);' 'value cannot be expressed in the target type( |$|\))'
trap_of 'd := CONCAT_DATE(2026, 13, i);' 'value cannot be expressed in the target type( |$|\))'
