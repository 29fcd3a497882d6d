#!/bin/sh
# Modbus as people use it: mbpoll reads and writes a running program while it is changed online, and one controller asks
# another one, which goes away and comes back.
. "$(dirname "$0")/lib.sh"
port=$((20000 + $$ % 20000))
mkdir server client
cat >server/main.st <<'ST'
PROGRAM P
VAR wish AT %IW0 : INT; level AT %QW0 : INT; more AT %QW1 : INT := 7; run AT %QX4.0 : BOOL; n : DINT; END_VAR
n := n + 1; level := wish * 2; run := wish > 20; more := 7;
END_PROGRAM
CONFIGURATION C RESOURCE R ON PLC TASK T(INTERVAL := T#5ms, PRIORITY := 1); PROGRAM Main WITH T : P; END_RESOURCE END_CONFIGURATION
ST
cat >server/stc.toml <<T
[devices.hmi]
driver = "modbus-tcp-server"
address = "127.0.0.1:502"
period_ms = 5
timeout_ms = 500
map = ["holding 0 -> %IW0", "input 0 <- %QW0", "coil 0 <- %QX4.0"]
T
cat >client/main.st <<'ST'
PROGRAM P
VAR level AT %IW0 : INT; good AT %IX10.0 : BOOL; wish AT %QW0 : INT := 30; n : DINT; END_VAR
n := n + 1;
END_PROGRAM
CONFIGURATION C RESOURCE R ON PLC TASK T(INTERVAL := T#5ms, PRIORITY := 1); PROGRAM Main WITH T : P; END_RESOURCE END_CONFIGURATION
ST
cat >client/stc.toml <<T
[devices.press]
driver = "modbus-tcp"
address = "127.0.0.1:$port"
period_ms = 5
timeout_ms = 300
on_loss = "zero after 200 ms"
quality = "%IX10.0"
map = ["input 0 -> %IW0", "holding 0 <- %QW0"]
T
stc build server -o server.img 2>/dev/null
stc build client -o client.img 2>/dev/null
expect 0 stvm run client.img --virtual-time --scans 3 --print Main.good  # off: no thread runs in virtual time
said '^Main.good=FALSE$'
code=0
stvm run client.img --scans 1 >out 2>err || code=$?
if grep -q R0411 err; then
  said 'R0411: device `press`: driver "modbus-tcp" is not part of this stvm: .*libmodbus-dev'
  echo "built without libmodbus: refused, as it should be"
  exit 0
fi
[ "$code" -eq 0 ] || fail 'stvm run'
expect 7 stvm run client.img --scans 1 --device press.address=:
said 'R0412: device `press`: `:` is no address'

value() { stvm get "$1" --dir "$2"; }

serve plc --device hmi.address=127.0.0.1:$port server.img
serve panel client.img
wait_for '^Main.level=60' value Main.level panel
wait_for '^Main.good=TRUE' value Main.good panel
expect 0 stvm status --dir panel
said '^press +modbus-tcp +online +[0-9]+ '
expect 0 stvm status --dir panel --format json
said '"driver": ?"modbus-tcp"'
said '"state": ?"online"'
expect 0 stvm status --dir plc
said '^hmi +modbus-tcp-server +online '

# The other controller ends: inputs hold for a while, then become zero; its return is noticed.
expect 0 stvm stop --dir plc
wait_for '^Main.good=FALSE' value Main.good panel
wait_for '^Main.level=0' value Main.level panel
expect 0 stvm status --dir panel
said '^press +modbus-tcp +lost '
said 'last error of press, [0-9]+ s ago: .*(refused|reset|timed out)'
expect 0 stvm set Main.wish=31 --dir panel
serve plc --device hmi.address=127.0.0.1:$port
wait_for '^Main.level=62' value Main.level panel
wait_for '^Main.good=TRUE' value Main.good panel
expect 0 stvm stop --dir panel

command -v mbpoll >/dev/null || {
  echo "all but the part of mbpoll, which is not installed, passed"
  exit 77
}
ask() { mbpoll -m tcp -p "$port" -a 1 -0 -1 -q "$@"; }  # ask OPTIONS... HOST [VALUES]
ask -t 4 -r 0 127.0.0.1 21 >/dev/null || fail 'mbpoll cannot write'
wait_for ':[[:space:]]+42$' ask -t 3 -r 0 127.0.0.1
wait_for ':[[:space:]]+1$' ask -t 0 -r 0 127.0.0.1
wait_for 'Illegal data address' ask -t 3 -r 1 127.0.0.1
wait_for 'Illegal data address' ask -t 0 -r 0 127.0.0.1 1
# Reads and writes go on while code and map are changed: no request fails, no value is between the two programs'.
(
  while [ ! -e enough ]; do
    ask -t 4 -r 0 127.0.0.1 21 >>traffic 2>&1 || echo FAILED >>traffic
    ask -t 3 -r 0 127.0.0.1 >>traffic 2>&1 || echo FAILED >>traffic
  done
) &
traffic=$!
echo "$traffic" >traffic.pid
requests() { grep -cE '^\[0\]: ' traffic || true; }
wait_for '^([5-9]|[1-9][0-9]+)$' requests
sed -i 's/wish \* 2/wish * 3/' server/main.st
sed -i 's/"coil 0/"input 1 <- %QW1", "coil 0/' server/stc.toml
expect 0 stvm change server --dir plc --dry-run
said '^device +hmi +.now input 1 <- %QW1.'
expect 0 stvm change server --dir plc --yes
wait_for ':[[:space:]]+63$' ask -t 3 -r 0 127.0.0.1
wait_for ':[[:space:]]+7$' ask -t 3 -r 1 127.0.0.1
expect 0 stvm undo --dir plc
wait_for ':[[:space:]]+42$' ask -t 3 -r 0 127.0.0.1
wait_for 'Illegal data address' ask -t 3 -r 1 127.0.0.1
expect 0 stvm change server --dir plc --yes
expect 0 stvm accept --dir plc
wait_for ':[[:space:]]+7$' ask -t 3 -r 1 127.0.0.1
wait_for '^(2[1-9]|[3-9][0-9]|[1-9][0-9]{2,})$' requests
touch enough
wait "$traffic"
rm traffic.pid
grep -E 'FAILED|failed' traffic && fail 'a request failed while the program was changed'
grep -E '^\[0\]: ' traffic | grep -vE ':[[:space:]]+(42|63)$' && fail 'a value that no program made'
expect 0 stvm status --dir plc
said '^hmi +modbus-tcp-server +online '
expect 0 stvm stop --dir plc

# Without a map: %Q and %M as people who come from other soft PLCs know them, to read.
mkdir plain
cat >plain/main.st <<'ST'
VAR_GLOBAL speed AT %MW3 : INT := 17; total AT %MD5 : DINT := 70000; END_VAR
PROGRAM P
VAR lamp AT %QX1.2 : BOOL; level AT %QW2 : INT := 33; key AT %IX0.0 : BOOL; n : DINT; END_VAR
n := n + 1;
END_PROGRAM
ST
printf '[devices.hmi]\ndriver = "modbus-tcp-server"\naddress = "127.0.0.1:%s"\n' "$port" >plain/stc.toml
serve plain_plc plain
expect 0 stc dump plain --image
said 'coil 0..47 <- %QX0.0$'
said 'holding 2048..2059 <- %MD0$'
wait_for ':[[:space:]]+33$' ask -t 4 -r 2 127.0.0.1
wait_for 'Illegal data address' ask -t 4 -r 1027 127.0.0.1 55
wait_for 'Illegal data address' ask -t 0 -r 10 127.0.0.1 1
wait_for ' peer refused: device hmi: 127.0.0.1:[0-9]+ was not permitted to write holding 1027$' cat plain_plc.log
expect 2 stvm run plain --scans 1 --device hmi.writable=true
said '--device hmi.writable belongs to the map, which is part of the program'
expect 0 stvm stop --dir plain_plc

# To write, too, where the project says so: each write is counted, with who it was.
echo 'writable = true' >>plain/stc.toml
serve plain_plc plain
expect 0 stc dump plain --image
said 'coil 0..47 <-> %QX0.0$'
said 'discrete 0..7 <- %IX0.0$'
said 'holding 0..2 <-> %QW0$'
said 'holding 1024..1035 <-> %MW0$'
said 'holding 2048..2059 <-> %MD0$'
wait_for ':[[:space:]]+33$' ask -t 4 -r 2 127.0.0.1
wait_for ':[[:space:]]+17$' ask -t 4 -r 1027 127.0.0.1
wait_for ':[[:space:]]+70000$' ask -t 4:int -B -r 2058 127.0.0.1
ask -t 4:int -B -r 2058 127.0.0.1 -- -80000 >/dev/null || fail 'cannot write %MD5'
ask -t 4 -r 1027 127.0.0.1 55 >/dev/null || fail 'cannot write %MW3'
ask -t 0 -r 10 127.0.0.1 1 >/dev/null || fail 'cannot write %QX1.2'
value_is() { wait_for "^$1=$2" stvm get "$1" --dir plain_plc; }
value_is total -80000
value_is speed 55
program=$(stvm get --list --dir plain_plc | sed -n 's/^\([A-Za-z]*\)\.lamp.*/\1/p')
value_is "$program.lamp" TRUE
wait_for ':[[:space:]]+55$' ask -t 4 -r 1027 127.0.0.1
wait_for 'Illegal data address' ask -t 4 -r 1036 127.0.0.1
wait_for 'Illegal data address' ask -t 4 -r 3 127.0.0.1
wait_for ' peer wrote: device hmi: 127.0.0.1:[0-9]+ wrote coil 10$' cat plain_plc.log
expect 0 stvm status --dir plain_plc
said '^others wrote to hmi: 3 times, last 127.0.0.1:[0-9]+$'
expect 0 stvm status --dir plain_plc --format json
said '"writes": ?3'
expect 0 stvm stop --dir plain_plc
echo "Modbus: two controllers, mbpoll, and a change between its requests"
