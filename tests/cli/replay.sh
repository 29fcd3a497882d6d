#!/bin/sh
# A run that was recorded comes out the same again, cycle by cycle, with everything that people did to it.
. "$(dirname "$0")/lib.sh"

cat >v1.st <<'ST'
PROGRAM Main VAR n, i, sum : DINT; k : DINT := 1; gone : INT := 9; END_VAR n := n + k; FOR i := 1 TO 2000 DO sum := sum + i; END_FOR END_PROGRAM
PROGRAM Fast VAR n : DINT; END_VAR n := n + 1; END_PROGRAM
CONFIGURATION c RESOURCE r ON cpu TASK a (INTERVAL := T#1ms, PRIORITY := 1); TASK b (INTERVAL := T#10ms, PRIORITY := 2);
PROGRAM F WITH a : Fast; PROGRAM M WITH b : Main; END_RESOURCE END_CONFIGURATION
ST
sed 's/gone : INT := 9/added : LREAL := 2.5/; s/n + k;/n + 2 * k; added := added * 1.5;/' v1.st >v2.st

# In this process, in real time.
expect 0 stvm run v1.st --scans 300 --set M.k=3 --force M.gone=4 --record run.rec --print M.n,M.sum
cp out was
expect 0 stvm replay run.rec --print M.n,M.sum
said '^300 cycles replayed, the state is identical'
head -2 out >again
cmp -s was again || fail "other values: $(cat was again)"
expect 0 stvm replay run.rec --scans 100 --print F.n --format json
said '"F.n": *\{"type":"DINT","value":100\}'
said '"whole": *false'
expect 0 stvm replay run.rec --trace t.csv --print F.n
[ "$(wc -l <t.csv)" -gt 250 ] || fail "the trace has too few lines"
expect 7 stvm replay run.rec --print F.nope
said 'R0401'

# A controller that is set, forced, changed, undone, changed by the other strategy and restarted.
serve plc v1.st --record plc.rec
expect 0 stvm set --dir plc M.k=5
expect 0 stvm force --dir plc F.n=7
expect 0 stvm change v2.st --dir plc --yes --allow-loss
wait_for 'M.added=([1-9][0-9]|.*(e[+]|inf))' stvm get --dir plc M.added
expect 0 stvm undo --dir plc
expect 0 stvm unforce --dir plc F.n
expect 0 stvm change v2.st --dir plc --yes --allow-loss --strategy standby
expect 0 stvm accept --dir plc
expect 0 stvm restart --dir plc --warm
for try in 1 2 3 4 5 6; do
  expect 0 stvm restart --dir plc --cold
  wait_for 'M.n=[1-9]' stvm get --dir plc M.n
done
expect 0 stvm set --dir plc M.k=5
expect 0 stvm get --dir plc M.k
cp out was
expect 0 stvm stop --dir plc
wait "$(cat plc.pid)" || fail "exit code $? of the controller"
expect 0 stvm replay plc.rec --print M.k,M.added
said 'the state is identical'
said 'M.added=[0-9]'

# Started anew, it keeps the recording before: what led to its end is not lost.
cp plc.rec first.rec
serve plc --record plc.rec
cmp -s plc.rec.before first.rec || fail "the recording before is gone"
expect 0 stvm stop --dir plc
wait "$(cat plc.pid)" || fail "exit code $? of the controller"
expect 0 stvm replay plc.rec
cp first.rec plc.rec

# What is damaged is said, and what is whole before it is replayed.
head -c $(($(wc -c <plc.rec) * 3 / 4)) plc.rec >cut.rec
expect 0 stvm replay cut.rec
said 'the end of the recording is lost'
echo nonsense >bad.rec
expect 7 stvm replay bad.rec
said 'R0416'
expect 7 stvm replay missing.rec
said 'R0501'
expect 2 stvm run v1.st --scans 3 --record x.rec --hard-mode identity
expect 7 stvm run v1.st --scans 3 --record /nowhere/x.rec
said 'R0503'

# A picture of a run.
expect 0 stvm run v1.st --virtual-time --scans 5000 --print M.n,F.n --plot p.svg
grep -q '<svg' p.svg || fail "no picture"
grep -c '<path' p.svg | grep -qx 2 || fail "not one line for each variable"
[ "$(wc -c <p.svg)" -lt 300000 ] || fail "the picture grows with the run"
expect 0 stvm replay run.rec --print M.n --plot q.svg
grep -q 'M.n' q.svg || fail "no name in the picture"
expect 2 stvm run v1.st --virtual-time --scans 5 --plot p.svg

# A recording that says something else than what comes out is found at its cycle.
if command -v python3 >/dev/null; then
  python3 - <<'PY'
import struct
def crc32c(data):
    crc = 0xffffffff
    for byte in data:
        crc ^= byte
        for _ in range(8): crc = crc >> 1 ^ (0x82f63b78 if crc & 1 else 0)
    return crc ^ 0xffffffff
data = bytearray(open("run.rec", "rb").read())
at = 8
cycles = 0
while at < len(data):
    size = struct.unpack_from("<I", data, at + 1)[0]
    if data[at] == 2:
        cycles += 1
        if cycles == 42:
            data[at + 5 + size - 1] ^= 1  # the checksum of the state
            struct.pack_into("<I", data, at + 5 + size, crc32c(data[at:at + 5 + size]))
    at += size + 9
open("other.rec", "wb").write(data)
PY
  expect 1 stvm replay other.rec
  said 'R0417.*after cycle 41'
fi
