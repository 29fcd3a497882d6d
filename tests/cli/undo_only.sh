#!/bin/sh
# Case 77, D3: three edits on trial, one after the other; the first one is taken back alone, where the
# others do not depend on it. Where they do, that is said, and nothing happens.
. "$(dirname "$0")/lib.sh"

# project FILE A B C GLOBALS: what A, B and C do.
project() {
  cat >"$1" <<ST
VAR_GLOBAL level : INT; ${5:-} END_VAR
FUNCTION_BLOCK A VAR_OUTPUT n : DINT; END_VAR $2 END_FUNCTION_BLOCK
FUNCTION_BLOCK B VAR_OUTPUT n : DINT; END_VAR $3 END_FUNCTION_BLOCK
FUNCTION_BLOCK C VAR_OUTPUT n : DINT; END_VAR $4 END_FUNCTION_BLOCK
PROGRAM Main VAR a1 : A; b1 : B; c1 : C; END_VAR a1(); b1(); c1(); END_PROGRAM
ST
}
change() { expect 0 stvm change "$1" --dir plc --yes --allow-overrun; }

one='n := n + 1;'
project v0.st "$one" "$one" "$one"
project v1.st 'n := n + 1; added := added + 1;' "$one" "$one" 'added : DINT;'
project v2.st 'n := n + 1; added := added + 1;' 'n := n + 1; seen := seen + 1;' "$one" \
  'added : DINT; seen : DINT := 100;'
project v3.st 'n := n + 1; added := added + 1;' 'n := n + 1; seen := seen + 1;' 'n := n + 3;' \
  'added : DINT; seen : DINT := 100;'
serve plc v0.st
for n in 1 2 3; do change v$n.st; done
expect 0 stvm get --dir plc seen
before=$(sed -n 's/^seen=//p' out)

# What E1 added goes, with its value: that needs leave.
expect 7 stvm undo E1 --only --dir plc --yes --allow-overrun
said 'R0303'
expect 0 stvm undo E1 --only --dir plc --dry-run --allow-loss --allow-overrun
said 'A +.body'
expect 0 stvm edits --dir plc
said '^E3 '
! grep -q '^E4 ' out || fail "a dry run is an edit"
expect 0 stvm undo E1 --only --dir plc --yes --allow-loss --allow-overrun
said '^code +A +.body'
! grep -qE '^code +[BC] ' out || fail "another unit is touched"
expect 0 stvm edits --dir plc
said '^E4 '
said '^  POUs +A .body.$'
expect 7 stvm get --dir plc added
expect 0 stvm get --dir plc seen
after=$(sed -n 's/^seen=//p' out)
[ "$after" -ge "$before" ] || fail "the value of a later edit was lost: $before, $after"

expect 0 stvm journal --dir plc
said 'edit E4, E1 alone is taken back'

# To bring it again is to undo that.
expect 0 stvm undo --dir plc --yes
expect 0 stvm get --dir plc added
expect 0 stvm edits --dir plc
said '^E3 '

# X4: what the edit had taken away comes back with its value, as by undo, and again by redo.
cat >start.st <<'ST'
FUNCTION_BLOCK A VAR n : DINT; keep : DINT := 3; name : STRING[10] := 'new'; END_VAR n := n + 1; END_FUNCTION_BLOCK
FUNCTION_BLOCK B VAR n : DINT; END_VAR n := n + 1; END_FUNCTION_BLOCK
PROGRAM Main VAR a1 : A; b1 : B; END_VAR a1(); b1(); END_PROGRAM
ST
sed "s/ keep : DINT := 3; name : STRING\[10\] := 'new';//" start.st >without.st
sed '/^FUNCTION_BLOCK B/s/n + 1/n + 2/' without.st >later.st
serve second start.st
expect 0 stvm set Main.a1.keep=4711 "Main.a1.name='old'" --dir second
expect 0 stvm change without.st --dir second --yes --allow-loss --allow-overrun
expect 0 stvm change later.st --dir second --yes --allow-overrun
expect 0 stvm undo E1 --only --dir second --yes --allow-overrun
expect 0 stvm get Main.a1.keep Main.a1.name --dir second
said '^Main.a1.keep=4711$'
said "^Main.a1.name='old'$"
expect 0 stvm undo --dir second --yes --allow-loss
expect 7 stvm get Main.a1.keep --dir second
expect 0 stvm redo --dir second --yes --allow-overrun
expect 0 stvm get Main.a1.keep --dir second
said '^Main.a1.keep=4711$'

# Over a stop and start, too.
expect 0 stvm stop --dir plc
serve plc
expect 0 stvm undo E2 --only --dir plc --yes --allow-loss --allow-overrun
expect 7 stvm get --dir plc seen
expect 0 stvm get --dir plc added
expect 0 stvm undo --dir plc --yes
for n in 3 2 1; do expect 0 stvm undo --dir plc --yes; done

# A later edit has edited the same unit, or uses what the first one added.
project w2.st 'n := n + 2; added := added + 1;' "$one" "$one" 'added : DINT;'
project x2.st 'n := n + 1; added := added + 1;' 'n := n + added;' "$one" 'added : DINT;'
change v1.st
change w2.st
expect 0 stvm edits --dir plc
first=$(sed -n 's/^\(E[0-9]*\) .*/\1/p' out | head -1)
expect 7 stvm undo "$first" --only --dir plc --yes --allow-loss --allow-overrun
said "R0320: later edits depend on $first: unit .A. is another one here"
said 'an edit that .undo --only. cannot take back goes with the later ones'
expect 0 stvm undo --dir plc --yes
change x2.st
expect 7 stvm undo "$first" --only --dir plc --yes --allow-loss --allow-overrun
said "R0321: later edits depend on $first: .B. uses .added., which is not there"
said 'an edit that .undo --only. cannot take back goes with the later ones'
expect 0 stvm edits --dir plc
said "^$first "

# The newest one needs no --only, and one must be named.
newest=$(sed -n 's/^\(E[0-9]*\) .*/\1/p' out | tail -1)
expect 2 stvm undo "$newest" --only --dir plc --yes
expect 2 stvm undo --only --dir plc --yes
expect 7 stvm undo E99 --only --dir plc --yes
said 'R0305'

# X4: what the edit had converted comes back too, unless it was written since: that is converted
# from what it is now, with its loss. A dry run says the same (case 78).
cat >wide.st <<'ST'
PROGRAM Main VAR a, b : INT; part, cut : INT; n : DINT; END_VAR n := n + 1; END_PROGRAM
FUNCTION_BLOCK Other VAR n : DINT; END_VAR n := n + 1; END_FUNCTION_BLOCK
PROGRAM Second VAR o : Other; END_VAR o(); END_PROGRAM
ST
sed 's/a, b : INT; part, cut : INT;/a, b : DINT; part : SINT; cut : INT(0..100);/' wide.st >edit.st
sed '/^FUNCTION_BLOCK/s/n + 1/n + 2/' edit.st >behind.st
serve third wide.st
expect 0 stvm set Main.a=7 Main.b=8 Main.part=300 Main.cut=400 --dir third
expect 0 stvm change edit.st --dir third --yes --allow-loss --allow-overrun
expect 0 stvm change behind.st --dir third --yes --allow-overrun
expect 0 stvm set Main.b=100000 --dir third
expect 0 stvm get Main.part Main.cut --dir third
said '^Main.part=127$'
said '^Main.cut=100$'
expect 7 stvm undo E1 --only --dir third --dry-run --allow-overrun --format json
said '"loss_count": ?1'
expect 7 stvm undo E1 --only --dir third --dry-run --allow-overrun
mv out dry
grep -E '^Main.b +100000 +32767 +saturates' dry >/dev/null || fail "no loss: $(cat dry)"
comes() { grep -E "$1" dry >/dev/null || fail "not what comes back: $(cat dry)"; }
comes '^ +127 -> 300 \(retyped, as before the edit'
comes '^ +100 -> 400 \(as before the edit'
expect 7 stvm undo E1 --only --dir third --yes --allow-overrun
said 'R0303'
grep -E '^(converted|Main|  )' dry >dry.rows
grep -E '^(converted|Main|  )' out | diff dry.rows - || fail "a dry run says something else"
expect 0 stvm undo E1 --only --dir third --yes --allow-overrun --allow-loss
expect 0 stvm get Main.a Main.b Main.part Main.cut --dir third
said '^Main.a=7$'
said '^Main.b=32767$'
said '^Main.part=300$'
said '^Main.cut=400$'
expect 0 stvm undo --dir third --yes
expect 0 stvm get Main.b Main.part Main.cut --dir third
said '^Main.b=100000$'
said '^Main.part=127$'
said '^Main.cut=100$'

# What it had renamed by a rule goes back to its name, with the value that it has now.
cat >plain.st <<'ST'
FUNCTION_BLOCK Tank VAR level : INT := 3; mode : (off, on) := on; END_VAR level := level; END_FUNCTION_BLOCK
FUNCTION_BLOCK Other VAR n : DINT; END_VAR n := n + 1; END_FUNCTION_BLOCK
PROGRAM Main VAR t : Tank; o : Other; n : DINT; END_VAR t(); o(); n := n + 1; END_PROGRAM
ST
sed "s/level : INT := 3;/{renamed from := 'level'} height : INT := 3;/; s/level := level/height := height/" \
  plain.st >named.st
sed '/^FUNCTION_BLOCK Other/s/n + 1/n + 2/' named.st >more.st
serve fourth plain.st
expect 0 stvm set Main.t.level=300 --dir fourth
expect 0 stvm change named.st --dir fourth --yes --allow-overrun
expect 0 stvm change more.st --dir fourth --yes --allow-overrun
expect 0 stvm set Main.t.height=301 --dir fourth
expect 0 stvm undo E1 --only --dir fourth --yes --allow-overrun
said 'renamed from .height.'
expect 0 stvm get Main.t.level --dir fourth
said '^Main.t.level=301$'
expect 0 stvm set Main.t.level=302 --dir fourth
expect 0 stvm undo --dir fourth --yes
expect 0 stvm get Main.t.height --dir fourth
said '^Main.t.height=302$'
