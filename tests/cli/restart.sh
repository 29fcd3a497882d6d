#!/bin/sh
# stvm restart: a controller that a trap has stopped runs again, with the values that are asked for.
. "$(dirname "$0")/lib.sh"
cat >plant.st <<'ST'
VAR_GLOBAL RETAIN total : INT; END_VAR
VAR_GLOBAL divisor : INT := 1; quotient : INT; END_VAR
PROGRAM P VAR scans : INT; END_VAR
scans := scans + 1; total := total + 1; quotient := 10 / divisor;
END_PROGRAM
ST
stc build plant.st -o plant.img 2>/dev/null
serve plant plant.img
expect 0 stvm set divisor=0 --dir plant
wait_for 'FAULT' stvm status --dir plant
grep -q 'stvm restart' out || fail "$(cat out)"
expect 0 stvm get total divisor --dir plant
said '^divisor=0'
expect 2 stvm restart --warm --cold --dir plant
said '--warm and --cold contradict each other; leave one out'
expect 0 stvm restart --dir plant
said 'restarted, warm'
wait_for 'running' stvm status --dir plant
expect 0 stvm get divisor --dir plant
said '^divisor=1'
before=$(stvm get total --dir plant | sed -n 's/^total=//p')
[ "$before" -gt 1 ] || fail "total is $before"
expect 0 stvm set divisor=0 --dir plant
wait_for 'FAULT' stvm status --dir plant
expect 0 stvm restart --hot --format json --dir plant
said '"restarted": *"hot"'
wait_for 'FAULT' stvm status --dir plant
expect 0 stvm set total=30000 --dir plant
expect 0 stvm restart --cold --dir plant
wait_for 'running' stvm status --dir plant
after=$(stvm get total --dir plant | sed -n 's/^total=//p')
[ "$after" -lt 30000 ] || fail "total is $after"
expect 0 stvm stop --dir plant

# FB_Exit that traps does not keep the controller from starting again; the answer says so.
cat >leaving.st <<'ST'
FUNCTION_BLOCK Pump VAR zero : INT := 0; END_VAR
METHOD FB_Exit : BOOL VAR_INPUT bInCopyCode : BOOL; END_VAR
zero := 1 / zero;
END_METHOD
END_FUNCTION_BLOCK
PROGRAM P VAR a : Pump; n : DINT; END_VAR n := n + 1; END_PROGRAM
ST
stc build leaving.st -o leaving.img 2>/dev/null
serve leaving leaving.img
expect 0 stvm set P.n=1000000 --dir leaving
expect 0 stvm restart --dir leaving
said 'restarted, warm'
said 'not all instances left: .*Pump.FB_Exit in line 3'
expect 0 stvm get P.n --dir leaving
[ "$(sed -n s/^P.n=//p out)" -lt 1000000 ] || fail "$(cat out)"
expect 0 stvm status --dir leaving
said 'running'
expect 0 stvm stop --dir leaving
