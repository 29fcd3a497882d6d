#!/bin/sh
# The demo leaves no controller and no folder behind when it is told to end, when its terminal goes away, and when nobody reads any more.
. "$(dirname "$0")/lib.sh"

mkdir tmp
for signal in TERM HUP PIPE; do
  TMPDIR=$work/tmp setsid env --default-signal=PIPE sh "$source_dir/scripts/demo.sh" "$bin" >out 2>err &
  echo $! >demo.pid
  for _ in $(seq 1200); do
    grep -q 'stvm watch' out && break
    sleep 0.1
  done
  said 'stvm watch'
  kill -s $signal -- -"$(cat demo.pid)"  # as Ctrl+C: what it started, too
  for _ in $(seq 600); do
    [ -z "$(ls tmp)" ] && break
    sleep 0.1
  done
  [ -z "$(ls tmp)" ] || fail "behind $signal the demo left: $(ls tmp/*)"
done
rm demo.pid
