#!/bin/sh
# Several RESOURCEs: an image for each, run and served in one process with their globals exchanged,
# changed one by one, recorded and replayed, and what is refused.
. "$(dirname "$0")/lib.sh"

mkdir plant
cat >plant/plant.st <<'ST'
TYPE Block : STRUCT n : DINT; a : ARRAY[0..199] OF DINT; END_STRUCT; END_TYPE
PROGRAM PLine VAR i : INT; END_VAR VAR_EXTERNAL block : Block; speed, wanted : INT; END_VAR
  block.n := block.n + 1; FOR i := 0 TO 199 DO block.a[i] := block.n; END_FOR
  speed := wanted * 2;
END_PROGRAM
PROGRAM PPack VAR i : INT; torn, seen, last : DINT; lamp AT %QX0.0 : BOOL; END_VAR VAR_EXTERNAL block : Block; speed, wanted : INT; END_VAR
  FOR i := 0 TO 199 DO IF block.a[i] <> block.n THEN torn := torn + 1; END_IF END_FOR
  IF block.n <> last THEN seen := seen + 1; last := block.n; END_IF
  wanted := 21; lamp := TRUE;
END_PROGRAM
CONFIGURATION Plant
  VAR_GLOBAL block : Block; speed, wanted : INT; END_VAR
  RESOURCE Line ON plc TASK t (INTERVAL := T#2ms); PROGRAM p WITH t : PLine; END_RESOURCE
  RESOURCE Pack ON plc TASK t (INTERVAL := T#3ms); PROGRAM p WITH t : PPack; END_RESOURCE
END_CONFIGURATION
ST

# An image for each: beside the name that was given, in a folder, or one that is named.
expect 0 stc check plant
silent_on err
expect 0 stc build plant -o plant.img
said '^plant.Line.img: .* bytes'
said '^plant.Pack.img: '
[ ! -e plant.img ] || fail "there is no image of all"
expect 0 stc build plant -o images/
said '^images/Line.img: '
expect 0 stc build plant --resource pack -o one.img
cmp -s one.img images/Pack.img || fail "the same image, however it is asked for"
expect 0 stc build plant -o single/ --resource Line
[ -e single/plant.img ] || fail "one image in a folder has the project's name"
expect 0 stc build plant --format json -o json/
said '"diagnostics"'
expect 0 stc build plant --base plant.Pack.img -o next.img
cmp -s next.img plant.Pack.img || fail "a base says which resource is meant"
expect 0 stc dump plant
said 'W0010'

# Both writers are shown, with their places.
mkdir two
sed 's/  wanted := 21;/  wanted := 21; speed := 1;/' plant/plant.st >two/plant.st
for command in check "build -o x.img" "build -o x.img --resource Line"; do
  # shellcheck disable=SC2086
  code=0
  "$bin/stc" $command two >out 2>err || code=$?
  [ "$code" -eq 1 ] || [ "$code" -eq 7 ] || fail "exit code $code: $command"
  said 'plant.st:9:17: error\[E5010\]: `speed` is written by RESOURCE `Line` and by RESOURCE `Pack`'
  said 'plant.st:4:3: .*RESOURCE `Line` writes it here'
done

# In virtual time they take turns, always in the same way.
run_both() { expect 0 stvm run "$@" --virtual-time --scans 3000 --print Line.speed,Pack.speed,Pack.p.seen,Pack.p.torn,line.block.n --hash; }
run_both plant.Line.img plant.Pack.img
said '^Line.speed=42'
said '^Pack.speed=42'
said '^Pack.p.seen=2000'
said '^Pack.p.torn=0'
said '^line.block.n=3000'
grep Line out >first
run_both plant
grep Line out | cmp -s - first || fail "two runs in virtual time differ"
expect 0 stvm run plant --virtual-time --scans 30 --set Pack.p.seen=100 --force Line.speed=7 --print Pack.speed,Pack.p.seen --state --format json
said '"resources": *\[\{"name": *"Line"'
said '"speed": *\{"type":"[A-Z]*","value":7\}'
said '"p.seen": *\{"type":"[A-Z]*","value":1[0-9][0-9]\}'
expect 0 stvm run plant --scans 200 --print Pack.p.torn --state
said '^Pack.p.torn=0'
said '^Line.block.a\[0\]=200'
expect 0 stvm run plant --virtual-time --scans 0 --print Line.block.n,Pack.p.seen
said '^Pack.p.seen=0'
expect 7 stvm run plant --scans 1 --print speed
said 'R0401: `speed`: with several resources, names begin with one: Line, Pack'
expect 7 stvm run plant --scans 1 --set Pack.nothing=1
said 'R0401'
expect 2 stvm run plant --scans 1 --plot x.svg --print Line.speed
said '\-\-plot is for one resource'
expect 2 stvm run plant.Line.img plant.Line.img --scans 1
said 'Plant.Line. is there twice'
echo 'PROGRAM Main END_PROGRAM' >main.st
expect 0 stc build main.st -o main.img
expect 2 stvm run plant.Line.img main.img --scans 1
said 'not the resources of one CONFIGURATION'
# As many as a process runs, and one more.
resources() {
  echo 'PROGRAM P VAR n : INT; END_VAR n := n + g; END_PROGRAM PROGRAM W g := g + 1; END_PROGRAM CONFIGURATION Many VAR_GLOBAL g : INT; END_VAR'
  echo 'RESOURCE w ON c TASK t (INTERVAL := T#10ms); PROGRAM p WITH t : W; END_RESOURCE'
  for i in $(seq "$1"); do echo "RESOURCE r$i ON c TASK t (INTERVAL := T#10ms); PROGRAM p WITH t : P; END_RESOURCE"; done
  echo END_CONFIGURATION
}
resources 63 >many.st
expect 0 stvm run many.st --virtual-time --scans 20 --print w.g,r1.p.n,r63.g
said '^r63.g=19'
resources 64 >many.st
expect 1 stc check many.st
said 'E6003.*more than 64 RESOURCEs'
# Two images that were built at different times can both write it.
sed 's/speed := wanted \* 2;//; s/  wanted := 21;/  wanted := 21; speed := 1;/' plant/plant.st >moved.st
expect 0 stc build moved.st -o moved.img
expect 7 stvm run plant.Line.img moved.Pack.img --scans 1
said 'R0314: `speed` would be written by RESOURCE `Pack`, but RESOURCE `Line` writes it'

# A recording of one has what came from the others in it.
expect 0 stvm run plant --scans 300 --record rec
expect 0 stvm replay rec.Pack --print speed,p.torn
said '^speed=42'
said 'the state is identical after each of them'
expect 0 stvm replay rec.Line
said '^300 cycles'

# A trap in one stops that one.
sed 's/speed := wanted \* 2;/speed := 100 \/ (3000 - block.a[0]);/; s/block.a\[i\] := block.n/block.a[i] := block.n * 30/' plant/plant.st >trap.st
expect 1 stvm run trap.st --virtual-time --print Pack.p.torn --scans 400
said 'trap: Line: '

# Devices: each is of one resource.
mkdir wired && cp plant/plant.st wired/
device() { printf '[devices.d]\ndriver = "simulated"\nmap = ["bit 0 <- %%QX0.0"]\n%s\n' "$1" >wired/stc.toml; }
device ''
expect 7 stc build wired -o wired.img
said 'wired/stc.toml:2:[0-9]+: error.R0507.: device `d`: there are several RESOURCEs; say which one has it: resource = "Line"'
device 'resource = "Pick"'
expect 7 stc build wired -o wired.img
said 'there is no RESOURCE `Pick`'
device 'resource = 5'
expect 7 stc build wired -o wired.img
said 'stc.toml:4:.*must be the name of a RESOURCE'
device 'resource = "pack"
[outputs]
safe = ["%QX0.0 = TRUE"]'
expect 0 stc build wired -o wired.img
expect 0 stvm run wired.Line.img wired.Pack.img --virtual-time --scans 5 --device d.period_ms=20
expect 2 stvm run wired.Line.img wired.Pack.img --virtual-time --scans 5 --device e.period_ms=20
device 'resource = "pack"
on_loss = "trap Slow"'
expect 7 stc check wired
said 'stc.toml:2:10: error.R0507.: device `d`: `on_loss` names `Slow`, which is no task that runs a program; there is `'
device 'resource = "pack"
[outputs]
safe = ["%QX0.0 = TRUE"]'
sed -i 's/%QX0.0 = TRUE/%QX9.0 = TRUE/' wired/stc.toml
expect 7 stc build wired -o wired.img
said 'the outputs of this program end before'

# Served: a state folder each, and commands to each.
serve_both() {
  "$bin/stvm" serve --dir state "$@" >state.log 2>&1 &
  echo $! >"$work/state.pid"
  for _ in $(seq 4000); do
    "$bin/stvm" status --dir state/Pack >/dev/null 2>&1 && "$bin/stvm" status --dir state/Line >/dev/null 2>&1 && return 0
    sleep 0.05
  done
  cat state.log
  fail "the resources do not answer"
}
await() { # await DIR NAME VALUE
  for _ in $(seq 4000); do
    "$bin/stvm" get --dir "$1" "$2" 2>/dev/null | grep -q "=$3\$" && return 0
    sleep 0.05
  done
  fail "$2 in $1 does not become $3"
}
serve_both plant
await state/Pack speed 42
expect 0 stvm status --dir state/Pack
said '^Plant.Pack: running'
said '^Line +resource +online'
expect 7 stvm status --dir state
said 'R0404: state is of several resources; name one: --dir state/Line'
expect 7 stvm serve --dir state plant
said 'R0408'
sed 's/wanted \* 2/wanted * 3/' plant/plant.st >v2.st
expect 0 stvm change --dir state/Line v2.st --yes --allow-overrun
await state/Pack speed 63
expect 0 stvm undo --dir state/Line
await state/Pack speed 42
# What only the other one runs is not in its image: nothing to change there.
cp plant/plant.st original.st
sed -i 's/seen := seen + 1/seen := seen + 2/' plant/plant.st
expect 7 stvm change --dir state/Line plant --yes
said 'R0308'
expect 0 stvm change --dir state/Pack plant --yes --allow-overrun
expect 0 stvm accept --dir state/Pack
mv original.st plant/plant.st
# Another type on one side only: never read, and said.
sed 's/speed, wanted : INT/wanted : INT/; s/VAR_GLOBAL block : Block;/VAR_GLOBAL block : Block; speed : REAL;/; s/speed := wanted \* 2/speed := 2.5/; s/VAR_EXTERNAL block : Block;/VAR_EXTERNAL block : Block; speed : REAL;/' plant/plant.st >v3.st
expect 0 stvm change --dir state/Line v3.st --dry-run --format json --allow-overrun
said '"exchange": *\["`speed` is REAL here and INT in RESOURCE `Pack`'
expect 0 stvm change --dir state/Line v3.st --allow-loss --yes --permanent --allow-overrun
said '^exchange: `speed` is REAL here and INT in RESOURCE `Pack`, which reads it: not exchanged until both are the same'
expect 0 stvm status --dir state/Pack
said '`speed` is INT here and REAL in RESOURCE `Line`: not exchanged until both are the same'
expect 0 stvm get --dir state/Pack speed p.torn
said 'speed=42'
said 'p.torn=0'
expect 0 stvm change --dir state/Pack v3.st --allow-loss --yes --permanent --allow-overrun
await state/Pack speed 2.5
expect 7 stvm change --dir state/Pack moved.st --allow-loss --yes
said 'R0314'
sed 's/CONFIGURATION Plant$/CONFIGURATION Works/' v3.st >v4.st
expect 0 stvm change --dir state/Line v4.st --yes --permanent --allow-overrun
expect 0 stvm stop --dir state/Line
for _ in $(seq 4000); do kill -0 "$(cat state.pid)" 2>/dev/null || break; sleep 0.05; done
kill -0 "$(cat state.pid)" 2>/dev/null && fail "one that is stopped ends all"
serve_both
await state/Pack speed 2.5
kill "$(cat state.pid)"
wait "$(cat state.pid)" || fail "SIGTERM is an orderly end"
expect 0 stvm journal --dir state/Pack
said 'stopped'
expect 2 stvm serve --dir state --virtual-time
serve alone plant.Line.img
expect 0 stvm stop --dir alone
expect 2 stvm serve --dir alone plant
said 'alone holds the program of a single resource'
expect 2 stvm serve --dir state plant.Line.img
said 'state holds RESOURCE Line, which is not among these'
echo "resources: all as expected"
