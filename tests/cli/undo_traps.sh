#!/bin/sh
# X7: who undoes an edit hears it when the program that comes back does not bear the values, and what
# the ways out are; who brings it again hears it, too.
. "$(dirname "$0")/lib.sh"

cat >v1.st <<'ST'
PROGRAM Main
VAR ring : ARRAY[0..7] OF INT; i : INT; END_VAR
ring[i] := 1;
END_PROGRAM
ST
sed 's/0\.\.7/0..79/' v1.st >v2.st
serve plc v1.st
expect 0 stvm change v2.st --dir plc --yes --allow-overrun
expect 0 stvm set Main.i=40 --dir plc
expect 7 stvm undo --dir plc --yes
said 'E1 undone between'
said 'R0407: the program that came back stops: cycle [0-9]+, task .*index'
said 'stvm redo'
expect 0 stvm status --dir plc
said 'FAULT'
said 'stvm restart. runs it again: RETAIN keeps its values, all else begins anew'
said 'stvm restart --hot. goes on with all values'
said 'stvm redo. brings the edit again'
expect 0 stvm redo --dir plc --yes --allow-overrun
expect 0 stvm get Main.i --dir plc
said '^Main.i=40$'
expect 7 stvm undo --dir plc --yes --format json
said '"undone": ?true'
said '"refused": ?"R0407"'
expect 0 stvm set Main.i=2 --dir plc
expect 0 stvm restart --hot --dir plc
expect 0 stvm status --dir plc
said ': running'
! grep -q 'stvm redo' out || fail "no fault, and a way out of it"

# redo: the edit traps again.
sed 's/ring\[i\] := 1;/ring[i] := 1; IF i > 3 THEN i := i \/ (i - i); END_IF;/' v1.st >v3.st
serve two v1.st
expect 0 stvm change v3.st --dir two --yes --allow-overrun
expect 0 stvm undo --dir two --yes
expect 0 stvm set Main.i=5 --dir two
expect 7 stvm redo --dir two --yes --allow-overrun
said 'R0325: E1 undone by the controller'
