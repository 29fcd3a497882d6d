#!/bin/sh
# stc xref: what names mean, where they are declared and who uses them, in every language.
. "$(dirname "$0")/lib.sh"

mkdir plant
cat >plant/blocks.st <<'ST'
// Counts what passes.
FUNCTION_BLOCK Counter
VAR_INPUT pulse : BOOL; END_VAR
VAR_OUTPUT total : INT; END_VAR
VAR seen : BOOL; END_VAR
LADDER
  |--[P pulse ]--( seen )--|
END_LADDER
END_FUNCTION_BLOCK
ST
cat >plant/main.st <<'ST'
PROGRAM Main
VAR c : Counter; END_VAR
c(pulse := c.total < 5);
END_PROGRAM
ST

# By name: the declaration's comment, and the uses in all files.
expect 0 stc xref plant --name counter
cat >want <<'END'
FUNCTION_BLOCK Counter(pulse : BOOL, VAR_OUTPUT total : INT)
  Counts what passes.
plant/blocks.st:2:16: declared
plant/main.st:2:9: read
END
cmp -s out want || fail "other text: $(cat out)"

# By place: a name, and the type of the expression there.
expect 0 stc xref plant --at plant/blocks.st:7:11
grep -q '^VAR_INPUT Counter.pulse : BOOL$' out || fail "a contact is not found: $(cat out)"
grep -q '^plant/main.st:3:3: written$' out || fail "the argument is no use: $(cat out)"
expect 0 stc xref plant --at plant/main.st:3:14
grep -q '^plant/main.st:3:12: expression of type INT$' out || fail "no type: $(cat out)"

# Everything; sources with mistakes are answered for, and the mistakes are said.
expect 0 stc xref plant
[ "$(grep -c declared out)" -eq 6 ] || fail "not six declarations: $(cat out)"
sed 's/< 5/< five/' plant/main.st >bad.st
expect 0 stc xref bad.st plant/blocks.st --name Main.c
grep -q 'five' err || fail "the mistake is not said"
grep -q '^bad.st:3:12: read$' out || fail "no answer beside a mistake: $(cat out)"

# What is not there.
expect 2 stc xref plant --name Countr
grep -q 'did you mean `Counter`' err || fail "no suggestion: $(cat err)"
expect 2 stc xref plant --at plant/main.st:99:1
grep -q 'no file of the project has the place' err || fail "$(cat err)"
expect 2 stc xref plant --at plant/main.st
for place in 4294967299:1 3:4294967297 -1:1 3x:1 3: :1 0:1 3:0 3:99999999999999999999; do
  expect 2 stc xref plant --at "plant/main.st:$place"
done
expect 2 stc xref plant --at plant/main.st:3:1 --name c

# --- by address, as an electrician asks: variables AT it, whole arrays, and addresses in code
cat >addresses.st <<'ST'
VAR_GLOBAL
  Start AT %IX0.0 : BOOL;
  Row AT %MB10 : ARRAY[0..4] OF BYTE;
END_VAR
PROGRAM Line
VAR lamp AT %QX0.1 : BOOL; END_VAR
  lamp := Start AND %IX0.0;
  %QB0 := Row[1];
  Row[2] := %MB12;
END_PROGRAM
ST
expect 0 stc xref addresses.st --name %IX0.0
said '^VAR_GLOBAL Start AT %IX0\.0 : BOOL$'
said '^%IX0\.0 : BOOL$'
said '^addresses\.st:7:21: read$'
expect 0 stc xref addresses.st --name %qx0.1
said '^VAR Line\.lamp AT %QX0\.1 : BOOL$'
said '^addresses\.st:8:3: written$'
expect 0 stc xref addresses.st --name %MW7
said '^VAR_GLOBAL Row AT %MB10 : ARRAY\[0\.\.4\] OF BYTE$'
if grep -q '%MB12' out; then fail 'words that share no bit'; fi
expect 2 stc xref addresses.st --name %MB15
said 'nothing stands at %MB15'
expect 0 stc xref addresses.st --name Start --format json
said '"signature": ?"VAR_GLOBAL Start AT %IX0\.0 : BOOL"'

# --- what is written: parts of structures and arrays, outputs; in-outs are both
cat >uses.st <<'ST'
TYPE Gauge : STRUCT a : INT; list : ARRAY[0..2] OF INT; END_STRUCT END_TYPE
FUNCTION Bump : INT
VAR_INPUT n : INT; END_VAR
VAR_IN_OUT sum : INT; END_VAR
VAR_OUTPUT old : INT; END_VAR
old := sum; sum := sum + n; Bump := sum;
END_FUNCTION
PROGRAM Main
VAR g : Gauge; p : POINTER TO Gauge; x, y, z, k : INT; END_VAR
g.a := 3; g.list[k] := 4; y := g.a;
p := ADR(g); p^.a := 5; p[0].a := 6;
k := Bump(1, x, y) + Bump(n := 1, sum := g.a, old => z);
END_PROGRAM
ST
roles() {  # roles NAME: after the declaration
  expect 0 stc xref uses.st --name "$1"
  sed -n 's/^uses.st:[0-9:]*: //p' out | sed 1d | tr '\n' ' '
}
[ "$(roles Main.g)" = "written written read read read-write " ] || fail "a structure: $(cat out)"
[ "$(roles Main.p)" = "written read read " ] || fail "a pointer: $(cat out)"
[ "$(roles Main.x)" = "read-write " ] || fail "an in-out without a name: $(cat out)"
[ "$(roles Main.y)" = "written written " ] || fail "an output without a name: $(cat out)"
[ "$(roles Gauge.a)" = "written read written written read-write " ] || fail "a member: $(cat out)"
[ "$(roles Bump.sum)" = "read written read read read-write " ] || fail "a parameter: $(cat out)"
