#!/bin/sh
# case 80, C7: a program that rewrites 2 MB in every scan of a 5 ms task is changed by standby without
# a missed release, by both tiers; what can never fit is refused with the figures. In virtual time.
. "$(dirname "$0")/lib.sh"
program() {  # program FILE TYPE ELEMENT INTERVAL
  cat >"$1" <<ST
PROGRAM Main VAR data : ARRAY[0..524287] OF $3; n : DINT; x : $2; i : DINT; END_VAR
  n := n + 1; x := x + 1;
  FOR i := 0 TO 524287 DO data[i] := n; END_FOR
END_PROGRAM
CONFIGURATION c RESOURCE r ON cpu
  TASK t (INTERVAL := T#$4); PROGRAM Main WITH t : Main;
END_RESOURCE END_CONFIGURATION
ST
}
program v1.st INT DINT 5ms
program v2.st DINT DINT 5ms
program fast1.st INT DINT 120us
program fast2.st DINT DINT 120us

for tier in native interp; do
  serve $tier --tier $tier --virtual-time v1.st
  expect 0 stvm change v2.st --strategy standby --yes --dir $tier
  said ' 0 releases missed'
  expect 0 stvm get Main.x Main.n Main.data[0] Main.data[524287] --dir $tier
  x=$(sed -n 's/^Main.x=//p' out)
  n=$(sed -n 's/^Main.n=//p' out)
  grep -q "data\[0\]=$n\$" out && grep -q "data\[524287\]=$n\$" out || fail "not of one scan"
  [ "$x" = "$n" ] || fail "a scan was lost: $x of $n"
  expect 0 stvm status --dir $tier --format json
  said '"missed": *0'
  expect 0 stvm stop --dir $tier
done

# 2 MB cannot be copied in 0.12 ms; in place nothing of it need be.
serve fast --virtual-time fast1.st
expect 7 stvm change fast2.st --strategy standby --yes --dir fast
said 'R0304.*task `t` leaves 120000 of 120000 ns'
tr -s ' \n' ' ' <err | grep -q 'an edit that is undone, `stvm status --reset-times`' || fail "the way out"
said 'by standby 21[0-9]{5} of its [0-9]+ bytes of data are found to have been written'
said 'in place .--strategy in-place. the switch is expected to take'
expect 0 stvm change fast2.st --yes --dir fast
said ' 0 releases missed'
