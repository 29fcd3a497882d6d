#!/bin/sh
# What forcing says of itself: whether a force holds everywhere, and if not, why; and what goes on beside it.
. "$(dirname "$0")/lib.sh"

cat >v1.st <<'ST'
VAR_GLOBAL level : INT; END_VAR
FUNCTION_BLOCK Valve VAR_OUTPUT open : INT; END_VAR
  open := open + 1;
END_FUNCTION_BLOCK
PROGRAM Main VAR a, b : Valve; seen, n : INT; list : ARRAY[0..3] OF INT; i : INT; END_VAR
  level := level + 1;
  seen := level;
  list[i] := seen;
  a(); b(); n := n + 1;
END_PROGRAM
ST
sed 's/level + 1/level + 2/' v1.st >v2.st
serve plc v1.st

expect 0 stvm force --dir plc level=40 Main.a.open=7 'Main.list[0]=3'
said '^level=40  everywhere$'
said '^Main.a.open=7  at the boundaries of cycles: `Valve` in line 3 writes it, for other instances too$'
said '^Main.list\[0\]=3  at the boundaries of cycles: `Main` in line 8 may write it by an index$'
expect 0 stvm get --dir plc Main.seen
said '^Main.seen=40$'
expect 0 stvm get --dir plc --forces
said '^level=40  everywhere$'
said '^Main.a.open=7  at the boundaries'
expect 0 stvm force --dir plc level=41 --format json
said '"path":"level"'
said '"everywhere":true'
! grep -q reason out || fail "a reason for what holds everywhere"
expect 0 stvm get --dir plc --forces --format json
said '"everywhere":false'
said '"reason":"`Valve` in line 3'
expect 0 stvm status --dir plc
said 'forces +3, 2 at the boundaries of cycles'
expect 0 stvm status --dir plc --format json
said '"boundary_forces":2'

# The next version too, and the old one behind undo.
expect 0 stvm change --dir plc --yes v2.st
expect 0 stvm get --dir plc --forces
said '^level=41  everywhere$'
expect 0 stvm get --dir plc Main.seen
said '^Main.seen=41$'
expect 0 stvm undo --dir plc
expect 0 stvm unforce --dir plc Main.a.open 'Main.list[0]'
expect 0 stvm get --dir plc --forces
said '^level=41  everywhere$'
expect 0 stvm status --dir plc
said 'forces +1$'
expect 0 stvm unforce --dir plc --all
expect 0 stvm get --dir plc --forces
expect 7 stvm force --dir plc level=hello
