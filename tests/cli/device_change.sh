#!/bin/sh
# Devices across online changes: outputs that go become safe, what cannot be opened is refused, undo brings all back.
. "$(dirname "$0")/lib.sh"
mkdir v1 v2 bad
for v in v1 v2 bad; do
  cat >$v/main.st <<'ST'
PROGRAM P
VAR a AT %QB0 : BYTE := 5; b AT %QB1 : BYTE := 6; i AT %IB0 : BYTE; n : DINT; END_VAR
n := n + 1;
END_PROGRAM
CONFIGURATION C RESOURCE R ON PLC TASK T(INTERVAL := T#5ms, PRIORITY := 1); PROGRAM Main WITH T : P; END_RESOURCE END_CONFIGURATION
ST
done
printf 'time_ms,%%IB0\n0,77\n' >in.csv
cat >v1/stc.toml <<'T'
[outputs]
safe = ["%QB1 = 9"]
[devices.left]
driver = "simulated"
outputs = "left.csv"
inputs = "in.csv"
map = ["byte 0..1 <- %QB0", "byte 0 -> %IB0"]
T
cat >v2/stc.toml <<'T'
[devices.left]
driver = "simulated"
outputs = "left.csv"
inputs = "in.csv"
map = ["byte 0 <- %QB0"]
[devices.right]
driver = "simulated"
outputs = "right.csv"
map = ["byte 0 <- %QB1"]
T
sed 's/right.csv/no_such_folder\/right.csv/' v2/stc.toml >bad/stc.toml
wait_value() {
  for _ in $(seq 4000); do
    stvm get Main.i --dir plc >out 2>&1 || true
    grep -qE "=$1\$" out && return
    sleep 0.05
  done
  fail "never $1"
}
serve plc v1
wait_for ',5,6$' cat left.csv
wait_value '16#4D'
expect 7 stvm change bad --dir plc --yes
said 'R0412.*device .right.: no_such_folder/right.csv: No such file'
expect 0 stvm status --dir plc
said 'change +idle'
said '^left +simulated +online'
expect 0 stvm change v2 --dir plc --dry-run
said '^device +left +.no longer byte 0..1 <- %QB0.'
said '^device +right +.new, simulated.'
expect 0 stvm change v2 --dir plc --yes
wait_for ',5,9$' cat left.csv   # %QB1 is not written there any more: it is safe
wait_for ',6$' cat right.csv    # but here
wait_value '16#00'          # nobody provides %IB0 any more
expect 0 stvm status --dir plc
said '^right +simulated +online'
expect 0 stvm undo --dir plc
wait_for '^[0-9.]+,0$' cat right.csv
wait_value '16#4D'
tail -1 left.csv | grep -qE ',5,6$' || wait_for ',5,6$' cat left.csv
expect 0 stvm change v2 --dir plc --yes
expect 0 stvm accept --dir plc
expect 0 stvm status --dir plc
said '^right +simulated +online'
said '^left +simulated +online'
# Back again, and the new device goes for good.
expect 0 stvm change v1 --dir plc --yes --permanent
expect 0 stvm status --dir plc
grep -q '^right' out && fail 'a device that no program has is still there'
wait_for '^[0-9.]+,0$' cat right.csv
# What is stored boots with its devices.
expect 0 stvm stop --dir plc
rm in.csv
code=0
"$bin/stvm" serve --dir plc >out 2>err || code=$?
[ "$code" -eq 7 ] || fail "serve: exit code $code"
said 'R0412: device .left.: in.csv: No such file'
printf 'time_ms,%%IB0\n0,78\n' >in.csv
serve plc
wait_value '16#4E'
echo "devices follow changes, and their undo"
