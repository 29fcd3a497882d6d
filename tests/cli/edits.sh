#!/bin/sh
# D8: the table of units says which slot runs, what lies in the other one, since when and by whom.
# D3: what is on trial, edit by edit.
. "$(dirname "$0")/lib.sh"

version() {  # version FILE STEP
  cat >"$1" <<ST
FUNCTION_BLOCK Pump VAR n : DINT; END_VAR n := n + $2; END_FUNCTION_BLOCK
FUNCTION_BLOCK Valve VAR n : DINT; END_VAR n := n + 1; END_FUNCTION_BLOCK
PROGRAM Main VAR a : ARRAY[1..3] OF Pump; v : Valve; END_VAR a[1](); v(); END_PROGRAM
ST
}
version v1.st 1
version v2.st 2

serve plc v1.st
expect 0 stvm status --units --dir plc
said '^unit +kind +identity +slot +other +since .UTC. +by$'
said '^Pump +FB +[0-9a-f]{12} +A +- +[0-9][0-9]-[0-9][0-9] [0-9:]{5} +serve$'
expect 0 stvm edits --dir plc
said '^no edit is on trial$'

expect 0 stvm change v2.st --dir plc --yes --allow-overrun
expect 0 stvm status --units --dir plc
said '^Pump +FB +[0-9a-f]{12}[*] +B +before +[0-9][0-9]-'
said '^Valve +FB +[0-9a-f]{12} +A +- '
said '^. edited since the program was accepted'
awk 'length($0) > 80 { exit 1 }' out || fail "wider than 80 columns"
expect 0 stvm status --units --dir plc --format json
said '"unit": *"Pump"'
said '"other_slot": *"before"'
said '"event": *"switched"'
expect 0 stvm edits --dir plc
said '^E1  20.*  cycle [0-9]+  by '
said '^  POUs +Pump .body.$'
expect 0 stvm edits --dir plc --format json
said '"name": *"E1"'
said '"pou": *"Pump"'
expect 0 stvm journal --dir plc
said 'edit E1'

expect 0 stvm undo --dir plc
said 'E1 undone between'
expect 0 stvm status --units --dir plc
said '^Pump +FB +[0-9a-f]{12} +A +undone +[0-9][0-9]-'
expect 0 stvm edits --dir plc
said 'no edit is on trial'

expect 0 stvm change v2.st --dir plc --yes --allow-overrun
expect 0 stvm accept --dir plc
expect 0 stvm status --units --dir plc
said '^Pump +FB +[0-9a-f]{12} +B +before +[0-9][0-9]-'
expect 0 stvm stop --dir plc
serve plc
expect 0 stvm status --units --dir plc
said '^Pump +FB +[0-9a-f]{12} +A +- '

# Case 77: three edits, one on top of the other; each is taken back by its name, and comes again.
for n in 3 4 5; do version v$n.st $n; done
expect 0 stvm change v3.st --dir plc --yes --allow-overrun
expect 0 stvm change v4.st --dir plc --yes --allow-overrun
said '1 edit.s. on trial, the newest by .*: this one is made on top'
expect 0 stvm change v5.st --dir plc --yes --allow-overrun
expect 0 stvm status --dir plc
said 'running, on trial'
said '3 edit.s. .stvm edits.'
expect 0 stvm edits --dir plc
[ "$(grep -c '^E[123]  20' out)" -eq 3 ] || fail "not three edits"
# Those that were made on the first one go too, and that is said and asked before.
expect 2 stvm undo E1 --dir plc
said 'these go, newest first: E3, E2, E1'
said 'cannot ask for confirmation: stdin is not a terminal; pass --yes'
expect 0 stvm undo E1 --dir plc --dry-run
said 'E3, E2, E1'
expect 7 stvm undo E9 --dir plc
said 'R0305.*no edit .E9. is on trial'
expect 0 stvm undo E2 --dir plc --yes
said 'E3 undone between'
said 'E2 undone between'
expect 0 stvm edits --dir plc
said '^E1  20'
said '^E2  undone'
said '^E3  undone'
expect 7 stvm redo E9 --dir plc --yes
said 'R0305'
expect 0 stvm redo E3 --dir plc --yes --allow-overrun
said '^E2 again'
said '^E3 again'
expect 0 stvm edits --dir plc --format json
[ "$(grep -o '"undone": *false' out | wc -l)" -eq 3 ] || fail "not all three again"
expect 0 stvm accept E1 --dir plc
expect 0 stvm edits --dir plc
said '^E2  20'
grep -q '^E1 ' out && fail "E1 is accepted and still on trial"
expect 0 stvm undo --dir plc --format json
said '"edit": *"E3"'
expect 0 stvm undo E2 --dir plc
expect 7 stvm undo --dir plc
said 'R0305'
# What was accepted boots, and a change that is made now leaves nothing to bring again.
expect 0 stvm change v2.st --dir plc --yes --allow-overrun --permanent
expect 7 stvm redo --dir plc --yes
said 'R0305: no edit was undone'
said 'help: `stvm edits` lists what can be undone or brought again'
expect 0 stvm journal --dir plc
said 'edit E1'
expect 0 stvm stop --dir plc
