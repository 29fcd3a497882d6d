#!/bin/sh
# B11: scans and changes of stated length in virtual time, their charts as pictures, text and JSON.
. "$(dirname "$0")/lib.sh"
examples="$source_dir/examples/timing"

# The examples, each as the command in its head says. STC_UPDATE_PICTURES=1: they become the stored ones.
chart() {  # NAME OPTIONS...
  name=$1
  shift
  expect 0 stvm run "$@" --virtual-time --chart "$name.svg"
  [ "${STC_UPDATE_PICTURES:-}" != 1 ] || cp "$name.svg" "$examples/$name.svg"
  cmp -s "$name.svg" "$examples/$name.svg" || fail "examples/timing/$name.svg is another picture"
  expect 0 stvm run "$@" --virtual-time --chart -
  awk 'length($0) > 80 { exit 1 }' out || fail "a line of $name is longer than 80 columns"
  mv out "$name.txt"
  [ "${STC_UPDATE_PICTURES:-}" != 1 ] || cp "$name.txt" "$examples/$name.txt"
  cmp -s "$name.txt" "$examples/$name.txt" || fail "examples/timing/$name.txt is another chart"
}
chart preemption "$examples/preemption.st" --scans 8 --duration Every=3ms --duration Second=6ms --duration Fourth=12ms
chart synchronous "$examples/synchronous.st" --scans 13 --duration Fast=6ms --duration Newest=3ms --duration Constant=6ms
chart swapped_by_flag "$examples/swapped_by_flag.st" --scans 16 --duration Short=2ms --duration Long=17ms
chart own_exchange "$examples/own_exchange.st" --scans 4 --duration First=2ms --duration Fine=3ms --duration Coarse=2ms
change="--scans 8 --duration Fast=30ms --duration Slow=30ms --change 90ms=$examples/change_after.st --configuration 30ms --strategy standby"
chart change "$examples/change_before.st" $change
for example in preemption synchronous swapped_by_flag own_exchange change_before change_after; do
  expect 0 stc fmt --check "$examples/$example.st"
done

# C5 by its numbers: 10 ms of the configuration before the release at 100 ms, which is on time, the
# rest after its scan; the switch before the release at 200 ms, and nothing is missed.
expect 0 stvm run "$examples/change_before.st" --virtual-time $change --chart - --format json
tr -d ' \n' <out >json
has() { grep -qF -- "$1" json || fail "not in the chart: $1"; }
has '"configuration":[{"from_ns":90000000,"to_ns":100000000},{"from_ns":130000000,"to_ns":150000000}]'
has '{"from_ns":100000000,"to_ns":130000000}'
has '"switches_ns":[180000000]'
if grep -qE '"missed_ns":\[[0-9]' json; then fail "a release is missed"; fi

# B12: received for Fine when its scan starts and sent when it ends, for it alone.
expect 0 stvm run "$examples/own_exchange.st" --virtual-time --scans 2 --duration First=2ms --duration Fine=3ms --chart - --format json
tr -d ' \n' <out >json
has '"received_ns":[0,10000000],"sent_ns":[0,10000000]'
has '"inputs_received_ns":[2000000,12000000],"outputs_sent_ns":[5000000,15000000],"own_received_ns":[2000000,12000000],"own_sent_ns":[5000000,15000000]'
has '"own_received_ns":[],"own_sent_ns":[]'

# Without a stated length nothing takes time; by safe points, as long as its loops.
cat >loops.st <<'ST'
PROGRAM Loops VAR i : DINT; END_VAR FOR i := 1 TO 4000 DO ; END_FOR END_PROGRAM
CONFIGURATION c RESOURCE r ON cpu
  TASK Fast (INTERVAL := T#2ms, PRIORITY := 1); TASK Slow (INTERVAL := T#10ms, PRIORITY := 2);
  PROGRAM l WITH Slow : Loops;
END_RESOURCE END_CONFIGURATION
ST
expect 0 stvm run loops.st --virtual-time --scans 5 --chart - --format json
tr -d ' \n' <out >json
has '"running":[]'
expect 0 stvm run loops.st --virtual-time --scans 5 --safe-point 1us --chart - --format json
tr -d ' \n' <out >json
has '"name":"Slow","released_ns":[0]'
grep -qE '"running":\[\{"from_ns":0,"to_ns":40[0-9]{5}\}\]' json || fail "Slow does not take 4 ms: $(cat json)"

# In real time too; with overruns and a trap.
expect 0 stvm run loops.st --scans 3 --chart real.svg
expect 0 stvm run loops.st --virtual-time --scans 20 --duration Slow=13ms --chart -
said '^Slow +#.*x'

# What does not fit.
expect 2 stvm run loops.st --scans 3 --duration Slow=1ms
said 'virtual-time'
expect 2 stvm run loops.st --virtual-time --scans 3 --duration Slow
expect 2 stvm run loops.st --virtual-time --scans 3 --duration Slow=soon
said 'is no time'
expect 7 stvm run loops.st --virtual-time --scans 3 --duration Slowly=1ms
said 'R0415: there is no task `Slowly`; did you mean `Slow`'
expect 2 stvm run loops.st --virtual-time --scans 3 --duration 5ms
said '`5ms` is not TASK=TIME'
expect 2 stvm run loops.st --virtual-time --scans 3 --duration Slow=1ms --record file
expect 2 stvm run loops.st --virtual-time --scans 3 --strategy standby
expect 2 stvm run loops.st --virtual-time --scans 3 --change 1ms=loops.st --strategy sideways
expect 2 stvm run "$examples/change_before.st" --virtual-time --scans 2 --change "1s=$examples/change_after.st"
said 'more --scans'
expect 2 stvm run "$source_dir/examples/two_resources" --virtual-time --scans 3 --chart x.svg

# A running controller says what its tasks are doing, without a stop.
cat >busy.st <<'ST'
PROGRAM Busy VAR i : DINT; END_VAR FOR i := 1 TO 1000000 DO ; END_FOR END_PROGRAM
PROGRAM Copy VAR a AT %IB0 : BYTE; q AT %QB0 : BYTE; END_VAR q := a; END_PROGRAM
CONFIGURATION c RESOURCE r ON cpu
  {attribute 'input_buffer' := 'three'} {attribute 'output_buffer' := 'swapped'}
  TASK Fast (INTERVAL := T#2ms, PRIORITY := 1);
  {attribute 'freewheeling'} TASK Idle (PRIORITY := 20);
  PROGRAM c WITH Fast : Copy; PROGRAM b WITH Idle : Busy;
END_RESOURCE END_CONFIGURATION
ST
serve busy busy.st
wait_for '^Idle +running' "$bin/stvm" status --dir busy --activity
said '^task +state +of +buffers +writer +waits +reader +new +in scan'
said '^Fast .* inputs +three +[012] +[012] +[012] '
said '^ +outputs +swapped +(0 +- +1|1 +- +0) '
awk 'length($0) > 80 { exit 1 }' out || fail "a line of --activity is longer than 80 columns"
expect 0 stvm status --dir busy --format json
said '"execution": *"'
said '"kind": *"three"'
