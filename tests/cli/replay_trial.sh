#!/bin/sh
# X7: a recording has what the controller did by itself: an automatic undo, a switch in FAULT, and
# the undo of a version that has trapped are replayed bit for bit.
. "$(dirname "$0")/lib.sh"
program() {  # program FILE DECLARATIONS STATEMENTS
  cat >"$1" <<ST
PROGRAM Main VAR n : DINT; bad : INT; z : INT; $2 END_VAR n := n + 1; $3 END_PROGRAM
PROGRAM Other VAR m : DINT; END_VAR m := m + 1; END_PROGRAM
CONFIGURATION c RESOURCE r ON cpu
  $4 TASK t (INTERVAL := T#1ms, PRIORITY := 1); TASK u (INTERVAL := T#2ms, PRIORITY := 2);
  PROGRAM Main WITH t : Main; PROGRAM Other WITH u : Other;
END_RESOURCE END_CONFIGURATION
ST
}
trap='k := k + 1; IF k > 5 THEN z := 1 / z; END_IF'
for policy in '' "{attribute 'on_trap' := 'stop_task'}"; do
  rm -rf plc run.rec
  program v1.st '' '' "$policy"
  program traps.st 'k : DINT;' "$trap" "$policy"
  program late.st 'bits : BYTE;' 'IF bad = 1 THEN z := 1 / z; END_IF' "$policy"
  sed 's|z := 1 / z|z := 7|' late.st >mended.st
  serve plc --record run.rec v1.st
  expect 0 stvm change traps.st --yes --dir plc
  wait_for 'a trap on trial' stvm journal --dir plc
  expect 0 stvm change traps.st --yes --no-auto-undo --dir plc
  wait_for 'trap .*|division' stvm status --dir plc
  expect 0 stvm undo --dir plc
  expect 0 stvm change late.st --yes --permanent --dir plc
  expect 0 stvm set Main.bad=1 --dir plc
  wait_for 'division' stvm status --dir plc
  expect 0 stvm change mended.st --yes --allow-overrun --dir plc
  expect 0 stvm stop --dir plc
  expect 0 stvm replay run.rec
  said '[1-9][0-9]+ '
done
