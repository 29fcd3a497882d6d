#!/bin/sh
# --seccomp: every thread of a controller has its filter, and all that a controller does works: devices, retained values,
# online change, undo, forces, recording, machine code, names of users.
. "$(dirname "$0")/lib.sh"
if [ -z "$seccomp" ]; then
  echo "left out: what looks for leaks at the end of a process wants to look into it"
  exit 77
fi
name=/stc_seccomp_$$
trap 'rm -f /dev/shm$name; cleanup' EXIT INT TERM
mkdir plant
cat >plant/main.st <<'ST'
PROGRAM Main
VAR RETAIN n : DINT; END_VAR
VAR level AT %IW0 : INT; good AT %IX8.0 : BOOL; pump AT %QX0.0 : BOOL; factor : INT := 2; END_VAR
n := n + 1; pump := n MOD 100 < 50;
END_PROGRAM
ST
cat >plant/stc.toml <<T
[devices.tank]
driver = "shared-memory"
name = "$name"
period_ms = 5
timeout_ms = 60000
quality = "%IX8.0"
map = ["byte 0..1 -> %IW0", "bit 0 <- %QX0.0"]
T
stc build plant -o plant.img 2>/dev/null
serve plc --seccomp --record plc.rec plant.img
program=$(stvm get --list --dir plc | sed -n 's/^\([A-Za-z]*\)\.level.*/\1/p')
pid=$(cat plc.pid)
filtered() { cat /proc/"$pid"/task/*/status | grep -c "$1" || true; }
all=$(filtered '^Seccomp:')
[ "$all" -ge 4 ] || fail "only $all threads"
[ "$(filtered '^Seccomp:[[:space:]]*2')" -eq "$all" ] || fail 'a thread has no filter'
[ "$(filtered '^NoNewPrivs:[[:space:]]*1')" -eq "$all" ] || fail 'a thread could get privileges'
# Device and control thread have one more than the process.
[ "$(filtered '^Seccomp_filters:[[:space:]]*2')" -ge 2 ] || fail 'control and device threads have no filter of their own'

"$bin/shared_memory_client" $name 100000 &
echo $! >client.pid
wait_for "^$program.good=TRUE" stvm get "$program.good" --dir plc
[ "$(uname -m)" != x86_64 ] || wait_for '^ +code +native, [1-9]' stvm status --dir plc
expect 0 stvm force "$program.factor=7" --dir plc
expect 0 stvm unforce --all --dir plc
sed -i 's/factor : INT := 2/factor : INT := 2; more : INT := 5/' plant/main.st
expect 0 stvm change plant --dir plc --yes
wait_for "^$program.more=5" stvm get "$program.more" --dir plc
expect 0 stvm undo --dir plc
expect 0 stvm change plant --dir plc --yes --strategy standby
expect 0 stvm accept --dir plc
wait_for "^$program.n=[0-9][0-9]+" stvm get "$program.n" --dir plc
expect 0 stvm stop --dir plc
expect 0 stvm replay plc.rec
serve plc --seccomp
expect 0 stvm get "$program.n" --dir plc
said "^$program.n=[0-9][0-9]+"
expect 0 stvm stop --dir plc
grep -iE 'alarm|not permitted' plc.log && fail 'the filter was in the way'

# From sources: the compiler is another program, and runs before.
mkdir plain
echo 'PROGRAM P VAR n : INT; END_VAR n := n + 1; END_PROGRAM' >plain/main.st
serve from_sources --seccomp plain
expect 0 stvm stop --dir from_sources
echo "seccomp: $all threads, each with a filter, and all works"
