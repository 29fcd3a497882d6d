#!/bin/sh
# A simulated device: inputs from a CSV, outputs to one, the same in virtual time every time.
. "$(dirname "$0")/lib.sh"
mkdir p
cat >p/main.st <<'ST'
PROGRAM P
VAR start AT %IX0.0 : BOOL; speed AT %IW2 : INT; good AT %IX100.0 : BOOL; run AT %QX0.0 : BOOL; set AT %QW4 : INT; END_VAR
run := start AND good; set := speed * 2;
END_PROGRAM
CONFIGURATION C RESOURCE R ON PLC TASK T(INTERVAL := T#10ms, PRIORITY := 1); PROGRAM Main WITH T : P; END_RESOURCE END_CONFIGURATION
ST
cat >p/stc.toml <<'T'
[devices.press]
driver = "simulated"
inputs = "in.csv"
outputs = "out.csv"
quality = "%IX100.0"
on_loss = "zero after 20 ms"
map = ["bit 0 -> %IX0.0", "byte 0..3 -> %IW2", "bit 0 <- %QX0.0", "byte 2..3 <- %QW4"]
T
cat >in.csv <<'T'
# what happens
time_ms,%IX0.0,%IW2,lost
0,FALSE,-7,
20,TRUE,,
35,,16#64,
70,,,TRUE
120,,,FALSE
T
stc build p -o p.img 2>/dev/null
expect 0 stvm run p.img --virtual-time --scans 16 --print Main.speed,Main.start,Main.good
cp out.csv first.csv
cat >wanted.csv <<'T'
time_ms,%QX0.0,%QW4
0,FALSE,0
10,FALSE,65522
30,TRUE,65522
50,TRUE,200
120,FALSE,0
130,TRUE,200
150,FALSE,0
T
# The last row: at the end of a run outputs are safe.
cmp -s out.csv wanted.csv || fail "$(cat out.csv)"
said '^Main.good=TRUE$'
said '^Main.speed=100$'
# Lost from 70 ms on: the last good inputs are 20 ms old at 80 ms.
expect 0 stvm run p.img --virtual-time --scans 8 --print Main.speed,Main.good
said '^Main.speed=100$'
said '^Main.good=FALSE$'
expect 0 stvm run p.img --virtual-time --scans 9 --print Main.speed
said '^Main.speed=0$'
expect 0 stvm run p.img --virtual-time --scans 16
cmp -s out.csv first.csv || fail 'another run gave other outputs'
# A loss can be a trap: `io-lost`, at the start of the task's next scan, and again in the replay.
sed 's/zero after 20 ms/trap T/' p/stc.toml >p/new.toml && mv p/new.toml p/stc.toml
expect 1 stvm run p --virtual-time --scans 16 --record lost.rec --print Main.speed,Main.run
said 'trap: cycle 7, task T: .*: a device that the task needs was lost'
said '^Main.run=FALSE$'
expect 0 stvm replay lost.rec --print Main.speed,Main.run
said 'the state is identical'
said '^Main.run=FALSE$'
sed "s/RESOURCE R ON PLC TASK/RESOURCE R ON PLC {attribute 'on_trap' := 'go_on'} TASK/" p/main.st >go_on.st
mv go_on.st p/main.st
expect 1 stvm run p --virtual-time --scans 16 --record lost.rec --print Main.speed,Main.run
said '^Main.speed=100$'
said '^Main.run=TRUE$'
expect 0 stvm replay lost.rec --print Main.run
said 'the state is identical'
said '^Main.run=TRUE$'
expect 1 stvm run p --virtual-time --scans 16 --device press.on_loss='trap t'
expect 2 stvm run p --virtual-time --scans 16 --device press.on_loss='trap U'
said -- '--device press.on_loss: `on_loss` names `U`'
# Tests of the project have a task of their own.
cat >p/t.st <<'ST'
TEST 'adds'
ASSERT_EQ(1 + 1, 2);
END_TEST
ST
expect 0 stc test p
rm p/t.st
# Another setting here; mistakes in it.
cp in.csv other.csv
rm in.csv
expect 7 stvm run p.img --virtual-time --scans 1
said 'R0412: device `press`: in.csv: No such file'
expect 0 stvm run p.img --virtual-time --scans 1 --device press.inputs=other.csv
expect 2 stvm run p.img --virtual-time --scans 1 --device press.input=other.csv
said -- '--device press.input is no setting of "simulated"'
expect 2 stvm run p.img --virtual-time --scans 1 --device press
expect 2 stvm run p.img --virtual-time --scans 1 --device pres.inputs=x
said 'the program has no such device'
expect 2 stvm run p.img --virtual-time --scans 1 --device press.period_ms=0
said 'must be a whole number from 1 to 3600000'

# B12: a task that exchanges by itself has what has come when its scan starts, and its outputs are
# there when it ends; the other one has the inputs of the cycle. A recording has these receptions.
mkdir twice
cat >twice/main.st <<'ST'
PROGRAM Copy VAR a AT %IB0 : BYTE; q AT %QB0 : BYTE; END_VAR q := a; END_PROGRAM
PROGRAM Copy2 VAR a AT %IB0 : BYTE; q AT %QB1 : BYTE; END_VAR q := a; END_PROGRAM
PROGRAM Wait VAR n : DINT; END_VAR n := n + 1; END_PROGRAM
CONFIGURATION C RESOURCE R ON PLC
  TASK First (INTERVAL := T#10ms, PRIORITY := 1);
  {attribute 'exchange' := 'own'} TASK Own (INTERVAL := T#10ms, PRIORITY := 2);
  TASK Last (INTERVAL := T#10ms, PRIORITY := 3);
  PROGRAM w WITH First : Wait; PROGRAM c WITH Own : Copy; PROGRAM d WITH Last : Copy2;
END_RESOURCE END_CONFIGURATION
ST
cat >twice/stc.toml <<'T'
[devices.d]
driver = "simulated"
inputs = "twice.csv"
outputs = "out.csv"
map = ["byte 0 -> %IB0", "byte 0..1 <- %QB0"]
T
printf 'time_ms,%%IB0\n0,1\n2,5\n12,7\n' >twice.csv
expect 0 stvm run twice --virtual-time --scans 3 --duration First=3ms --duration Own=2ms
cat >wanted.csv <<'T'
time_ms,%QB0,%QB1
0,0,0
5,5,0
10,5,1
15,7,1
20,7,5
25,7,7
25,0,0
T
cmp -s out.csv wanted.csv || fail "$(cat out.csv)"
expect 0 stvm run twice --virtual-time --scans 5 --record twice.rec --print c.q,d.q
cp out values
expect 0 stvm replay twice.rec --print c.q,d.q
said 'the state is identical'
grep -qF "$(head -1 values)" out || fail "the replay has other values than $(cat values)"

# A file of inputs that is wrong is refused with line and column.
bad() {
  cat >in.csv
  expect 7 stvm run p.img --virtual-time --scans 1
  said "R0412: device .press.: in.csv:$1: .*$2"
}
bad 1:1 'the first column is `time_ms`' <<'T'
t,%IX0.0
T
bad 1:9 '`%QX0.0` is no input' <<'T'
time_ms,%QX0.0
T
bad 1 'column `%IX9.0` is not mapped by this device' <<'T'
time_ms,%IX9.0
T
bad 2:3 '`2` is no value of 1 bit' <<'T'
time_ms,%IX0.0
0,2
T
bad 2:3 '`65536` is no value of 16 bits' <<'T'
time_ms,%IW2
0,65536
T
bad 3:1 'the time goes back' <<'T'
time_ms,%IW2
10,1
9,2
T
bad 2:2 'fewer cells than the header has' <<'T'
time_ms,%IW2
0
T
bad 2:5 'more cells than the header has' <<'T'
time_ms,%IW2
0,1,2
T
bad 2:1 'expected a time in ms' <<'T'
time_ms,%IW2
-1,1
T
echo "a simulated device: scripted inputs, recorded outputs, loss and quality"
