#!/bin/sh
# R-10 Events: what happens to a controller is a line on standard error and in `stvm events`, once;
# what comes too often is counted; a standard error that nobody takes holds nothing up.
. "$(dirname "$0")/lib.sh"
name=/stc_events_$$
trap 'rm -f /dev/shm$name; cleanup' EXIT INT TERM

cat >v1.st <<'ST'
PROGRAM Main
VAR n, zero, q, i : DINT; late : INT; r : LREAL; slow : BOOL; level AT %IW0 : WORD; lamp AT %QX0.0 : BOOL; END_VAR
n := n + 1;
IF zero = 1 THEN zero := 0; q := n / zero; END_IF
IF late > 0 THEN late := late - 1; FOR i := 1 TO 30000 DO r := SIN(r) + EXP(COS(r)) + LN(3.0 + r * r); END_FOR END_IF
IF slow THEN slow := FALSE; FOR i := 1 TO 2000000000 DO r := SIN(r) + EXP(COS(r)) + LN(3.0 + r * r); END_FOR END_IF
END_PROGRAM
CONFIGURATION c RESOURCE r ON cpu
  {attribute 'on_trap' := 'go_on'} {attribute 'watchdog' := 'T#2s'} TASK Fast (INTERVAL := T#2ms);
  PROGRAM P WITH Fast : Main;
END_RESOURCE END_CONFIGURATION
ST
mkdir v1 v2
cat >v1/stc.toml <<'TOML'
[devices.tank]
driver = "shared-memory"
name = "/tank"
period_ms = 5
timeout_ms = 300
map = ["byte 0..1 -> %IW0", "bit 0 <- %QX0.0"]
TOML
cp v1/stc.toml v2
sed 's/n := n + 1/n := n + 2/; s/slow : BOOL/slow, more : BOOL/' v1.st >v2/main.st
mv v1.st v1/main.st

# --- one line for each ------------------------------------------------------------------
at() { verb=$1; shift; stvm "$verb" --dir plc "$@"; }
# told REGEX [COUNT]: a line of `stvm events`, and the same one on standard error.
told() {
  for _ in $(seq 4000); do
    expect 0 at events
    [ "$(grep -cE -- "$1" out)" -lt "${2:-1}" ] || break
    sleep 0.05
  done
  [ "$(grep -cE -- "$1" out)" -eq "${2:-1}" ] || fail "not ${2:-1} times: $1"
  grep -E -- "$1" out >shown
  for _ in $(seq 4000); do
    grep -E -- "$1" plc.log >written || true
    cmp -s shown written && return
    sleep 0.05
  done
  fail "on standard error: $(cat written), but shown is: $(cat shown)"
}
serve plc v1 --device tank.name=$name --record /dev/full
"$bin/stvm" events --follow --dir plc >follow.out 2>follow.err &
echo $! >follow.pid
told ' notice new folder by serve: new state folder: .*/plc$'
told ' notice installed [0-9a-f]+ by serve$'
told ' notice started [0-9a-f]+ by serve$'
told ' error recording ended: the disk failed$'
told ' warning device lost: device tank: shared memory '
"$bin/shared_memory_client" $name 100000000 >/dev/null 2>&1 &
echo $! >client.pid
told ' notice device back: device tank: online after [0-9]+ ms$'
user=$(id -un)
expect 0 at set P.q=5 P.n=7
told " info set by $user: P.q=5, P.n=7\$"
expect 0 at force P.q=9
told " warning forced by $user: P.q=9\$"
expect 0 at unforce P.q
told " notice unforced by $user: P.q\$"
expect 0 at unforce --all
told ' unforced ' 1
expect 7 at set P.nothing=5
told ' info set ' 1
expect 0 at change v2 --yes --allow-overrun  # a loaded machine leaves no time
told " info staged [0-9a-f]+ -> [0-9a-f]+ by $user: [0-9]+ kept, "
told " notice switched [0-9a-f]+ -> [0-9a-f]+ by $user: .* kept, .*pause "
expect 0 at undo --yes
told " notice undone .* by $user: "
expect 0 at change v2 --yes --permanent --allow-overrun
told " notice accepted [0-9a-f]+ -> [0-9a-f]+ by $user: edit E2\$"
expect 0 at restart
told " notice restarted .* by $user: "
expect 0 at set P.zero=1
told ' error trap [0-9a-f]+: task Fast: .*main.st:4 \(Main\): division or MOD by zero$'
expect 0 at set P.late=40
told ' warning overrun: task Fast: it was due while its scan before was not done$' 5
expect 0 at set P.slow=TRUE
told ' error watchdog [0-9a-f]+: task Fast: .*the task missed its watchdog time$'
kill -s HUP "$(cat plc.pid)"
told ' info hangup: SIGHUP: there is no log file to open anew; the controller runs on$'
kill "$(cat client.pid)"
told ' warning device lost: device tank: .*; its newest inputs are [0-9]+ ms old$'
expect 0 at status
said '^last error of tank, [0-9]+ s ago: '

# Who wants to see less, or other programs.
expect 0 at events --level error
[ "$(grep -c . out)" -eq "$(grep -c ' error ' out)" ] || fail 'other levels'
said ' error trap '
expect 0 at events --since 1h --format json
json 'all(e["event"] != "" and e["level"] in ("error", "warning", "notice", "info") for e in d)'
json '[e["source"] for e in d if e["event"] == "trap"] == ["task Fast"]'
json '[e["durable"] for e in d if e["event"] in ("forced", "set")][:2] == [False, True]'
expect 0 at events --since 2199-01-01 --format json
json 'd == []'
expect 0 at events --since 2199-01-01
silent_on out
expect 2 at events --since soon
said 'expected a time in UTC'
expect 7 stvm events --dir nowhere

# --- the end, and the next start --------------------------------------------------------
# Overruns were too many: at the end at the latest it is said how many.
expect 0 at stop
wait "$(cat plc.pid)" && fail 'a recording that is not whole is an error'
grep -q 'the recording ended before the run: the disk failed; it can be replayed' plc.log || fail 'why'
grep -qE " notice stopped [0-9a-f]+ by $user\$" plc.log || fail 'its end is not told'
grep -qE ' warning overrun: task Fast: \.\.\. and [0-9]+ more like this in [0-9]+ s$' plc.log ||
  fail 'nothing is said of what was left out'
wait "$(cat follow.pid)" || fail 'who follows did not end in order'
grep -q '^the controller has ended$' follow.err || fail 'it does not say why it ends'
for what in started set forced switched trap device; do
  grep -q " $what " follow.out || fail "who follows has not seen: $what"
done
[ "$(grep -c ' stopped ' follow.out)" -eq 1 ] || fail 'who follows has not seen the end'
rm follow.pid client.pid
expect 0 stvm journal --dir plc
cp out journal
for what in installed started forced unforced switched undone accepted restarted trap watchdog \
  'recording ended' stopped; do
  grep -q "Z  $what" journal || fail "not in the journal: $what"
done
for what in set overrun 'device lost' hangup; do
  grep -q "Z  $what" journal && fail "in the journal: $what"
done
# What is durable is still there.
serve plc --device tank.name=$name
wait_for ' trap ' at events
grep -q ' overrun: ' out && fail 'what is not durable came back'
grep -q ' error trap ' plc.log && fail 'an event of before is told anew'
[ "$(grep -c ' stopped ' out)" -eq 1 ] || fail 'the end of the last run'
expect 0 at stop
wait "$(cat plc.pid)" || fail 'it did not end in order'
rm plc.pid

# --- standard error ---------------------------------------------------------------------
# stderr_is REDIRECTED...: a controller whose standard error is that starts, runs, and ends in order.
runs_and_ends() {
  for _ in $(seq 4000); do
    stvm status --dir plc >/dev/null 2>&1 && break
    sleep 0.05
  done
  expect 0 at set P.n=3
  for _ in 1 2 3; do expect 0 at force P.q=9; done
  before=$(at get P.n)
  for _ in $(seq 4000); do
    [ "$(at get P.n)" != "$before" ] && break
    sleep 0.05
  done
  [ "$(at get P.n)" != "$before" ] || fail "$1: scans stand still"
  expect 0 at events
  said ' set by '
  expect 0 at stop
  wait "$(cat plc.pid)" || fail "$1: it did not end in order"
  rm plc.pid
}
start() { echo $! >plc.pid; }
"$bin/stvm" serve --dir plc --device tank.name=$name >/dev/null 2>&- & start
runs_and_ends closed
"$bin/stvm" serve --dir plc --device tank.name=$name >/dev/null 2>/dev/full & start
runs_and_ends 'a full disk'
# A pipe that is full, and that nobody reads.
mkfifo pipe
exec 9<>pipe
python3 -c 'import fcntl, os
fcntl.fcntl(9, fcntl.F_SETFL, os.O_NONBLOCK)
try:
    while True: os.write(9, b"x" * 4096)
except BlockingIOError: pass
try:
    while True: os.write(9, b"x")
except BlockingIOError: pass
fcntl.fcntl(9, fcntl.F_SETFL, 0)'
"$bin/stvm" serve --dir plc --device tank.name=$name >/dev/null 2>pipe 9<&- & start
runs_and_ends 'a pipe that nobody reads'
exec 9<&-
# The journal of systemd wants levels, and has times of its own. Another stream is not it.
: >journald.log
JOURNAL_STREAM=$(stat -c %d:%i journald.log) \
  "$bin/stvm" serve --dir plc --device tank.name=$name >/dev/null 2>>journald.log & start
runs_and_ends 'the journal'
grep -qE '^<5>started [0-9a-f]+ by serve$' journald.log || fail "$(cat journald.log)"
grep -qvE '^<[3-6]>' journald.log && fail "without a level: $(cat journald.log)"
JOURNAL_STREAM=$(stat -c %d:%i journald.log) \
  "$bin/stvm" serve --dir empty/folder 2>>journald.log && fail 'served without a folder'
tail -n 2 journald.log | grep -qE '^<3>stvm: R05' || fail "$(cat journald.log)"
: >other.log
JOURNAL_STREAM=$(stat -c %d:%i journald.log) \
  "$bin/stvm" serve --dir plc --device tank.name=$name >/dev/null 2>>other.log & start
runs_and_ends 'another stream'
grep -qE '^[0-9]{4}-[^ ]+Z notice started ' other.log || fail "$(cat other.log)"

# --- several resources: each line says which ---------------------------------------------
cat >two.st <<'ST'
PROGRAM Main VAR n : DINT; END_VAR n := n + 1; END_PROGRAM
CONFIGURATION Plant
  RESOURCE Line ON plc TASK t (INTERVAL := T#10ms); PROGRAM p WITH t : Main; END_RESOURCE
  RESOURCE Pack ON plc TASK t (INTERVAL := T#10ms); PROGRAM p WITH t : Main; END_RESOURCE
END_CONFIGURATION
ST
"$bin/stvm" serve --dir two two.st >two.log 2>&1 &
echo $! >two.pid
wait_for running stvm status --dir two/Pack
expect 0 stvm set p.n=5 --dir two/Pack
wait_for ' info Pack: set by ' cat two.log
grep -q ' notice Line: started ' two.log || fail "$(cat two.log)"
expect 0 stvm events --dir two/Line
grep -q ' set by ' out && fail "an event of the other resource"
expect 0 stvm stop --dir two/Pack
wait "$(cat two.pid)" || fail 'they did not end in order'
grep -q ' notice Line: stopped ' two.log || fail "$(cat two.log)"
rm two.pid

# Each kind of event has its line in the docs.
sed -n 's/^EVENT([A-Za-z]*, "\([^"]*\)", k\([A-Za-z]*\),.*/\1 \2/p' "$source_dir/online_change/store/events.def" >kinds
[ "$(grep -c . kinds)" -gt 20 ] || fail 'no table of events'
while read -r line; do
  kind=${line% *}
  grep -q "^| $kind |" "$source_dir/docs/RUNNING.md" || fail "docs/RUNNING.md does not have: $kind"
done <kinds
