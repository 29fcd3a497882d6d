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
  expect 7 stvm change traps.st --yes --dir plc
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

# D4, D3: a recording that begins while edits are on trial holds what takes them back: each of them,
# one from below another, what they had dropped and converted, the names of new ones, redo, accept.
edit() {  # edit FILE DECLARATIONS STATEMENTS OTHER
  cat >"$1" <<ST
FUNCTION_BLOCK Side VAR n : DINT; END_VAR n := n + $4; END_FUNCTION_BLOCK
PROGRAM Main VAR n : DINT; s : Side; $2 END_VAR n := n + 1; s(); $3 END_PROGRAM
ST
}
edit e0.st 'gone : DINT := 5; part : INT := 7;' 'gone := gone + 1;' 1
edit e1.st 'part : SINT := 7; more : DINT;' 'more := more + 1;' 1
edit e2.st 'part : SINT := 7; more : DINT;' 'more := more + 1;' 2
edit e3.st 'part : SINT := 7; more : DINT; last : DINT;' 'more := more + 1; last := last + 1;' 2
rm -rf plc
serve plc e0.st
expect 0 stvm set Main.part=300 --dir plc
expect 0 stvm change e1.st --yes --allow-loss --allow-overrun --dir plc
expect 0 stvm change e2.st --yes --allow-overrun --dir plc
expect 0 stvm stop --dir plc
rm plc.pid
serve plc --record trial.rec
expect 0 stvm edits --dir plc
said '^E1 '
said '^E2 '
expect 0 stvm undo E1 --only --yes --allow-loss --allow-overrun --dir plc
expect 0 stvm edits --dir plc
said '^E3 '
expect 0 stvm undo --yes --dir plc
expect 0 stvm redo --yes --allow-loss --allow-overrun --dir plc
expect 0 stvm undo E2 --yes --dir plc
expect 0 stvm change e3.st --yes --allow-loss --allow-overrun --dir plc
expect 0 stvm accept E1 --dir plc
expect 0 stvm undo --yes --dir plc
expect 0 stvm get Main.part --dir plc
cp out part
expect 0 stvm stop --dir plc
rm plc.pid
expect 0 stvm replay trial.rec --print Main.part
said "^$(cat part)\$"
said '[1-9][0-9]+ cycles replayed, the state is identical'
# Another image in its place, or less of it, is said, and nothing is replayed.
cp trial.rec bad.rec
printf 'xxxxxxxx' | dd of=bad.rec bs=1 seek=400 conv=notrunc 2>/dev/null
expect 7 stvm replay bad.rec
said 'R0416'
# D3: all that was on trial at its begin is undone, and another change is made.
rm -rf plc
serve plc e0.st
expect 0 stvm change e1.st --yes --allow-loss --allow-overrun --dir plc
expect 0 stvm change e2.st --yes --allow-overrun --dir plc
expect 0 stvm stop --dir plc
rm plc.pid
serve plc --record undone.rec
expect 0 stvm undo --yes --dir plc
expect 0 stvm undo --yes --dir plc
expect 0 stvm change e3.st --yes --allow-loss --allow-overrun --dir plc
expect 0 stvm stop --dir plc
rm plc.pid
expect 0 stvm replay undone.rec
said '[1-9][0-9]* cycles replayed, the state is identical'
