#!/bin/sh
# Overlapping addresses as people meet them: a word, a byte and a bit of it are read, set, watched and forced by name and by
# address, others reach them by Modbus, and a change keeps the bytes by their address (case 75).
. "$(dirname "$0")/lib.sh"
port=$((20000 + $$ % 20000))
mkdir line
cat >line/main.st <<'ST'
VAR_GLOBAL w AT %MW4 : WORD; out AT %QW4 : WORD; END_VAR
PROGRAM P
VAR low AT %MB8 : BYTE; x AT %MX8.3 : BOOL; y AT %MX8.4 : BOOL; lamp AT %QX8.0 : BOOL; seen : WORD; n : INT; END_VAR
n := n + 1; y := NOT y; seen := w; lamp := x;
END_PROGRAM
CONFIGURATION C RESOURCE R ON PLC TASK T(INTERVAL := T#5ms, PRIORITY := 1); PROGRAM Main WITH T : P; END_RESOURCE END_CONFIGURATION
ST
cat >line/stc.toml <<T
[devices.hmi]
driver = "modbus-tcp-server"
address = "127.0.0.1:$port"
period_ms = 5
timeout_ms = 500
map = ["holding 0 <-> %MW4", "coil 0..7 <-> %MX8.0", "coil 100..107 <- %QX8.0"]
T
"$bin/stvm" --version | grep -q '^adapters.*modbus' || sed -i d line/stc.toml
value() { stvm get "$1" --dir plc; }

serve plc line
wait_for '^Main.n=' value Main.n
expect 0 stvm set --dir plc w=16#1200
expect 0 stvm set --dir plc P.x=TRUE
wait_for '^P.low=16#(0|1)8' value P.low
said 'P.low=16#(08|18)'
expect 0 stvm get --dir plc %MX8.3 %MW4 %MB8  # answers name the path
said '^P.x=TRUE'
said '^w=16#12[01]8'
said '^P.low=16#[01]8'
expect 7 stvm get --dir plc %MB9
said 'is a part of w AT %MW4'
expect 0 stvm get --dir plc P.x --format json
said '"type": ?"BOOL"'
said '"value": ?(true|"TRUE")'
wait_for '^out=16#0001' value out
expect 0 stvm get --dir plc %QX8.0
said '^P.lamp=TRUE'
expect 0 stvm watch --dir plc --count 1 w P.x P.low
said 'P.x.*TRUE|TRUE'

# A bit is forced without its neighbours: y goes on, every reader of the word sees it.
expect 0 stvm force --dir plc P.x=FALSE
expect 0 stvm get --dir plc --forces
said '^P.x=FALSE everywhere|P.x.*everywhere'
wait_for '^out=16#0000' value out
wait_for '^Main.seen=16#1210' value Main.seen
wait_for '^Main.seen=16#1200' value Main.seen
expect 0 stvm set --dir plc w=16#00FF
wait_for '^Main.seen=16#00(E|F)7' value Main.seen
expect 0 stvm force --dir plc w=16#0100  # of variables that share bytes the last one is held
expect 0 stvm get --dir plc --forces
said '^w'
! grep -q 'P.x' out || fail 'the force of a bit of a forced word'
wait_for '^Main.seen=16#0100' value Main.seen
expect 0 stvm unforce --dir plc --all
expect 7 stvm force --dir plc P.x=3
expect 0 stvm set --dir plc w=0

# Others by Modbus, if this stvm has it: the word and the coil are one place.
if command -v mbpoll >/dev/null && [ -s line/stc.toml ]; then
  ask() { mbpoll -m tcp -p "$port" -a 1 -0 -1 -q "$@"; }
  wait_for ':[[:space:]]+(0|16)$' ask -t 4 -r 0 127.0.0.1
  ask -t 0 -r 3 127.0.0.1 1 >/dev/null || fail 'mbpoll cannot write a coil'
  wait_for '^P.x=TRUE' value P.x
  wait_for ':[[:space:]]+(8|24)$' ask -t 4 -r 0 127.0.0.1
  ask -t 4 -r 0 127.0.0.1 256 >/dev/null || fail 'mbpoll cannot write a register'
  wait_for '^P.x=FALSE' value P.x
  wait_for '^w=16#01[01]0' value w
  wait_for ':[[:space:]]+0$' ask -t 0 -r 3 127.0.0.1
fi

# Case 75: two bytes in place of the word, and a word that comes over them; undo.
expect 0 stvm set --dir plc w=16#3408
sed -i 's/w AT %MW4 : WORD;/high AT %MB9 : BYTE;/; s/seen := w/seen := BYTE_TO_WORD(high)/' line/main.st
expect 0 stvm change line --dir plc --dry-run --allow-loss
said 'its bytes stay at their address'
expect 0 stvm change line --dir plc --yes --allow-loss
wait_for '^high=16#34' value high
wait_for '^Main.seen=16#0034' value Main.seen
expect 0 stvm set --dir plc high=16#56
expect 0 stvm undo --dir plc
wait_for '^w=16#56[01]8' value w
expect 0 stvm stop --dir plc
echo "overlapping addresses: one place by all its names"
