#!/bin/sh
# case67: an output that no code writes any more is told; when it is on, it counts as a loss.
. "$(dirname "$0")/lib.sh"
cat >v1.st <<'ST'
VAR_GLOBAL lamp AT %QX0.0 : BOOL; other AT %QX0.1 : BOOL; dark AT %QX0.2 : BOOL; level AT %QW40 : INT;
  row AT %QB20 : ARRAY[0..3] OF BYTE; byref AT %QX0.3 : BOOL; END_VAR
FUNCTION_BLOCK Setter VAR_IN_OUT x : BOOL; END_VAR x := TRUE; END_FUNCTION_BLOCK
PROGRAM Main VAR s : Setter; END_VAR
  lamp := TRUE; other := TRUE; dark := FALSE; level := 7; row[0] := 1; row[2] := 5; s(x := byref);
END_PROGRAM
ST
# A rung goes.
sed 's/lamp := TRUE; //; s/ dark := FALSE;//; s/ row\[2\] := 5;//' v1.st >v2.st
expect 0 stc diff v1.st v2.st
said '^output +%QX0.0  \(`lamp` is no longer written by any code\)$'
said '^output +%QX0.2  \(`dark` is no longer written by any code\)$'
said '^output +%QB22  \(`row\[2\]` is no longer written by any code\)$'
[ "$(grep -c '^output' out)" = 3 ] || fail "more is told than was left"
serve plc v1.st
wait_for '=TRUE' stvm get lamp --dir plc
expect 7 stvm change v2.st --dir plc --yes
said 'R0303: 2 live value'
said 'lamp +TRUE +is no longer written \(%QX0.0\) and keeps its value'
said 'row\[2\] +16#05 +is no longer written \(%QB22\) and keeps its value'
expect 7 stvm change v2.st --dir plc --dry-run --format json
said '"loss_count": *2'
# What is off already can be left.
sed 's/lamp := TRUE/lamp := FALSE/; s/row\[2\] := 5/row[2] := 0/' v1.st >off.st
expect 0 stvm change off.st --dir plc --yes --permanent
wait_for '=FALSE' stvm get lamp --dir plc
expect 0 stvm change v2.st --dir plc --yes
said '^output +%QX0.0'
