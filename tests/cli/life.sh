#!/bin/sh
# FB_Exit at the end of a run: by `stvm run`, whose last values are those before it, and when a
# controller is stopped.
. "$(dirname "$0")/lib.sh"
cat >plant.st <<'ST'
VAR_GLOBAL left : INT; END_VAR
FUNCTION_BLOCK Pump
METHOD FB_Exit : BOOL VAR_INPUT bInCopyCode : BOOL; END_VAR
left := left + 1;
IF left = 3 AND NOT bInCopyCode THEN left := 1 / (left - 3); END_IF
END_METHOD
END_FUNCTION_BLOCK
PROGRAM P VAR a, b, c : Pump; END_VAR END_PROGRAM
ST
expect 1 stvm run plant.st --virtual-time --scans 2 --print left
said '^left=0$'
said 'Pump.FB_Exit'
said 'division or MOD by zero'
stc build plant.st -o plant.img 2>/dev/null
serve plant plant.img
expect 0 stvm status --dir plant
said '__START +once'
expect 0 stvm stop --dir plant
for _ in $(seq 4000); do
  grep -q 'R0310' plant.log && break
  sleep 0.05
done
grep -q 'Pump.FB_Exit in line 5: division or MOD by zero' plant.log || fail "$(cat plant.log)"
