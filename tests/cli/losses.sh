#!/bin/sh
# case70: losses that many instances have in common are told one by one, those first that are not at
# their initial values; a row that stands for several shows no value of one of them.
. "$(dirname "$0")/lib.sh"
cat >v1.st <<'ST'
FUNCTION_BLOCK Cell VAR a : INT; gone : INT; END_VAR a := a + 1; gone := a; END_FUNCTION_BLOCK
PROGRAM Main VAR f : ARRAY[1..700] OF Cell; i : INT; END_VAR
  IF i = 0 THEN FOR i := 401 TO 407 DO f[i](); END_FOR END_IF
END_PROGRAM
ST
sed 's/ gone : INT;//; s/ gone := a;//' v1.st >v2.st
serve plc v1.st
wait_for '=1' stvm get 'Main.f[407].gone' --dir plc
expect 7 stvm change v2.st --dir plc --yes
said 'R0303: 700 live value'
said '^dropped +x700 +Main.f\[1\].gone : INT  \(removed; and 699 more like it\)$'
said '^and 200 more \(--all shows each\)$'
first=$(grep -n 'Main.f\[40[1-7]\].gone  1 ' out | cut -d: -f1 | tr '\n' ' ')
header=$(grep -n '^variable ' out | cut -d: -f1)
[ "$first" = "$(seq -s ' ' $((header + 1)) $((header + 7))) " ] || fail "not first: $first of $header"
expect 7 stvm change v2.st --dir plc --yes --format json
said '"loss_count": *700'
said '"variable": *"Main.f\[404\].gone"'
