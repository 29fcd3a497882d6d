#!/bin/sh
# case72, X7, X8: a version on trial that traps in its first cycles, or whose health condition
# becomes FALSE, is undone by the controller itself; a controller in FAULT takes a change and goes
# on with its values; the version before the accepted one is one command away.
. "$(dirname "$0")/lib.sh"
program() {  # program FILE DECLARATIONS STATEMENTS
  cat >"$1" <<ST
PROGRAM Main VAR n : DINT; level : INT := 300; bad : INT; z : INT; $2 END_VAR
  n := n + 1; $3
END_PROGRAM
CONFIGURATION c RESOURCE r ON cpu
  TASK t (INTERVAL := T#1ms, PRIORITY := 1); PROGRAM Main WITH t : Main;
END_RESOURCE END_CONFIGURATION
ST
}
program v1.st '' ''
program traps.st 'k : DINT;' 'k := k + 1; IF k > 5 THEN z := 1 / z; END_IF'
program late.st 'k : DINT;' 'k := k + 1; IF k > 1500 THEN z := 1 / z; END_IF'
program sick.st 'well : BOOL := TRUE; k : DINT;' 'k := k + 1; IF k > 5 THEN well := FALSE; END_IF'
program v2.st 'more : INT;' 'more := more + 1; IF bad = 1 THEN z := 1 / z; END_IF'
sed 's|IF bad = 1 THEN z := 1 / z; END_IF|IF bad = 1 THEN z := 7; END_IF|' v2.st >mended.st

# n_grows FROM: the program counts on, whenever that is.
n_grows() {
  for _ in $(seq 4000); do
    later=$(stvm get Main.n --dir plc | sed 's/.*=//')
    [ "$later" -gt "$1" ] && return
    sleep 0.05
  done
  fail "the program does not count on: $1, then $later"
}
# stays_in_fault: each question is answered at a boundary of the control thread, where it could have
# undone the change.
stays_in_fault() {
  for _ in 1 2 3 4 5 6; do
    expect 0 stvm status --dir plc
    said 'FAULT'
  done
}

serve plc v1.st
wait_for '=[1-9]' stvm get Main.n --dir plc
expect 0 stvm set Main.level=4711 --dir plc
expect 7 stvm revert --yes --dir plc
said 'R0305'

# A trap in the first cycles.
expect 7 stvm change traps.st --yes --dir plc
said 'R0325: E1 undone by the controller at 2.*: a trap on trial: .*division'
said '^switched'
if grep -q 'on trial: `stvm accept`' out; then fail "on trial, it says"; fi
wait_for 'a trap on trial: cycle [0-9]+, task t: traps.st:2 .Main.: division' stvm journal --dir plc
said 'undone .*by controller'
expect 0 stvm status --dir plc
said '^r: running$|: running$'
said 'change +idle'
said '^alarm: E1 undone by the controller at 2.*: a trap on trial: .*division'
expect 0 stvm get Main.level --dir plc
said '=4711'
expect 7 stvm get Main.k --dir plc
n_grows "$(stvm get Main.n --dir plc | sed 's/.*=//')"

# A health condition.
expect 7 stvm change sick.st --yes --health Main.level --dir plc
said 'R0402.*Main.level'
expect 7 stvm change sick.st --yes --health Main.unknown --dir plc
said 'R0401'
expect 7 stvm change sick.st --yes --health Main.well --dir plc --format json
said '"switched": ?true'
said '"refused": ?"R0325"'
wait_for 'health condition `Main.well` is FALSE' stvm journal --dir plc

# Whoever wants to look at the trap himself; and undo by hand runs the tasks again.
expect 0 stvm change traps.st --yes --no-auto-undo --dir plc
wait_for 'FAULT' stvm status --dir plc
said 'stvm undo'
stays_in_fault
expect 0 stvm undo --dir plc
expect 0 stvm status --dir plc
said ': running$'

# After the first cycles it is a fault like any other.
expect 0 stvm change late.st --yes --dir plc
wait_for 'FAULT' stvm status --dir plc
stays_in_fault
said 'change +trial'
expect 0 stvm undo --dir plc

# A controller in FAULT takes a change, and goes on hot with it.
expect 0 stvm change v2.st --yes --permanent --dir plc
expect 0 stvm set Main.bad=1 --dir plc
wait_for 'FAULT' stvm status --dir plc
said 'stvm change.*stvm revert'
expect 0 stvm get Main.n Main.more --dir plc
cp out at_fault
expect 0 stvm change mended.st --dir plc --dry-run
expect 0 stvm change mended.st --yes --dir plc
wait_for ': running, on trial$' stvm status --dir plc
wait_for '=7' stvm get Main.z --dir plc
expect 0 stvm get Main.level --dir plc
said '=4711'
n_grows "$(sed -n 's/Main.n=//p' at_fault)"
expect 0 stvm accept --dir plc

# The version before is one command away, as a change with its fates; and back.
expect 0 stvm set Main.bad=0 --dir plc
expect 0 stvm revert --dry-run --dir plc
said 'code +Main'
expect 0 stvm revert --yes --permanent --dir plc
expect 0 stvm get Main.level --dir plc
said '=4711'
expect 0 stvm set Main.bad=1 --dir plc
wait_for 'FAULT' stvm status --dir plc
expect 0 stvm revert --yes --permanent --dir plc
wait_for '=7' stvm get Main.z --dir plc
# It is kept over a stop, and damage of its file is said.
expect 0 stvm stop --dir plc
serve plc
expect 0 stvm revert --dry-run --dir plc
said 'code +Main'
dd if=/dev/zero of=plc/before bs=1 seek=900 count=64 conv=notrunc 2>/dev/null
expect 7 stvm revert --yes --dir plc
said 'R0409.*earlier version'
