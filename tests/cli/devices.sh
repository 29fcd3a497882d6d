#!/bin/sh
# [devices.NAME] of stc.toml: what is wrong is said with line and column; what is right is in the image.
. "$(dirname "$0")/lib.sh"
mkdir p
cat >p/main.st <<'ST'
PROGRAM P
VAR start AT %IX0.0 : BOOL; speed AT %IW2 : INT; good AT %IX100.0 : BOOL; run AT %QX0.0 : BOOL; set AT %QW4 : INT; END_VAR
run := start AND good; set := speed * 2;
END_PROGRAM
ST

# refused LINE:COLUMN TEXT, of a device with the lines of stdin behind its name.
refused() {
  { echo '[devices.press]'; cat; } >p/stc.toml
  expect 7 stc check p
  said 'R0507'
  said "stc.toml:$1: .*$2"
}
refused 2:10 'unknown driver "modbus"; it must be one of "simulated", "shared-memory", "modbus-tcp"' <<'T'
driver = "modbus"
T
refused 2:1 'device `press` has no `driver`' <<'T'
period_ms = 10
T
refused 3:1 'unknown key `adress`; driver "modbus-tcp" knows map, quality, resource, period_ms' <<'T'
driver = "modbus-tcp"
adress = "plc:502"
map = ["coil 0 <- %QX0.0"]
T
refused 2:10 'device `press`: driver "modbus-tcp" needs `address`' <<'T'
driver = "modbus-tcp"
map = ["coil 0 <- %QX0.0"]
T
refused 2:10 'device `press` has no `map`' <<'T'
driver = "modbus-tcp"
address = "plc:502"
T
refused 3:13 '`period_ms` must be a whole number from 1 to 3600000' <<'T'
driver = "simulated"
period_ms = 0
T
refused 3:11 '`on_loss` must be "hold", "zero", "zero after 500 ms" or "trap TASK"' <<'T'
driver = "simulated"
on_loss = "zero after 5 s"
T
refused 3:11 '`on_loss` must be "hold", "zero", "zero after 500 ms" or "trap TASK"' <<'T'
driver = "simulated"
on_loss = "trap"
T
refused 2:10 'device `press`: `on_loss` names `Fast`, which is no task that runs a program; there is `' <<'T'
driver = "simulated"
on_loss = "trap Fast"
T
refused 3:11 '`on_loss` must be a text or a whole number' <<'T'
driver = "simulated"
on_loss = true
T
refused 3:12 '`writable` must be a text or a whole number' <<'T'
driver = "modbus-tcp-server"
writable = ["yes"]
T
refused 3:12 '`writable` must be true or false' <<'T'
driver = "modbus-tcp-server"
writable = 1
T
refused 4:12 '`writable` is for a device without `map`; in a map, `<->` says it' <<'T'
driver = "modbus-tcp-server"
map = ["coil 0 <- %QX0.0"]
writable = true
T
refused 3:1 'unknown key `writable`; driver "simulated" knows' <<'T'
driver = "simulated"
writable = true
T
refused 3:7 '`map` must be a list of texts' <<'T'
driver = "simulated"
map = "byte 0 -> %IB0"
T
refused 3:9 'map entry "coils 0 -> %IX0.0": expected one of `bit`, `byte`, `coil`' <<'T'
driver = "simulated"
map = ["coils 0 -> %IX0.0"]
T
refused 4:7 'map entry "coil x <- %QX0.0": expected the number of a point' <<'T'
driver = "simulated"
map = ["byte 0 -> %IB0",
"coil x <- %QX0.0"]
T
sed -i 's/coil x/ coil x/' p/stc.toml
expect 7 stc check p
said 'stc.toml:4:8:'
refused 3:16 'the last point comes before the first' <<'T'
driver = "simulated"
map = ["byte 10..9 -> %IB0"]
T
refused 3:16 'expected `->` .into the program. or `<-`' <<'T'
driver = "simulated"
map = ["byte 0 => %IB0"]
T
refused 3:19 'expected an address: %IX0.0' <<'T'
driver = "simulated"
map = ["byte 0 -> IB0"]
T
refused 3:9 '"byte 0 -> %QB0": `->` comes from the device: only %I' <<'T'
driver = "simulated"
map = ["byte 0 -> %QB0"]
T
refused 3:9 '"byte 0 <- %IB0": `<-` sends to the device: only %Q' <<'T'
driver = "simulated"
map = ["byte 0 <- %IB0"]
T
refused 3:9 'devices exchange %I and %Q; %M is a variable' <<'T'
driver = "simulated"
map = ["byte 0 <- %MB0"]
T
refused 3:9 'driver "simulated" has no `coil`' <<'T'
driver = "simulated"
map = ["coil 0 <- %QX0.0"]
T
refused 4:29 '"discrete 0 <- %QX0.1": `discrete` can only be read' <<'T'
driver = "modbus-tcp"
address = "plc:502"
map = ["coil 0 <- %QX0.0", "discrete 0 <- %QX0.1"]
T
refused 3:9 '`byte` has 8 bits: use %IB, %IW, %ID or %IL' <<'T'
driver = "simulated"
map = ["byte 0 -> %IX0.0"]
T
refused 3:9 'a bit needs a bit address: %IX2.0' <<'T'
driver = "simulated"
map = ["bit 0..7 -> %IB2"]
T
refused 3:9 '3 points are no whole number of 16-bit values: each takes 2' <<'T'
driver = "simulated"
map = ["byte 0..2 -> %IW0"]
T
refused 4:9 '`holding` ends at 65535' <<'T'
driver = "modbus-tcp"
address = "plc:502"
map = ["holding 65530..65536 -> %IW0"]
T
refused 3:9 '%IB1048576 ends at byte 1048577; the limit is 1048576' <<'T'
driver = "simulated"
map = ["byte 0 -> %IB1048576"]
T
refused 3:30 '"byte 9 -> %IB1" of `press` provides the same bits of %I as "byte 0..3 -> %IB0" of `press`' <<'T'
driver = "simulated"
map = ["byte 0..3 -> %IB0", "byte 9 -> %IB1"]
T
sed -i 's/^map.*/map = ["byte 0..3 -> %IB0"]/' p/stc.toml
printf '[devices.tool]\ndriver = "simulated"\nmap = ["bit 0 -> %%IX3.7"]\n' >>p/stc.toml
expect 7 stc check p
said 'stc.toml:6:9: .*`tool` provides the same bits of %I as "byte 0..3 -> %IB0" of `press`'
refused 4:33 '"holding 2 <- %QW5" of `press` takes the same points of the device as "holding 0..3 <- %QW0"' <<'T'
driver = "modbus-tcp"
address = "plc:502"
map = ["holding 0..3 <- %QW0", "holding 2 <- %QW5"]
T
refused 4:11 'the quality of `press` provides the same bits of %I as "byte 0..3 -> %IB0"' <<'T'
driver = "simulated"
map = ["byte 0..3 -> %IB0"]
quality = "%IX3.7"
T
refused 3:11 'the quality is a bit of %I' <<'T'
driver = "simulated"
quality = "%QX3.7"
T
refused 3:11 '`quality` must be the address of an input bit' <<'T'
driver = "simulated"
quality = "yes"
T
printf 'devices.press = 1\n' >p/stc.toml
expect 7 stc check p
said 'stc.toml:1:'
printf '[devices]\npress = 1\n' >p/stc.toml
expect 7 stc check p
said 'stc.toml:2:1: error.R0507.: `devices.press`: a device is a table \[devices.NAME\]'
printf '[devices.]\n' >p/stc.toml
expect 7 stc check p
said 'stc.toml:1:10: error.R0506.: expected a key'

# As it should be: in the image, with the process image large enough.
cat >p/stc.toml <<'T'
[devices.press]
driver = "modbus-tcp"
address = "10.0.0.5:502"
period_ms = 10
on_loss = "zero after 500 ms"
quality = "%IX100.0"
map = ["discrete 0..7 -> %IX0.0", "input 0..3 -> %IW2", "coil 0..15 <- %QX0.0",
       "holding 10..11 <- %QW4", "holding 20 -> %IW20"]
T
expect 0 stc build p -o p.img
expect 0 stc dump p.img
said '^press +modbus-tcp$'
said '^ +address = 10.0.0.5:502$'
said '^ +on_loss = zero after 500 ms$'
said 'discrete 0..7 -> %IX0.0$'
said 'holding 10..11 <- %QW4$'
said 'quality -> %IX100.0$'
cp p.img first.img
sed -i 's/10\.\.11/12..13/' p/stc.toml
expect 0 stc build p -o p.img
cmp -s p.img first.img && fail 'the mapping is not part of the version'
expect 0 stc diff first.img p.img
said '^device +press'
echo "devices of stc.toml: refused and carried as said"
