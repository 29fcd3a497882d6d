#!/bin/sh
# Starts three controllers in a folder, makes one edit on those that it fits, and takes it back. stc
# and stvm are found in PATH.
# usage: run.sh FOLDER
set -eu
here=$(cd "$(dirname "$0")" && pwd)
mkdir -p "$1"
cd "$1"
mkdir -p state
pids=""
stop() {
  for pid in $pids; do kill "$pid" 2>/dev/null || true; done
  wait
}
trap stop EXIT INT TERM

serve() {  # serve NAME SOURCES...
  name=$1
  shift
  stvm serve --dir "state/$name" --name line "$@" 2>"state/$name.log" &
  pids="$pids $!"
  until stvm status --dir "state/$name" >/dev/null 2>&1; do sleep 0.1; done
}
step() {
  printf '\n$ %s\n' "$*"
  "$@" || echo "(exit code $?)"
}

cp "$here/fleet.toml" .
serve line1 "$here"
serve line2 "$here/main.st" "$here/filler.st" "$here/line2/capper.st"
serve line3 "$here/main.st" "$here/line3/filler.st" "$here/capper.st"

stc build "$here" -o before.img
stc build "$here/main.st" "$here/faster/filler.st" "$here/capper.st" --name line -o after.img
step stc fleet before.img after.img -o faster.fleet --text 'fills in half the time'
step stvm fleet status --fleet fleet.toml
step stvm fleet status faster.fleet --fleet fleet.toml
step stvm fleet change faster.fleet --fleet fleet.toml --yes --allow-overrun
step stvm status --units --dir state/line2
step stvm fleet diff line1 line2 --fleet fleet.toml
step stvm fleet undo faster.fleet --fleet fleet.toml --yes
