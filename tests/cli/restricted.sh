#!/bin/sh
# D7: the restricted mode refuses edits of a POU's interface, in stc diff, stc package and stvm change; X1: the report names POUs
# whose code is another one, and says where instances keep their values under it (case 41).
. "$(dirname "$0")/lib.sh"

cat >v1.st <<'ST'
FUNCTION_BLOCK Pid VAR_INPUT pv : REAL; END_VAR VAR_OUTPUT i : REAL; END_VAR VAR CONSTANT gain : REAL := 1.5; END_VAR i := i + pv * gain; END_FUNCTION_BLOCK
PROGRAM Main VAR c : ARRAY[1..3] OF Pid; valve : BOOL; END_VAR c[1](pv := 1.0); IF c[1].i > 5.0 THEN valve := TRUE; END_IF END_PROGRAM
ST
sed 's/1\.5/2.5/' v1.st >gain.st
sed 's/pv : REAL/pv : LREAL/' v1.st >input.st
sed 's/ IF c.*END_IF//; s/valve : BOOL/valve : BOOL; lamp : BOOL/; s/END_PROGRAM/lamp := valve; END_PROGRAM/' v1.st >unwritten.st

expect 0 stc diff --restricted v1.st gain.st
said 'code +Pid'
said '3 instances keep their values: outputs may jump'
said 'constant changed'
sed 's/1\.5/2.5/; s/VAR_INPUT pv : REAL/VAR_INPUT process_value_of_the_loop : DINT/; s/pv/process_value_of_the_loop/g' v1.st >long.st
expect 0 stc diff v1.st long.st
said 'process_value_of_the_loop'
[ "$(awk 'length > 80' out | wc -l)" = 0 ] || fail "the report is wider than 80 columns: $(cat out)"
expect 0 stc diff v1.st gain.st --format json
said '"change": *"body"'
expect 7 stc diff --restricted v1.st input.st
said 'R0307.*`Pid`: input `pv` REAL -> LREAL'
expect 0 stc diff v1.st input.st
said 'interface: input `pv` REAL -> LREAL'
stc build v1.st -o v1.img
expect 7 stc package --restricted --base v1.img input.st -o p.pkg
said 'R0307'
[ ! -e p.pkg ] || fail "a refused package was written"

serve plc v1.img
expect 7 stvm change input.st --dir plc --yes --restricted --allow-loss
said 'R0307'
expect 0 stvm change gain.st --dir plc --yes --restricted
said 'outputs may jump'
expect 0 stvm undo --dir plc
# Case 40: the statement that writes `valve` goes: it holds its value, and the report says that nothing writes it.
wait_for 'TRUE' stvm get --dir plc Main.valve
expect 0 stvm change unwritten.st --dir plc --yes
said 'W0013.*valve|valve.*W0013'
expect 0 stvm get --dir plc Main.valve
said 'TRUE'
expect 0 stvm stop --dir plc
