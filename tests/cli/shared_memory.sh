#!/bin/sh
# Shared memory with another process: examples/shared_memory, which ends and begins again.
. "$(dirname "$0")/lib.sh"
name=/stc_test_$$
trap 'rm -f /dev/shm$name; cleanup' EXIT INT TERM
serve plc "$source_dir/examples/shared_memory/plc" --device tank.name=$name
# The other process lives until it is told to end, however long a loaded machine takes to see it.
client_begins() {
  "$bin/shared_memory_client" $name 100000000 >/dev/null 2>&1 &
  echo $! >client.pid
}
client_ends() {
  kill "$(cat client.pid)"
  wait "$(cat client.pid)" || true
  rm client.pid
}
client_begins
program=$(stvm get --list --dir plc | sed -n 's/^\([A-Za-z]*\)\.fills.*/\1/p')
wait_for '=TRUE' stvm get "$program.connected" --dir plc
wait_for '=TRUE' stvm get "$program.pump" --dir plc
wait_for '=(29[0-9]|30[0-9]|2[0-8][0-9])' stvm get "$program.level" --dir plc
wait_for '=[1-9]' stvm get "$program.fills" --dir plc
client_ends
wait_for '=FALSE' stvm get "$program.connected" --dir plc  # it has ended
wait_for '=0$' stvm get "$program.level" --dir plc
expect 0 stvm status --dir plc
said 'last error of tank, [0-9]+ s ago: shared memory .*nobody writes the inputs'
client_begins
wait_for '=TRUE' stvm get "$program.connected" --dir plc
client_ends

# A process that makes the memory smaller all the time ends nobody but itself: the device is lost, and comes back.
expect 0 stvm stop --dir plc
touch destroying
while [ -e destroying ]; do truncate -s 0 /dev/shm$name; done &
vandal=$!
echo $vandal >vandal.pid
serve plc --device tank.name=$name
for _ in $(seq 4000); do
  stvm get "$program.level" --dir plc >/dev/null || fail 'the controller has ended'
  grep -q " device lost: device tank: shared memory $name: was made smaller" plc.log && break
  sleep 0.05
done
rm destroying
wait $vandal
rm vandal.pid
client_begins
wait_for '=TRUE' stvm get "$program.connected" --dir plc
client_ends
expect 0 stvm stop --dir plc
grep -q " device lost: device tank: shared memory $name: was made smaller" plc.log || fail 'not said as it happened'

# Memory that others could write is not taken.
rm -f /dev/shm$name
(umask 0 && : >/dev/shm$name)
serve open_plc "$source_dir/examples/shared_memory/plc" --device tank.name=$name
wait_for 'device lost: device tank' cat open_plc.log
grep -q " device lost: device tank: shared memory $name: others can write it (mode 0666); remove /dev/shm$name, or permit that by .access.$" \
  open_plc.log || fail 'memory that everybody can write was taken'
expect 0 stvm stop --dir open_plc

expect 7 stvm run "$source_dir/examples/shared_memory/plc" --scans 1 --device tank.name=tank
said 'R0412: device `tank`: `tank` is no name of shared memory'
echo "shared memory: another process is the tank"
