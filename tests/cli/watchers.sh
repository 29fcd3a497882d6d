#!/bin/sh
# stvm watch: many watchers keep no command out; one goes on when a variable of its pattern goes.
. "$(dirname "$0")/lib.sh"

echo 'PROGRAM Main VAR n, gone : DINT; END_VAR n := n + 1; END_PROGRAM' >v1.st
echo 'PROGRAM Main VAR n : DINT; END_VAR n := n + 2; END_PROGRAM' >v2.st
serve plc v1.st
for i in $(seq 16); do
  "$bin/stvm" watch --dir plc 'Main.*' --interval 50 >"watch$i.out" 2>"watch$i.err" &
  echo $! >"watch$i.pid"
done
# samples OF REGEX: each watcher has one that looks so.
samples() {
  for i in $(seq 16); do
    for _ in $(seq 4000); do
      grep -qE -- "$1" "watch$i.out" && continue 2
      sleep 0.05
    done
    fail "watcher $i has no sample: $1"
  done
}
samples '^[0-9]+: Main.n=[0-9]+ Main.gone=0$'
sleep 1  # who has just come keeps his place for so long
expect 0 stvm change --dir plc --yes --allow-loss --allow-overrun v2.st
samples '^[0-9]+: Main.n=[0-9]+$'
for i in $(seq 16); do
  grep -qx 'Main.gone is not there any more' "watch$i.err" ||
    fail "watcher $i does not say what is gone: $(cat "watch$i.err")"
done
# Each takes the place of a watcher, who comes again and keeps his new one for a second.
for _ in 1 2 3; do wait_for 'v2: running' "$bin/stvm" status --dir plc; done
wait_for 'E1 undone between' "$bin/stvm" undo --dir plc --yes
wait_for '^stopped' "$bin/stvm" stop --dir plc
for i in $(seq 16); do
  wait "$(cat "watch$i.pid")" && fail 'who watches is told that the controller has gone'
  rm "watch$i.pid"
  grep -q R0404 "watch$i.err" || fail "watcher $i ended before: $(cat "watch$i.err")"
done
