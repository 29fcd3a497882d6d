#!/bin/sh
# Starts the controllers of a pumping district in a folder, and brings edits to them, one of which
# is wrong. stc and stvm are found in PATH. Half a minute. usage: run.sh FOLDER
set -eu
here=$(cd "$(dirname "$0")" && pwd)
mkdir -p "$1"
cd "$1"
mkdir -p state
pids="" shown=""
stop() {
  for pid in $pids $shown; do kill "$pid" 2>/dev/null || true; done
  wait
}
trap stop EXIT
trap 'exit 1' HUP INT PIPE TERM

bold='' plain=''
if [ -t 1 ] && [ -z "${NO_COLOR:-}" ]; then
  bold=$(printf '\033[1m')
  plain=$(printf '\033[0m')
fi
say() { printf '\n%s== %s%s\n' "$bold" "$*" "$plain"; }
step() {
  printf '\n%s$ %s%s\n' "$bold" "$*" "$plain"
  code=0
  # A shell that waits can be told to end; one that runs a command ends behind it.
  "$@" &
  shown=$!
  wait "$shown" || code=$?
  shown=""
  [ "$code" -eq 0 ] || echo "(exit code $code)"
}
serve() {  # serve NAME [SOURCES...]
  name=$1
  shift
  stvm serve --dir "state/$name" "$@" 2>"state/$name.log" &
  pids="$pids $!"
  until stvm status --dir "state/$name" >/dev/null 2>&1; do
    kill -0 $! 2>/dev/null || { cat "state/$name.log" >&2; exit 1; }
    sleep 0.1
  done
}
# edit NAME TEXT: a fleet file of what the folder NAME changes in the program of all.
edit() {
  pump=$here/$1/pump.st
  [ -e "$pump" ] || pump=$here/pump.st
  control=$here/$1/control.st
  [ -e "$control" ] || control=$here/control.st
  stc build --quiet "$here/main.st" "$pump" "$control" -o "$1.img"
  step stc fleet station.img "$1.img" -o "$1.fleet" --text "$2"
}
roll() { step stvm fleet roll "$1.fleet" --fleet fleet.toml --yes --allow-overrun; }

cp "$here/fleet.toml" .
stc build --quiet "$here" -o station.img

say "1. Five stations of a district: the mill has a pump of its own, and at the lake nobody answers"
serve north "$here"
serve harbour "$here"
serve mill "$here/main.st" "$here/mill/pump.st" "$here/control.st"
serve hill "$here"
stvm set Station.pump.starts=70000 --dir state/hill >/dev/null
step stvm fleet status --fleet fleet.toml

say "2. An edit of the pump, which is to reach all: where does it fit, and what would be lost?"
edit counter 'starts in 16 bits, and the pump runs on'
step stvm fleet status counter.fleet --fleet fleet.toml
step stvm fleet change counter.fleet --fleet fleet.toml --yes --allow-overrun
step stvm get Station.pump.starts --dir state/hill
step stvm fleet status counter.fleet --fleet fleet.toml
step stvm fleet accept counter.fleet --fleet fleet.toml --yes

say "3. An edit that is wrong, by waves: the canary fails, and takes it back by itself"
edit seldom 'the pump starts more seldom'
roll seldom
step stvm journal --dir state/north
step stvm fleet status seldom.fleet --fleet fleet.toml

say "4. The edit, mended: the canary is well, and the others follow; the lake may fail"
edit mended 'the pump starts more seldom'
roll mended
step stvm fleet watch mended.fleet.plan

say "5. The lake answers again: the same edit, for those that have it not"
serve lake "$here"
step stvm fleet change mended.fleet --fleet fleet.toml --yes --allow-overrun
step stvm fleet accept mended.fleet --fleet fleet.toml --yes
step stvm fleet status mended.fleet --fleet fleet.toml
step stvm fleet diff north mill --fleet fleet.toml
