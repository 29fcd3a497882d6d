#!/bin/sh
# The demo leaves no controller and no folder behind when it is told to end, when its terminal goes away, and when nobody reads any more.
. "$(dirname "$0")/lib.sh"

mkdir tmp
for signal in TERM HUP PIPE; do
  TMPDIR=$work/tmp setsid env --default-signal=PIPE sh "$source_dir/scripts/demo.sh" "$bin" >demo.out 2>&1 &
  echo $! >demo.pid
  wait_for 'stvm watch' cat demo.out
  kill -s $signal -- -"$(cat demo.pid)"  # as Ctrl+C: what it started, too
  left() { ls tmp | wc -l; }
  wait_for '^0$' left  # no folder, so no controller
done
rm demo.pid
