#!/bin/sh
# X1, X2: the report of an undo knows what the change had renamed, and names it as it is named then.
. "$(dirname "$0")/lib.sh"

cat >v1.st <<'ST'
VAR_GLOBAL lamp AT %QX0.0 : BOOL; horn AT %QX0.1 : BOOL; old_list : ARRAY[1..2] OF INT; END_VAR
VAR_GLOBAL count : DINT; END_VAR
FUNCTION_BLOCK Pump VAR_OUTPUT run, hours : INT; END_VAR hours := hours + 1; END_FUNCTION_BLOCK
PROGRAM Main VAR p1 : Pump; END_VAR p1(); lamp := TRUE; horn := TRUE; count := count + 1; old_list[1] := 3; END_PROGRAM
ST
cat >v2.st <<'ST'
VAR_GLOBAL {renamed from := 'lamp'} valve AT %QX0.0 : BOOL; {renamed from := 'horn'} bell AT %QX0.2 : BOOL;
 {renamed from := 'old_list'} list : ARRAY[1..3] OF INT; END_VAR
VAR_GLOBAL RETAIN {renamed from := 'count'} turns : DINT; END_VAR
VAR_GLOBAL added AT %QX0.3 : BOOL; END_VAR
FUNCTION_BLOCK Pump VAR_OUTPUT run : INT; {renamed from := 'hours'} time : INT; END_VAR time := time + 1; END_FUNCTION_BLOCK
PROGRAM Main VAR {renamed from := 'p1'} first : Pump; END_VAR first(); valve := TRUE; bell := TRUE; turns := turns + 1; list[1] := 3; END_PROGRAM
ST
serve plc v1.st
expect 0 stvm change v2.st --dir plc --yes --allow-overrun --allow-loss
said '^kept +valve : BOOL  TRUE  .renamed from `lamp`.$'
said '^kept +Main.first : Pump  .renamed from `p1`.$'
expect 0 stvm edits --dir plc
said '^  variables +valve .renamed from `lamp`.,'
expect 0 stvm undo --dir plc --dry-run
said '^kept +lamp : BOOL  TRUE  .renamed from `valve`.$'
said '^kept +horn : BOOL  TRUE  .renamed from `bell`.$'
said '^(kept|moved) +count : DINT  [0-9]+  .renamed from `turns`'
said '^kept +Main.p1 : Pump  .renamed from `first`.$'
said '^kept +Main.p1.hours : INT  [0-9]+  .renamed from `time`.$'
said '^variable +horn  .%QX0.2 -> %QX0.1'
said '^variable +count  .no longer RETAIN.$'
said '^variable +added  .%QX0.3 -> no address'
! grep -q '%QX0.0' out || fail "what was renamed stays where it is"
! grep -qE '^variable +(valve|lamp|bell|turns) ' out || fail "a name that nobody asks for"
expect 0 stvm undo --dir plc --yes
expect 0 stvm get --dir plc lamp
said '^lamp=TRUE$'
