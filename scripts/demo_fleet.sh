#!/bin/sh
# make demo-fleet: an edit for the five controllers of a pumping district. One has a block of its
# own, one would lose a value, and one cannot be reached. Then by waves: a canary takes back an edit
# that is wrong. Half a minute. usage: demo_fleet.sh BIN
set -eu
bin=$(cd "$1" && pwd)
cd "$(dirname "$0")/.."
state=$(mktemp -d)
demo=""
cleanup() {
  [ -z "$demo" ] || kill "$demo" 2>/dev/null || true
  wait || true  # it ends its controllers, which write into the folder until then
  rm -rf "$state"
}
trap cleanup EXIT
trap 'exit 1' HUP INT PIPE TERM

PATH=$bin:$PATH examples/fleet/run.sh "$state" &
demo=$!
code=0
wait "$demo" || code=$?
demo=""
exit "$code"
