#!/bin/sh
# X1, case64, case65, case66: what a change does beside values and code is in its report: addresses,
# RETAIN and CONSTANT, tasks and their programs, safe outputs; in `stc diff` and `stvm change`.
. "$(dirname "$0")/lib.sh"
mkdir v1 v2
cat >v1/a.st <<'ST'
VAR_GLOBAL out1 AT %QX0.0 : BOOL; out2 AT %QX0.1 : BOOL; in1 AT %IX0.0 : BOOL; plain : INT; r : INT; x AT %QB52 : BYTE; y AT %QB24 : BYTE; END_VAR
VAR_GLOBAL CONSTANT k : INT := 3; END_VAR
PROGRAM P out1 := in1; out2 := TRUE; plain := plain + k; END_PROGRAM
PROGRAM Q r := r + 1; END_PROGRAM
PROGRAM S VAR n : INT; END_VAR n := q4.n; END_PROGRAM
PROGRAM q4 VAR n : INT; END_VAR n := n + 1; END_PROGRAM
CONFIGURATION C RESOURCE R ON PLC TASK A(INTERVAL := T#10ms, PRIORITY := 1); TASK B(INTERVAL := T#20ms, PRIORITY := 2); TASK G(INTERVAL := T#40ms, PRIORITY := 3);
PROGRAM p1 WITH A : P; PROGRAM q1 WITH A : Q; PROGRAM q2 WITH B : Q; PROGRAM q3 WITH G : Q; PROGRAM s WITH G : S; PROGRAM q4 WITH G : q4;
END_RESOURCE END_CONFIGURATION
ST
cat >v2/a.st <<'ST'
VAR_GLOBAL out1 AT %QX7.7 : BOOL; out2 : BOOL; in1 AT %IX3.3 : BOOL; plain AT %QW10 : INT; x AT %QB30 : BYTE; y AT %QB31 : BYTE; list AT %QB50 : ARRAY[0..3] OF BYTE; END_VAR
VAR_GLOBAL RETAIN r : INT; END_VAR
VAR_GLOBAL k : INT := 3; END_VAR
PROGRAM P out1 := in1; out2 := TRUE; plain := plain + k; END_PROGRAM
PROGRAM Q r := r + 1; END_PROGRAM
PROGRAM S VAR n : INT; END_VAR n := q4.n; END_PROGRAM
PROGRAM q4 VAR n : INT; END_VAR n := n + 1; END_PROGRAM
CONFIGURATION C {attribute 'schedule' := 'run_first'} RESOURCE R ON PLC {attribute 'watchdog' := 'T#5ms'} {attribute 'overrun' := 'stretch'} {attribute 'output_buffer' := 'three'} {attribute 'exchange' := 'own'} TASK A(INTERVAL := T#5ms, PRIORITY := 3); TASK B(INTERVAL := T#20ms, PRIORITY := 2); TASK D(INTERVAL := T#80ms, PRIORITY := 5);
PROGRAM q1 WITH A : Q; PROGRAM p1 WITH A : P; PROGRAM q2 WITH D : Q; PROGRAM q3 WITH B : Q; PROGRAM s WITH B : S;
END_RESOURCE END_CONFIGURATION
ST
cat >v1/chart.st <<'ST'
FUNCTION_BLOCK Seq VAR go : BOOL; END_VAR
INITIAL_STEP Idle: END_STEP  STEP Fill: END_STEP  STEP Stir: END_STEP
TRANSITION FROM Idle TO Fill := go; END_TRANSITION
TRANSITION FROM Fill TO Stir := go; END_TRANSITION
TRANSITION FROM Stir TO Idle := go; END_TRANSITION
END_FUNCTION_BLOCK
ST
sed -e 's/FROM Idle TO Fill/FROM Idle TO (Fill, Stir)/' -e 's/FROM Stir TO/FROM (Fill, Stir) TO/' \
  -e '/FROM Fill TO Stir/d' v1/chart.st >v2/chart.st
printf 'name = "plant"\n[outputs]\nsafe = ["%%QX0.0 = TRUE", "%%QX0.1 = HOLD"]\n' >v1/stc.toml
printf 'name = "plant"\n[outputs]\nsafe = ["%%QX0.0 = TRUE", "%%QX7.7 = TRUE"]\n' >v2/stc.toml
all_is_said() {
  while read -r row; do
    tr -s ' ' <out | grep -qxF "$row" || fail "not said: $row"
  done <<'ROWS'
chart Seq (Fill -> Stir removed)
chart Seq (Idle -> Fill removed)
chart Seq (Stir -> Idle removed)
chart Seq ((Fill, Stir) -> Idle new)
chart Seq (Idle -> (Fill, Stir) new)
variable r (now RETAIN)
variable k (no longer CONSTANT)
variable in1 (%IX0.0 -> %IX3.3)
variable out1 (%QX0.0 -> %QX7.7; %QX0.0 is no longer written by any code)
variable out2 (%QX0.1 -> no address; %QX0.1 is no longer written by any code)
variable x (%QB52 -> %QB30)
variable y (%QB24 -> %QB31; %QB24 is no longer written by any code)
variable plain (no address -> %QW10)
resource C (schedule send_first -> run_first)
task A (interval T#10ms -> T#5ms)
task A (priority 1 -> 3)
task A (watchdog T#100ms -> T#5ms)
task A (policy none -> output_buffer three exchange own overrun stretch)
task D (new, T#80ms, priority 5)
task G (removed)
program q2 (task B -> D)
program q3 (task G -> B)
program s (task G -> B)
program q4 (task G -> none: it runs only where others call it)
task A (order p1, q1 -> q1, p1)
output %QX0.1 (safe value held -> 0)
output %QX7.7 (safe value 0 -> 1)
ROWS
}
expect 0 stc diff v1 v2
all_is_said
expect 0 stc diff v1 v2 --format json
said '"kind": *"task"'
expect 0 stc diff v1 v1
grep -qE '^(variable|resource|task|program|output) ' out && fail "nothing changes there"
serve plc v1
expect 0 stvm change v2 --dir plc --dry-run
all_is_said

# case64, X1: a force that moves, gets another type or ends is named, there and back.
force_is_said() {
  tr -s ' ' <out | grep -qxF "force $1" || fail "not said: $1"
}
expect 0 stvm force --dir plc out1=TRUE out2=TRUE in1=TRUE plain=5
expect 0 stvm change v2 --dir plc --dry-run
force_is_said 'out1 (%QX0.0 -> %QX7.7)'
force_is_said 'out2 (%QX0.1 -> no address)'
force_is_said 'in1 (%IX0.0 -> %IX3.3)'
force_is_said 'plain (no address -> %QW10)'
mkdir v3
sed 's/out1 AT %QX0.0 : BOOL;/{renamed from := '"'out1'"'} lamp AT %QX0.0 : BOOL;/; s/plain : INT;/plain : DINT;/
  s/out2 AT %QX0.1 : BOOL; //; s/out2 := TRUE;//; s/out1 := in1/lamp := in1/' v1/a.st >v3/a.st
cp v1/stc.toml v3
expect 0 stvm change v3 --dir plc --allow-loss --yes
force_is_said 'out1 (out1 -> lamp)'
force_is_said 'out2 (ends)'
force_is_said 'plain (INT -> DINT)'
grep -q '^force *in1' out && fail "in1 stays as it is"
expect 0 stvm undo --dir plc
force_is_said 'lamp (lamp -> out1)'
force_is_said 'out2 (comes back: TRUE)'
force_is_said 'plain (DINT -> INT)'

# case64: addresses that VAR_CONFIG gives, in blocks, arrays of them and other blocks.
configured() {
  mkdir -p "$1"
  cat >"$1/a.st" <<ST
FUNCTION_BLOCK Drive VAR lamp AT %Q* : BOOL; in AT %I* : INT; n : INT; END_VAR lamp := in > 3; n := n + 1; END_FUNCTION_BLOCK
FUNCTION_BLOCK Line VAR d : ARRAY[1..2] OF Drive; END_VAR d[1](); d[2](); END_FUNCTION_BLOCK
PROGRAM P VAR one : Drive; l : Line; END_VAR one(); l(); END_PROGRAM
VAR_CONFIG
  P.one.lamp AT %QX1.0 : BOOL; P.one.in AT $2 : INT; P.l.d[1].lamp AT %QX1.1 : BOOL; P.l.d[1].in AT %IW10 : INT;
  P.l.d[2].lamp AT $3 : BOOL; P.l.d[2].in AT %IW11 : INT;
END_VAR
ST
}
configured g1 %IW8 %QX1.2
configured g2 %IW9 %QX5.3
expect 0 stc diff g1 g2
said '^variable +P.one.in  \(%IW8 -> %IW9\)$'
said '^variable +P.l.d\[2\].lamp  \(%QX1.2 -> %QX5.3; %QX1.2 is no longer written by any code\)$'
[ "$(grep -c '^variable' out)" = 2 ] || fail "more is told than moves"

# X1: an edit of an address alone, whose types and instances are those of what runs.
mkdir a1 a2
printf 'PROGRAM P\nVAR out AT %%QX0.0 : BOOL; n : INT; END_VAR\n  n := n + 1;\n  out := n > 5;\nEND_PROGRAM\n' >a1/p.st
sed 's/%QX0.0/%QX0.1/' a1/p.st >a2/p.st
serve addresses a1
expect 0 stvm change a2 --dir addresses --dry-run
tr -s ' ' <out | grep -qxF 'variable P.out (%QX0.0 -> %QX0.1; %QX0.0 is no longer written by any code)' ||
  fail "the address is not said"
