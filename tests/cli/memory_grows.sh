#!/bin/sh
# case71: a tiny program gains 2,000 function blocks. What has no place is said with the whole need;
# with the free area that the message asks for, data memory grows online, and values stay.
. "$(dirname "$0")/lib.sh"
mkdir v1 v2
cat >v1/a.st <<'ST'
PROGRAM Main VAR n : DINT; keep : INT := 42; END_VAR n := n + 1; END_PROGRAM
ST
cat >v2/a.st <<'ST'
FUNCTION_BLOCK Cell VAR a : ARRAY[1..20] OF LINT; b : INT := 5; END_VAR b := b + 1; END_FUNCTION_BLOCK
PROGRAM Main VAR n : DINT; keep : INT := 42; cells : ARRAY[1..2000] OF Cell; i : INT; END_VAR
  n := n + 1; FOR i := 1 TO 2000 DO cells[i](); END_FOR
END_PROGRAM
ST
printf 'name = "plant"\n' | tee v1/stc.toml >v2/stc.toml
serve plc v1
expect 0 stvm set Main.keep=4711 --dir plc
expect 7 stvm change v2 --yes --dir plc
said 'R0202'
said 'and [0-9]+ more have no place'
need=$(sed -n 's/.*Write `free_bytes = \([0-9]*\)` into.*/\1/p' out err)
[ -n "$need" ] || fail "the whole need is not said"
# Eight bytes less than was said is too little, that much is enough.
printf 'name = "plant"\n[slack]\nfree_bytes = %s\n' $((need - 8)) >v2/stc.toml
expect 7 stvm change v2 --yes --dir plc
said 'have no place|needs an area'
printf 'name = "plant"\n[slack]\nfree_bytes = %s\n' "$need" >v2/stc.toml
expect 0 stvm change v2 --yes --allow-overrun --dir plc
expect 0 stvm get Main.keep --dir plc
said '=4711'
wait_for '=[1-9][0-9]*' stvm get 'Main.cells[2000].b' --dir plc
expect 0 stvm undo --dir plc
expect 0 stvm get Main.keep --dir plc
said '=4711'
# The controller's own limit counts.
expect 0 stvm stop --dir plc
serve plc --data-limit 100000
expect 7 stvm change v2 --yes --allow-overrun --dir plc
said 'data_limit of this controller is 100000'
