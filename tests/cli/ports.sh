#!/bin/sh
# R-09, R-10 A port that a controller cannot have is an event at once, with the way out: taken,
# privileged, forbidden, not there. The controller runs on, and has the port when it can.
. "$(dirname "$0")/lib.sh"
port=$((20000 + $$ % 20000))
cat >main.st <<'ST'
PROGRAM P VAR level AT %QW0 : INT := 7; n : DINT; END_VAR level := 7; n := n + 1; END_PROGRAM
CONFIGURATION C RESOURCE R ON PLC
  TASK T (INTERVAL := T#5ms); PROGRAM Main WITH T : P;
END_RESOURCE END_CONFIGURATION
ST
# project NAME DRIVER SETTINGS: with one device.
project() {
  mkdir "$1"
  cp main.st "$1"
  printf '[devices.hmi]\ndriver = "%s"\n%s\nperiod_ms = 5\nmap = ["input 0 <- %%QW0"]\n' "$2" "$3" \
    >"$1/stc.toml"
}
project tcp modbus-tcp-server "address = \"127.0.0.1:$port\""
project rtu modbus-rtu-server "port = \"$work/line\""
expect 0 stc build tcp -o tcp.img
expect 0 stc build rtu -o rtu.img
code=0
stvm run tcp.img --scans 1 >out 2>err || code=$?
if grep -q R0411 err; then
  echo 'built without libmodbus: there are no ports'
  exit 0
fi
[ "$code" -eq 0 ] || fail 'stvm run'

# lost TEXT: is in an event, on standard error and in `stvm events`, and the program runs.
lost() {
  wait_for " warning device lost: device hmi: .*$1" stvm events --dir plc
  wait_for " warning device lost: device hmi: .*$1" cat plc.log
  wait_for '^Main.n=[1-9]' stvm get Main.n --dir plc
}
back() { wait_for ' notice device back: device hmi: ' stvm events --dir plc; }
over() {
  expect 0 stvm stop --dir plc
  wait "$(cat plc.pid)" || fail 'it did not end in order'
  rm -r plc plc.pid
}
# serve_without CAPABILITY IMAGE [OPTIONS]: root has it otherwise; others have none.
serve_without() {
  drop=""
  [ "$(id -u)" -ne 0 ] || drop="setpriv --bounding-set=-$1 --inh-caps=-$1"
  shift
  # shellcheck disable=SC2086
  $drop "$bin/stvm" serve --dir plc "$@" >plc.log 2>&1 &
  echo $! >plc.pid
  wait_for running stvm status --dir plc
}

# Another one has it, until it ends.
serve other tcp.img
serve plc tcp.img
lost "listening on 127.0.0.1:$port: Address already in use; another process listens there"
expect 0 stvm stop --dir other
back
over

# No such address here.
serve plc tcp.img --device hmi.address=192.0.2.1:$port
lost "192.0.2.1:$port: .*; this machine has no such address"
over

# Below 1024, without the capability; with it as the unit says, and as it does not.
if [ "$(cat /proc/sys/net/ipv4/ip_unprivileged_port_start)" -gt 502 ]; then
  serve_without net_bind_service tcp.img --device hmi.address=127.0.0.1:502
  lost '127.0.0.1:502: Permission denied; ports below 1024 need CAP_NET_BIND_SERVICE'
  over
  unit=$source_dir/packaging/systemd/stvm@.service
  grep -q '^# .*AmbientCapabilities=CAP_NET_BIND_SERVICE' "$unit" || fail 'the unit says nothing'
  grep -q '^# .*PrivateUsers=no: ' "$unit" || fail 'the unit says half of it'
  python=/usr/bin/python3  # one that every user can run
  if [ "$(id -u)" -eq 0 ] && [ -x $python ] && unshare -Ur true 2>/dev/null; then
    bind='import socket; socket.socket().bind(("127.0.0.1", 502))'
    only='-all,+net_bind_service'
    expect 0 setpriv --reuid=65534 --regid=65534 --clear-groups --bounding-set=$only \
      --inh-caps=$only --ambient-caps=$only $python -c "$bind"
    expect 1 unshare -Ur $python -c "$bind"
  fi
fi

# A serial line that is not plugged in, and one that belongs to others.
serve plc rtu.img
lost 'No such file or directory; is the adapter plugged in'
over
: >line
chmod 0 line
serve_without dac_override rtu.img
lost 'Permission denied; the user of the controller needs the group of that port'
over
