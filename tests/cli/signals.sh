#!/bin/sh
# No signal that can be caught ends a controller with a coil that is on: a Modbus peer sees the coil. SIGHUP and SIGPIPE end
# nothing (R-09).
. "$(dirname "$0")/lib.sh"
port=$((20000 + $$ % 20000))
cat >plant.st <<'ST'
PROGRAM P VAR coil AT %IX0.0 : BOOL; END_VAR END_PROGRAM
CONFIGURATION C RESOURCE R ON PLC TASK T(INTERVAL := T#5ms, PRIORITY := 1); PROGRAM Main WITH T : P; END_RESOURCE END_CONFIGURATION
ST
cat >plc.st <<'ST'
PROGRAM P VAR coil AT %QX0.0 : BOOL; n : DINT; END_VAR n := n + 1; coil := TRUE; END_PROGRAM
CONFIGURATION C RESOURCE R ON PLC TASK T(INTERVAL := T#5ms, PRIORITY := 1); PROGRAM Main WITH T : P; END_RESOURCE END_CONFIGURATION
ST
mkdir peer panel
cp plant.st peer/main.st
cp plc.st panel/main.st
cat >peer/stc.toml <<T
[devices.plant]
driver = "modbus-tcp-server"
address = "127.0.0.1:$port"
period_ms = 5
map = ["coil 0 -> %IX0.0"]
T
cat >panel/stc.toml <<T
[devices.plant]
driver = "modbus-tcp"
address = "127.0.0.1:$port"
period_ms = 5
timeout_ms = 500
map = ["coil 0 <- %QX0.0"]
T
stc build peer -o peer.img 2>/dev/null
stc build panel -o plc.img 2>/dev/null
code=0
stvm run plc.img --scans 1 >out 2>err || code=$?
if grep -q R0411 err; then
  echo "built without libmodbus: there is no peer to look from"
  exit 0
fi
serve plant peer.img

# coil VALUE: until the peer sees it.
coil() {
  for _ in $(seq 4000); do
    [ "$(stvm get Main.coil --dir plant)" = "Main.coil=$1" ] && return
    sleep 0.05
  done
  fail "the coil never became $1"
}
# ends_in_order NAME: $signal ends the process of NAME.pid, which leaves the coil at its safe value.
ends_in_order() {
  pid=$(cat "$1.pid")
  coil TRUE
  kill -s "$signal" "$pid"
  code=0
  wait "$pid" || code=$?
  rm "$1.pid"
  [ "$code" -eq 0 ] || fail "exit code $code of $1 by SIG$signal"
  coil FALSE
}
scans() { stvm get Main.n --dir plc; }

serve plc plc.img
coil TRUE
pid=$(cat plc.pid)
for signal in HUP PIPE TSTP TTIN TTOU; do
  kill -s "$signal" "$pid"
done
before=$(scans)
for _ in $(seq 4000); do
  [ "$(scans)" != "$before" ] && grep -q ' hangup: SIGHUP: there is no log file to open anew' plc.log && break
  sleep 0.05
done
[ "$(scans)" != "$before" ] || fail 'the controller does not run on'
grep -q ' hangup: SIGHUP: there is no log file to open anew; the controller runs on' plc.log || fail 'SIGHUP is not said'
coil TRUE

# In order: exit code 0, and the coil is at its safe value.
for signal in TERM INT QUIT USR1 USR2 ALRM XCPU PROF VTALRM IO PWR; do
  [ "$signal" = TERM ] || serve plc
  ends_in_order plc
done

# `stvm run` has outputs too, and is no service: whatever would end it stops it in order.
for signal in HUP PIPE QUIT; do
  "$bin/stvm" run plc.img >run.out 2>&1 &
  echo $! >run.pid
  ends_in_order run
done
# With nohup, which ignores SIGHUP from the start, it lives on.
(
  trap '' HUP
  exec "$bin/stvm" run plc.img >run.out 2>&1
) &
echo $! >run.pid
coil TRUE
kill -s HUP "$(cat run.pid)"
signal=TERM
ends_in_order run
expect 0 stvm stop --dir plant
