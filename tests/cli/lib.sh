# For the scripts of this folder: `. "$(dirname "$0")/lib.sh"`. Each is called with
# SOURCE_DIR BUILD_DIR, works in a folder of its own, and fails at the first broken expectation.
set -eu
source_dir=$1
bin=$2/bin
work=$(mktemp -d)
cd "$work"
cleanup() {
  for pid_file in "$work"/*.pid; do
    [ -e "$pid_file" ] && kill "$(cat "$pid_file")" 2>/dev/null || true
  done
  wait || true  # a controller that stops still writes into its folder
  rm -rf "$work"
}
trap cleanup EXIT INT TERM

# yes: built with a sanitizer, which makes system calls that --seccomp does not allow.
sanitized=no seccomp=--seccomp
if grep -qE '^STC_SANITIZE:[A-Z]*=.*(address|thread)' "$2/CMakeCache.txt" 2>/dev/null; then
  sanitized=yes seccomp=
fi

fail() {
  echo "FAILED: $*"
  [ -e out ] && sed 's/^/  out: /' out
  [ -e err ] && sed 's/^/  err: /' err
  exit 1
}

# expect CODE COMMAND...: runs it, output in ./out and ./err, and checks the exit code. A change that
# is to succeed is made again while other processes of the machine leave the tasks no time for it
# (R0304, R0306): the refusal has changed nothing. Such a refusal is wanted by its code, 7.
expect() {
  wanted=$1
  shift
  for _ in $(seq 4000); do
    code=0
    "$@" >out 2>err </dev/null || code=$?
    [ "$wanted$code" = 07 ] && grep -qE 'R030[46]' err out || break
    sleep 0.05
  done
  [ "$code" -eq "$wanted" ] || fail "exit code $code instead of $wanted: $*"
}
# needs_xml COMMAND...: as `expect 0`. A build without pugixml refuses it and says what is missing;
# there the test ends.
needs_xml() {
  code=0
  "$@" >out 2>err </dev/null || code=$?
  if grep -q 'built without pugixml' err; then
    [ "$code" -eq 7 ] || fail "refused with $code"
    said 'libpugixml-dev'
    echo "built without pugixml: refused, as it should be"
    exit 0
  fi
  [ "$code" -eq 0 ] || fail "exit code $code instead of 0: $*"
}
# said REGEX: the last command printed it, on either stream.
said() { cat out err | grep -qE -- "$1" || fail "not said: $1"; }
# json EXPRESSION: it holds for `d`, what the last command printed on standard output as JSON.
json() {
  python3 -c 'import json, sys
d = json.load(open("out"))
sys.exit(not eval("(" + sys.argv[1] + ")"))' "$1" || fail "not so: $1"
}
# wait_for REGEX COMMAND...: runs it, output in ./out, until it prints that. So often that a loaded
# machine does not matter: a test that fails takes its time.
wait_for() {
  wanted=$1
  shift
  for _ in $(seq 4000); do
    "$@" >out 2>&1 || true
    grep -qE -- "$wanted" out && return
    sleep 0.05
  done
  fail "never: $wanted from $*"
}
# wait_saved DIR: the retained values of now, which change all the time, are on the disk: the second
# of two saves has begun behind this call.
wait_saved() {
  for save in 1 2; do
    was=$(cat "$1"/retain_* | cksum)
    for _ in $(seq 4000); do
      [ "$(cat "$1"/retain_* | cksum)" = "$was" ] || continue 2
      sleep 0.05
    done
    fail "nothing is saved in $1"
  done
}
silent_on() { [ ! -s "$1" ] || fail "nothing expected on $1"; }

stc() { "$bin/stc" "$@"; }
stvm() { "$bin/stvm" "$@"; }

# serve DIR [OPTIONS] [IMAGE]: starts a controller and waits until it answers.
serve() {
  dir=$1
  shift
  "$bin/stvm" serve --dir "$dir" "$@" >"$dir.log" 2>&1 &
  echo $! >"$work/$(basename "$dir").pid"
  for _ in $(seq 4000); do
    "$bin/stvm" status --dir "$dir" >/dev/null 2>&1 && return 0
    kill -0 $! 2>/dev/null || break
    sleep 0.05
  done
  cat "$dir.log"
  fail "controller in $dir does not answer"
}
# power_cut NAME: the controller of folder NAME is gone, at whatever instruction it is, and has let
# go of its folder: a signal alone is only on its way.
power_cut() {
  kill -9 "$(cat "$work/$1.pid")"
  wait "$(cat "$work/$1.pid")" 2>/dev/null || true
}
