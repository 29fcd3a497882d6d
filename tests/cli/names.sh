#!/bin/sh
# R-02 Names of variables wherever a command takes one: paths, patterns, addresses, globals of lists,
# and the name of a PROGRAM that the sources declare.
. "$(dirname "$0")/lib.sh"

mkdir plant
cat >plant/main.st <<'ST'
TYPE Pump : STRUCT run : BOOL; speed : INT; END_STRUCT END_TYPE
{attribute 'qualified_only'}
VAR_GLOBAL limit : INT := 7; END_VAR
VAR_GLOBAL
  start AT %IX0.0 : BOOL;
  lamps AT %QX1.0 : ARRAY[0..3] OF BOOL;
  level AT %QW1 : INT;
END_VAR
PROGRAM Main
VAR pumps : ARRAY[1..3] OF Pump; n : INT; well : BOOL := TRUE; END_VAR
n := n + 1;
END_PROGRAM
PROGRAM Other VAR m : INT; END_VAR m := m + 1; END_PROGRAM
CONFIGURATION c RESOURCE r ON cpu
  TASK t (INTERVAL := T#10ms, PRIORITY := 1);
  PROGRAM Line1 WITH t : Main;
  PROGRAM a1 WITH t : Other;
  PROGRAM a2 WITH t : Other;
END_RESOURCE END_CONFIGURATION
ST
expect 0 stc build plant -o plant.img
run() { stvm run plant.img --virtual-time --scans 3 "$@"; }

# In this process.
expect 0 run --print 'Main.n' --print Line1.n
said '^Line1\.n=3$'
[ "$(grep -c '^Line1.n=3$' out)" = 2 ] || fail "the PROGRAM and its instance are one"
expect 7 run --print Other.m
said '`Other.m`: `Other` has 2 instances; name one of them: a1, a2'
expect 0 run --print 'Line1.pumps[*].run,a?.m' --set 'Line1.pumps[*].run=TRUE' --set 'Line1.pumps[2].run=FALSE'
printf 'Line1.pumps[1].run=TRUE\nLine1.pumps[2].run=FALSE\nLine1.pumps[3].run=TRUE\na1.m=3\na2.m=3\n' | cmp - out ||
  fail "patterns of --print and --set"
expect 7 run --print 'Line1.valves[*]'
said 'R0401: no variable matches `Line1.valves\[\*\]`'
expect 0 run --print %QX1.2,%QW1,%IX0.0 --set %QX1.2=TRUE --set %QW1=5
said '^lamps\[2\]=TRUE$'
said '^level=5$'
said '^start=FALSE$'
expect 7 run --print %QX2.3
said '`%QX2.3`: is a part of level AT %QW1; name that variable'
expect 7 run --print %QX9.0
said '`%QX9.0`: no variable of the program stands for this address'
expect 0 run --trace t.csv --plot p.svg --print 'Line1.pumps[*].speed'
[ "$(head -1 t.csv)" = 'scan,Line1.pumps[1].speed,Line1.pumps[2].speed,Line1.pumps[3].speed' ] || fail "trace"
expect 0 run --record r.rec
expect 0 stvm replay r.rec --print 'a?.m,Main.n'
said '^a1\.m=3$'
said '^Line1\.n=3$'
expect 7 stvm replay r.rec --print Mian.n
said 'did you mean'

# At a controller.
serve line plant.img
at() { command=$1; shift; stvm "$command" --dir line "$@"; }
expect 0 at set 'Line1.pumps[*].speed=4' %QW1=9
expect 7 at get 'Mian.pumps[*].speed'
said 'no variable matches'
expect 0 at get 'Line1.pumps[*].speed' level
printf 'Line1.pumps[1].speed=4\nLine1.pumps[2].speed=4\nLine1.pumps[3].speed=4\nlevel=9\n' | cmp - out || fail "get"
expect 0 at get %QW1
said '^level=9$'
expect 0 at get Main.well
said '^Line1\.well=TRUE$'
expect 7 at get Line1.pmups
said '`pmups` is no member of `Main`; did you mean `pumps`\?'
expect 7 at get Line1.n.x
said '`INT` has no members$'
expect 0 at watch --count 1 'Line1.pumps[?].run'
said ': Line1\.pumps\[1\]\.run=FALSE Line1\.pumps\[2\]\.run=FALSE Line1\.pumps\[3\]\.run=FALSE$'
expect 0 at force 'Line1.pumps[*].run=TRUE' %IX0.0=TRUE
said '^start=TRUE'
expect 0 at get --forces
[ "$(wc -l <out)" = 4 ] || fail "four forces"
# Kept by their paths, so a change takes them along.
sed -i 's/n := n + 1/n := n + 2/' plant/main.st
expect 0 at change plant --yes --permanent --health Main.well -q
silent_on out
expect 0 at get --forces
[ "$(wc -l <out)" = 4 ] || fail "four forces behind the change"
expect 7 at change plant --yes --health Main.wel
said 'did you mean `well`\?|R0308'
expect 0 at unforce 'Line1.pumps[*].run'
expect 0 at get --forces
said '^start=TRUE'
[ "$(wc -l <out)" = 1 ] || fail "one force is left"
expect 7 at unforce 'Line1.pumps[*].run'
said 'R0401: no forced variable matches'
expect 0 at unforce %IX0.0
expect 0 at stop

# What an edge remembers has a name as well, dots and brackets of its operand included.
cat >edges.st <<'ST'
FUNCTION_BLOCK Counts
VAR n : ARRAY[0..1] OF INT; t : TON; END_VAR
LADDER
  |--[P t.Q ]--[ n[1] := ADD(n[1], 1) ]--|
END_LADDER
END_FUNCTION_BLOCK
PROGRAM Main
VAR c : Counts; k : BOOL; END_VAR
  c(); k := TRUE;
END_PROGRAM
ST
expect 0 stvm run edges.st --scans 2 --virtual-time --print 'Main.c.t.Q#rising#n[1]' --print 'main.C.T.q#RISING#N[1]'
expect 7 stvm run edges.st --scans 2 --virtual-time --print 'Main.c.t.Q#falling#n[1]'
said 'R0401: `Main.c.t.Q#falling#n\[1\]`: `Q#falling#n` is no member'

# A name that two files declare: the message has both places, and a call of it no further error.
mkdir twice
printf 'FUNCTION Add1 : INT VAR_INPUT a : INT; END_VAR Add1 := a + 1; END_FUNCTION\nPROGRAM Main VAR n : INT; END_VAR n := Add1(n); END_PROGRAM\nVAR_GLOBAL level : INT; END_VAR\nTYPE Pump : INT; END_TYPE\n' >twice/a.st
printf 'PROGRAM Main END_PROGRAM\nFUNCTION Add1 : INT VAR_INPUT b : INT; END_VAR Add1 := b + 2; END_FUNCTION\nVAR_GLOBAL level : INT; END_VAR\nTYPE Pump : REAL; END_TYPE\n' >twice/b.st
expect 1 stc check twice
said 'b.st:1:9: error\[E2002\]: `Main` is declared twice; first declared in .*a.st:2$'
said 'b.st:2:10: error\[E2002\]: `Add1\(INT\)` is declared twice; first declared in .*a.st:1$'
said 'b.st:3:12: error\[E2002\]: `level` is declared twice; first declared in .*a.st:3$'
said 'b.st:4:6: error\[E2002\]: `Pump` is declared twice; first declared in .*a.st:4$'
said '^4 errors'
