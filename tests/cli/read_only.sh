#!/bin/sh
# case56: a file system that has become read-only. The intact program boots with its retained
# values, can be asked and forced, says what it cannot store, and refuses what must be stored.
if [ "${3-}" != mounted ]; then
  unshare -m true 2>/dev/null || { echo "left out: no mounts here"; exit 77; }
  exec unshare -m "$0" "$1" "$2" mounted
fi
. "$(dirname "$0")/lib.sh"
mkdir disk
trap 'umount -l "$work/disk"; cleanup' EXIT INT TERM
mount -t tmpfs tmpfs disk
dir=disk/plc
cat >v1.st <<'ST'
VAR_GLOBAL RETAIN total : DINT; END_VAR
PROGRAM Main total := total + 1; END_PROGRAM
ST
sed 's/+ 1/+ 2/' v1.st >v2.st
stop() {
  kill "$1" "$(cat plc.pid)"
  while kill -0 "$(cat plc.pid)" 2>/dev/null; do sleep 0.02; done
}
serve $dir v1.st
expect 0 stvm set total=100000 --dir $dir
stop -TERM
[ -e $dir/control ] && fail "the socket is still there"

runs_without_writing() {
  mount -o remount,ro disk
  "$bin/stvm" serve --dir $dir >serve.log 2>&1 &
  echo $! >plc.pid
  wait_for 'running' stvm status --dir $dir
  expect 0 stvm get total --dir $dir
  said 'total=10[0-9]*'
  wait_for 'alarm: .*Read-only file system' stvm status --dir $dir
  expect 0 stvm events --dir $dir
  said 'error alarm.*retained values are not being saved: .*Read-only file system'
  said 'error alarm.*/slot_a: Read-only file system'
  expect 0 stvm force total=7 --dir $dir
  expect 0 stvm unforce --all --dir $dir
  expect 7 stvm change v2.st --dir $dir --yes
  said 'R0409: .*Read-only file system'
  expect 0 stvm get total --dir $dir
  stop -TERM
  mount -o remount,rw disk
}
runs_without_writing
# A power cut leaves the socket of the controller that it ended.
serve $dir
stop -9
[ -e $dir/control ] || fail "no socket is left"
runs_without_writing
serve $dir
expect 0 stvm change v2.st --dir $dir --yes
