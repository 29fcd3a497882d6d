#!/bin/sh
# case79: eight tools change one controller at once: those who are too late are told who was faster,
# and with --wait each of them gets its turn.
. "$(dirname "$0")/lib.sh"
program() { echo "PROGRAM Main VAR n : DINT; which : INT := $1; END_VAR n := n + $1; END_PROGRAM" >"v$1.st"; }
for i in 0 1 2 3 4 5 6 7 8; do program $i; done
expect 0 stc build v0.st -o v0.img
serve plc v0.img
all_at_once() {  # all_at_once SUFFIX OPTIONS...: v1.SUFFIX and so on
  suffix=$1
  shift
  for i in 1 2 3 4 5 6 7 8; do
    ( code=0; "$bin/stvm" change "v$i.$suffix" --yes --dir plc "$@" >"out.$i" 2>"err.$i" || code=$?; echo $code >"code.$i" ) &
    tools="${tools:-} $!"
  done
  for pid in $tools; do wait "$pid"; done
  tools=
}
switches() { stvm journal --dir plc | grep -c ' switched '; }

# All of them know v0: who begins late on a busy machine would else make a change to the winner's.
for i in 1 2 3 4 5 6 7 8; do expect 0 stc package --base v0.img "v$i.st" -o "v$i.pkg"; done
all_at_once pkg
won=$(cat code.? | grep -c '^0$' || true)
[ "$won" = 1 ] || fail "$won of eight won: $(cat code.?)"
for i in 1 2 3 4 5 6 7 8; do
  [ "$(cat "code.$i")" = 0 ] && continue
  grep -qE "R0301.*made by |R0302.*(, by |is bringing)" "err.$i" || fail "not told who: $(cat "err.$i")"
done
[ "$(switches)" = 1 ] || fail "$(switches) switches"
expect 0 stvm undo --dir plc

before=$(switches)
all_at_once st --permanent --wait
[ "$(cat code.? | sort -u)" = 0 ] || fail "not all had their turn: $(cat code.? err.?)"
[ $(($(switches) - before)) = 8 ] || fail "$(switches) switches, $before before"
