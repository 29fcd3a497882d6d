#!/bin/sh
# What forcing says of itself: whether a force holds everywhere, and if not, why; and what goes on beside it.
. "$(dirname "$0")/lib.sh"

{
  echo 'VAR_GLOBAL level, shared : INT; END_VAR'
  echo 'FUNCTION_BLOCK Valve VAR_OUTPUT open : INT; END_VAR'
  echo '  open := open + 1;'
  echo 'END_FUNCTION_BLOCK'
  for i in $(seq 33); do echo "FUNCTION F$i : INT VAR_IN_OUT v : INT; END_VAR v := v + 1; F$i := v; END_FUNCTION"; done
  echo 'PROGRAM Main VAR a, b : Valve; seen, opened, n : INT; END_VAR'
  echo '  level := level + 1;'
  echo '  seen := level;'
  echo '  a(); b(); opened := a.open;'
  for i in $(seq 33); do echo "  n := F$i(shared);"; done
  echo 'END_PROGRAM'
} >v1.st
sed 's/level + 1/level + 2/' v1.st >v2.st
serve plc v1.st

# What it says of machine code, when that is made.
with_machine_code() {
  for _ in $(seq 4000); do
    stvm status --dir plc >out
    grep -q 'code  *native' out && return 0
    sleep 0.05
  done
  fail "no machine code"
}
# The next scan has.
has_seen() {
  for _ in $(seq 4000); do
    expect 0 stvm get --dir plc Main.seen Main.opened
    grep -qx "Main.seen=$1" out && return 0
    sleep 0.05
  done
  fail "Main.seen is not $1"
}
expect 0 stvm force --dir plc level=40 Main.a.open=7 shared=3
said '^level=40  everywhere$'
said '^Main.a.open=7  everywhere$'
said '^shared=3  at the boundaries of cycles: `F1` in line 5 may write it by VAR_IN_OUT or by a reference, and so may more than 31 other POUs$'
has_seen 40
said '^Main.opened=7$'
expect 0 stvm get --dir plc --forces
said '^level=40  everywhere$'
said '^shared=3  at the boundaries'
expect 0 stvm force --dir plc level=41 --format json
said '"path":"level"'
said '"everywhere":true'
! grep -q reason out || fail "a reason for what holds everywhere"
expect 0 stvm get --dir plc --forces --format json
said '"everywhere":false'
said '"reason":"`F1` in line 5'
with_machine_code
expect 0 stvm status --dir plc
said 'forces +3, 1 at the boundaries of cycles'
said 'Valve: it writes where a variable is forced'
expect 0 stvm status --dir plc --format json
said '"boundary_forces":1'

# The next version too, and the old one after undo.
expect 0 stvm change --dir plc --yes v2.st
expect 0 stvm get --dir plc --forces
said '^level=41  everywhere$'
has_seen 41
expect 0 stvm undo --dir plc
expect 0 stvm unforce --dir plc Main.a.open shared
expect 0 stvm get --dir plc --forces
said '^level=41  everywhere$'
expect 0 stvm status --dir plc
said 'forces +1$'
expect 0 stvm unforce --dir plc --all
expect 0 stvm get --dir plc --forces
expect 7 stvm force --dir plc level=hello

# A run says what a force cannot do.
expect 0 stvm run v1.st --scans 3 --force level=40 --force shared=3 --print Main.seen
said '^shared is forced at the boundaries of cycles: `F1` in line 5'
said 'Main.seen=40'
! grep -q 'level is forced' err || fail "a note on what holds everywhere"

# A force that ends because the program that comes has no place for it is an event, once (R-10).
sed 's/seen, opened, n : INT/seen, opened : INT; n, added : INT/; s/^VAR_GLOBAL level/VAR_GLOBAL/; s/^  level := .*//; s/seen := level/seen := shared/; s/^VAR_GLOBAL,/VAR_GLOBAL/' v1.st >v3.st
who=$(id -un)
ended() { expect 0 stvm events --dir plc; [ "$(grep -cE " notice unforced by $who: without a place in the program that runs now: $1\$" out)" -eq "$2" ] || fail "not $2 times: $1"; }
expect 0 stvm force --dir plc level=40 Main.seen=5
expect 0 stvm change --dir plc --yes --allow-loss --allow-overrun v3.st
ended level 1
expect 0 stvm force --dir plc Main.added=7
expect 0 stvm undo --dir plc --yes
ended Main.added 1
ended level 1
expect 0 stvm change --dir plc --yes --allow-loss --allow-overrun v2.st
expect 0 stvm undo --dir plc --yes
expect 0 stvm get --dir plc --forces
said '^Main.seen=5'
ended '.*' 2

# An undo that brings a force back is an event, also with another edit above it; so is the end of the
# controller, which no force outlives.
sed 's/added : INT/added, more : INT/' v3.st >v4.st
expect 0 stvm unforce --dir plc --all
expect 0 stvm force --dir plc level=44
expect 0 stvm change --dir plc --yes --allow-loss --allow-overrun v3.st
expect 0 stvm change --dir plc --yes --allow-overrun v4.st
expect 0 stvm undo --dir plc --yes
expect 0 stvm undo --dir plc --dry-run
said 'force +level  .comes back: 44.'
expect 0 stvm undo --dir plc --yes
expect 0 stvm get --dir plc --forces
said '^level=44  everywhere$'
expect 0 stvm events --dir plc
said " warning forced by $who: again, as before the edit that was undone: level=44\$"
[ "$(grep -c 'again.*: level=44$' out)" -eq 1 ] || fail "a force comes back twice"
[ "$(grep -c 'without a place' out)" -eq 3 ] || fail "a force ends twice"
expect 0 stvm stop --dir plc
expect 0 stvm journal --dir plc
said '^    with the end of the controller: level$'
