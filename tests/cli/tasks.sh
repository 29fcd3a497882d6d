#!/bin/sh
# What people see of tasks: status, histograms, top; the service manager; the machine's doctor.
. "$(dirname "$0")/lib.sh"

mkdir plant
cat >plant/plant.st <<'ST'
PROGRAM Main VAR n, i : DINT; lamp AT %QX0.0 : BOOL; END_VAR n := n + 1; FOR i := 1 TO 1000 DO ; END_FOR lamp := FALSE; END_PROGRAM
PROGRAM Trapper VAR n, zero : DINT; END_VAR n := 1 / zero; END_PROGRAM
CONFIGURATION c RESOURCE r ON cpu
  TASK Quick (INTERVAL := T#2ms, PRIORITY := 1);
  {attribute 'freewheeling'} TASK Idle (PRIORITY := 20);
  {attribute 'on_trap' := 'stop_task'} TASK Bad (INTERVAL := T#20ms, PRIORITY := 5);
  PROGRAM M WITH Quick : Main; PROGRAM T WITH Bad : Trapper;
END_RESOURCE END_CONFIGURATION
ST
printf 'name = "plant"\n[outputs]\nsafe = ["%%QX0.0 = TRUE"]\n' >plant/stc.toml
serve state plant
wait_for '^Bad .*stopped' stvm status --dir state
wait_for '^Quick +2 ms +1 +[1-9][0-9]' stvm status --dir state
expect 0 stvm status --dir state
said '^task +period +prio +scans +missed +average +p99 +longest +delay +state'
said '^Quick +2 ms +1 '
said '^Idle +free +20 '
said '^Bad .*stopped'
said 'trap: .*plant.st:2 .Trapper.'
expect 0 stvm status --dir state --format json
said '"run_ns": *\{'
said '"start_delay_ns"'
expect 0 stvm status --dir state --task quick
said '^task Quick'
said 'below +[0-9.]+ .s +[0-9]+  #+'
expect 0 stvm status --dir state --task Quick --format json
said '"below_ns"'
expect 0 stvm status --dir state --format json
said '"recent_longest_ns"'
# case68: what a task took once is forgotten when it is asked for; counters go on.
number_of() { tr -d ' \n' <out | sed "s/.*\"Quick\"[^}]*\"$1\":\([0-9]*\).*/\1/"; }
before=$(number_of scans)
expect 0 stvm status --dir state --task Quick --format json
counted() { tr -d ' \n' <out | grep -o '"count":[0-9]*' | awk -F: '{ n += $2 } END { print n + 0 }'; }
all=$(counted)
expect 0 stvm status --dir state --task Quick --format json --reset-times
[ "$(counted)" -lt "$all" ] || fail "nothing is forgotten"
expect 0 stvm status --dir state --format json
[ "$(number_of scans)" -gt "$before" ] || fail "scans do not go on"
expect 7 stvm status --dir state --task nobody
said 'R0415: there is no task `nobody`$'
expect 7 stvm status --dir state --task Qick
said 'R0415: there is no task `Qick`; did you mean `Quick`'

expect 0 stvm top --dir state --interval 100 --count 2
said 'c: running'
said '^TASK +PERIOD +PRIO +SCANS/S'
said '^Quick +2 ms'
said 'Bad .*STOPPED'
said 'trap in cycle'
awk 'length($0) > 80 { exit 1 }' out || fail "a line of top is longer than 80 columns"
expect 0 env COLUMNS=200 LINES=60 "$bin/stvm" top --dir state --interval 50 --count 1
said 'DELAY P99'
awk 'length($0) > 200 { exit 1 }' out || fail "a line of top is longer than 200 columns"
expect 7 stvm top --dir nowhere
said 'R0404'

# What stc.toml says about outputs is checked with its place.
for wrong in '%QX9.0 = TRUE' '%QX0.0 = 2' '%IX0.0 = TRUE' '%QW0 = 70000' '%QX0.0 hold' '%QX0.0 = hold soon' '%QX0.0 = TRUE", "%QB0 = 1'; do
  printf 'name = "plant"\n[outputs]\nsafe = ["%s"]\n' "$wrong" >plant/stc.toml
  expect 7 stc build plant -o x.img
  said 'stc.toml:3:'
done
printf '[outputs]\nsafe = 5\n' >plant/stc.toml
expect 7 stc build plant -o x.img
said 'list of texts'
rm plant/stc.toml

# A service manager hears that it runs, that it lives, and that it ends.
if command -v python3 >/dev/null; then
  python3 - "$work/notify" >heard <<'PY' &
import socket, sys
s = socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM)
s.bind(sys.argv[1])
s.settimeout(600)
while True:
    text = s.recv(4096).decode()
    print(text, flush=True)
    if "STOPPING" in text: break
PY
  listener=$!
  wait_for 'notify' ls
  NOTIFY_SOCKET="$work/notify" WATCHDOG_USEC=200000 "$bin/stvm" serve --dir state2 plant/plant.st >served 2>&1 &
  served=$!
  wait_for 'WATCHDOG=1' cat heard
  kill -TERM $served
  wait $served || fail "serve did not end cleanly"
  wait $listener
  grep -q 'READY=1' heard || fail "no READY=1"
  grep -q 'WATCHDOG=1' heard || fail "no WATCHDOG=1"
fi

expect 2 stvm serve --dir state3 --fifo 100 plant/plant.st
expect 2 stvm serve --dir state3 --cpu 4000 plant/plant.st
code=0
stvm doctor --seconds 1 --period 5000 >out 2>err || code=$?
[ "$code" -le 1 ] || fail "doctor ended with $code"
said 'wakes late by'
said 'SCHED_FIFO'
stvm doctor --seconds 1 --format json >out 2>err || true
said '"findings"'
expect 2 stvm doctor --period 0

# Forces are released all or none.
serve forced plant/plant.st
expect 0 stvm force --dir forced M.n=7 T.n=8
expect 7 stvm unforce --dir forced M.n M.i
said 'R0401.*M.i'
expect 0 stvm status --dir forced
said 'forces +2'
expect 0 stvm unforce --dir forced M.n M.n
expect 0 stvm status --dir forced
said 'forces +1'
