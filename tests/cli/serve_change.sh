#!/bin/sh
# The main job: a running program is changed, undone, changed, accepted; wrong names and values get one line.
. "$(dirname "$0")/lib.sh"

cat >v1.st <<'ST'
FUNCTION_BLOCK Motor VAR_INPUT run : BOOL; END_VAR VAR turns : DINT; END_VAR IF run THEN turns := turns + 1; END_IF END_FUNCTION_BLOCK
PROGRAM Main VAR m : ARRAY[1..3] OF Motor; count : INT; gone : INT := 9; END_VAR count := count + 1; m[1](run := TRUE); END_PROGRAM
ST
cat >v2.st <<'ST'
FUNCTION_BLOCK Motor VAR_INPUT run : BOOL; END_VAR VAR turns : DINT; hours : REAL := 1.5; END_VAR IF run THEN turns := turns + 1; END_IF END_FUNCTION_BLOCK
PROGRAM Main VAR m : ARRAY[1..3] OF Motor; count : DINT; added : BOOL := TRUE; END_VAR count := count + 1; m[1](run := TRUE); END_PROGRAM
ST
cat >renamed.st <<'ST'
TYPE Box : STRUCT n : INT; END_STRUCT END_TYPE
FUNCTION_BLOCK Motor VAR_INPUT run : BOOL; END_VAR VAR turns : DINT; END_VAR IF run THEN turns := turns + 1; END_IF END_FUNCTION_BLOCK
PROGRAM Main VAR m : ARRAY[1..3] OF Motor; {renamed '.n' from := 'count'} box : Box; {renamed from := 'gone'} stays : INT := 9; END_VAR box.n := box.n + 1; m[1](run := TRUE); END_PROGRAM
ST
stc build v1.st -o v1.img 2>/dev/null
expect 7 stvm status --dir nowhere
said 'R0404.*nowhere'
mkdir quiet
expect 7 stvm status --dir quiet
said 'R0404'
serve plc v1.img

expect 0 stvm get --dir plc Main.count Main.m[1].turns
said 'Main.count'
expect 7 stvm get --dir plc Main.cuont
said 'R0401'
expect 7 stvm set --dir plc Main.count=hello
said 'R0402'
expect 0 stvm set --dir plc Main.gone=77
expect 0 stvm get --dir plc Main.gone
said '77'
expect 7 stvm force --dir plc Main.nope=1
said 'R0401'

expect 0 stvm status --dir plc
said 'instances +3 '
said 'free [0-9]+ of [0-9]+ bytes'
expect 0 stvm status --dir plc --format json
said '"largest_free": *[1-9]'
expect 7 stvm change v2.st --dir plc --dry-run
said 'converted'
said 'Main.gone'
# X2: the live values of what was renamed or moved.
expect 0 stvm change renamed.st --dir plc --dry-run
said 'kept +Main.stays : INT +77'
said '[0-9]+ +.renamed from .count., moved inside'
expect 7 stvm get --dir plc Main.added
expect 0 stvm change v2.st --dir plc --yes --allow-loss
said 'pause'
said 'missed'
expect 0 stvm get --dir plc Main.added Main.m[2].hours
said 'TRUE'
said '1\.5'
expect 0 stvm status --dir plc
said 'trial'
# X4: undo has a fate report of its own.
expect 0 stvm undo --dir plc --dry-run
said 'initialised +Main.gone : INT'
said 'as it was before the change'
said 'dropped +Main.added : BOOL +TRUE'
expect 0 stvm undo --dir plc --dry-run --format json
said '"undone": *false'
said '"variable": *"Main.gone"'
expect 0 stvm status --dir plc
said 'trial'
expect 0 stvm undo --dir plc
said 'undone between'
expect 0 stvm get --dir plc Main.gone
said '77'
expect 7 stvm undo --dir plc
said 'R0305'
expect 2 stvm change v2.st --dir plc --yes --strategy copy
said 'R0504.*in-place or standby'
expect 0 stvm change v2.st --dir plc --yes --allow-loss --strategy standby
said 'pause'
expect 0 stvm get --dir plc Main.added Main.m[2].hours
said 'TRUE'
said '1\.5'
expect 0 stvm undo --dir plc
expect 0 stvm get --dir plc Main.gone
said '77'
expect 0 stvm change v2.st --dir plc --yes --allow-loss --format json
said '"counts"'
expect 0 stvm accept --dir plc
expect 7 stvm undo --dir plc
said 'R0305'
printf 'PROGRAM Main VAR x : NOTYPE; END_VAR END_PROGRAM\n' >bad.st
expect 1 stvm change bad.st --dir plc --yes
said 'E[0-9]+'
expect 0 stvm get --dir plc Main.added
expect 0 stvm stop --dir plc
expect 7 stvm status --dir plc
serve plc
expect 0 stvm get --dir plc Main.added
expect 0 stvm stop --dir plc
