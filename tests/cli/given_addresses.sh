#!/bin/sh
# `AT %I*`, `%Q*`, `%M*` without VAR_CONFIG: the linker gives addresses, an online change keeps them,
# and `stc dump --addresses` lists them.
. "$(dirname "$0")/lib.sh"

cat >v1.st <<'ST'
FUNCTION_BLOCK Valve
  VAR sensor AT %I* : BOOL; drive AT %QW* : WORD; END_VAR
  drive := 16#1234; IF sensor THEN drive := 0; END_IF
END_FUNCTION_BLOCK
TYPE Ports : STRUCT ready AT %I* : BOOL; speed AT %Q* : INT; END_STRUCT END_TYPE
VAR_GLOBAL
  lamp AT %Q* : LREAL; fixed AT %QB0 : BYTE; table AT %M* : ARRAY[0..3] OF INT; ports : Ports;
END_VAR
PROGRAM Main
  VAR v : ARRAY[1..2] OF Valve; own AT %I* : DINT; x AT %I* : BOOL; END_VAR
  v[1](); v[2](); lamp := own; fixed := 1; table[0] := ports.speed;
  IF x OR ports.ready THEN %QX0.1 := TRUE; END_IF
END_PROGRAM
VAR_CONFIG Main.v[1].sensor AT %IX0.5 : BOOL; END_VAR
ST
# Whole bytes, aligned, beside what is declared; the same sources give the same addresses.
cat >want1 <<'END'
%IX0.5  Main.v[1].sensor : BOOL  AT %I*
%IX1.0  ports.ready : BOOL  AT %I*
%IX2.0  Main.x : BOOL  AT %I*
%IX3.0  Main.v[2].sensor : BOOL  AT %I*
%ID1  Main.own : DINT  AT %I*
%QB0  fixed : BYTE
%QX0.1  %QX0.1 : BOOL
%QW1  ports.speed : INT  AT %Q*
%QW2  Main.v[1].drive : WORD  AT %Q*
%QW3  Main.v[2].drive : WORD  AT %Q*
%QL1  lamp : LREAL  AT %Q*
%MB0  table : ARRAY[0..3] OF INT  AT %M*
END
expect 0 stc dump --addresses v1.st
cmp -s out want1 || fail "other addresses: $(cat out)"
expect 0 stc build v1.st -o v1.img
expect 0 stc dump --addresses v1.img
cmp -s out want1 || fail "other addresses of the image: $(cat out)"

# A change: what lives on keeps its address, whatever comes in front of it, an array that grows and
# another name included. What takes the place of another type, and what is new, gets an address that
# nobody had; so does what stands where something is declared now.
sed -e 's/lamp AT %Q/first AT %Q* : INT; lamp AT %Q/' -e 's/\[1\.\.2\]/[0..2]/' \
  -e 's/own AT %I\* : DINT/own AT %I* : INT/' -e 's/ speed AT/ spare AT %I* : BOOL; speed AT/' \
  -e "s/ x AT %I/ {renamed from := 'x'} start AT %I/" -e 's/IF x/IF start/' \
  -e 's/fixed AT %QB0 : BYTE/fixed AT %QB0 : BYTE; taken AT %QB4 : BYTE/' v1.st >v2.st
cat >want2 <<'END'
%IX0.5  Main.v[1].sensor : BOOL  AT %I*
%IX1.0  ports.ready : BOOL  AT %I*
%IX2.0  Main.start : BOOL  AT %I*
%IX3.0  Main.v[2].sensor : BOOL  AT %I*
%IX8.0  ports.spare : BOOL  AT %I*
%IW5  Main.own : INT  AT %I*
%IX9.0  Main.v[0].sensor : BOOL  AT %I*
%QB0  fixed : BYTE
%QX0.1  %QX0.1 : BOOL
%QW1  ports.speed : INT  AT %Q*
%QB4  taken : BYTE
%QW3  Main.v[2].drive : WORD  AT %Q*
%QL1  lamp : LREAL  AT %Q*
%QW8  first : INT  AT %Q*
%QW9  Main.v[0].drive : WORD  AT %Q*
%QW10  Main.v[1].drive : WORD  AT %Q*
%MB0  table : ARRAY[0..3] OF INT  AT %M*
END
sort want2 >want
expect 0 stc build v2.st --base v1.img -o v2.img
expect 0 stc dump --addresses v2.img
sort out >got
cmp -s got want || fail "other addresses behind a change: $(cat out)"

# Words of a block that VAR_CONFIG let go stay where it had put them.
sed '/^VAR_CONFIG/d' v1.st >v3.st
expect 0 stc build v3.st --base v1.img -o v3.img
expect 0 stc dump --addresses v3.img
cmp -s out want1 || fail "VAR_CONFIG goes, and the address with it: $(cat out)"

# With `iec`, and where several RESOURCEs share the process image, VAR_CONFIG has to say it.
expect 1 stc check --dialect iec v1.st
said 'error\[E2019\]: `Main\.x` has no address yet'
cat >two.st <<'ST'
PROGRAM Lamp VAR q AT %Q* : BOOL; END_VAR q := NOT q; END_PROGRAM
CONFIGURATION C
  RESOURCE A ON plc TASK t (INTERVAL := T#10ms); PROGRAM a WITH t : Lamp; END_RESOURCE
  RESOURCE B ON plc TASK t (INTERVAL := T#10ms); PROGRAM b WITH t : Lamp; END_RESOURCE
END_CONFIGURATION
ST
expect 1 stc check two.st
said 'error\[E2019\]: `a\.q` has no address yet'

# More than a process image has.
cat >many.st <<'ST'
PROGRAM Main VAR q AT %Q* : ARRAY[0..1048576] OF BYTE; END_VAR q[0] := 1; END_PROGRAM
ST
expect 7 stc build many.st -o many.img
said 'R0204.*%Q has 1048577 bytes'
