#!/bin/sh
# Case 76: a small function is edited that others take in: only it is reported as edited (E-02). Who
# takes it in is compiled anew, and that is said in one row.
. "$(dirname "$0")/lib.sh"

program() {  # program DIVISOR REMARK
  cat <<ST
FUNCTION Half : INT
  VAR_INPUT x : INT; END_VAR
  Half := x / $1;
END_FUNCTION
PROGRAM Main
  VAR n : INT; END_VAR
  n := Half(n)$2 + 1;
END_PROGRAM
PROGRAM Aside
  VAR n : INT; END_VAR
  n := n + 1;
END_PROGRAM
ST
}
mkdir old new
program 2 "" >old/line.st
program 3 " (* a remark *)" >new/line.st

expect 0 stc diff old new
said '^code +Half  .body.$'
said '^code +1 other  .compiled anew, their text is the same: Main.$'
! grep -q Aside out || fail 'Aside is reported'
expect 0 stc diff old new --format json
said '"pou":"Half","change":"body","instances":0,"what":"".,."pou":"Main","change":"follows"'

# A remark alone edits nothing, and the image stays the same, bit by bit.
expect 0 stc build old -o before.img
program 2 " (* a remark *)" >old/line.st
expect 0 stc build old -o after.img
cmp before.img after.img || fail 'a remark makes another image'
