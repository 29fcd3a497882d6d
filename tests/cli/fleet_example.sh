#!/bin/sh
# E-32, X6-05: examples/fleet does what its README says: an edit for five controllers of which one
# has a block of its own, one would lose a value and one cannot be reached; then one by waves, which
# the canary takes back. scripts/demo_fleet.sh shows it, and leaves nothing behind.
. "$(dirname "$0")/lib.sh"

example=$source_dir/examples/fleet
for version in "" mill counter seldom mended; do
  set -- "$example/main.st"
  for part in pump control; do
    own=$example/$version/$part.st
    [ -e "$own" ] || own=$example/$part.st
    set -- "$@" "$own"
  done
  expect 0 stc check "$@"
  if grep -qE '(error|warning)\[' err; then fail "diagnostics for $version"; fi
  expect 0 stc fmt --check "$@"
done

# The wells by themselves: only the wrong edit lets water rise above 900 mm.
# wells SOURCES...: HighWater after ten minutes.
wells() {
  expect 0 stvm run "$example/main.st" "$@" --virtual-time --scans 12000 --print HighWater
  cat out
}
for version in . mill counter; do
  [ "$(wells "$example/$version/pump.st" "$example/control.st")" = HighWater=0 ] ||
    fail "high water with the pump of $version"
  [ "$(wells "$example/$version/pump.st" "$example/mended/control.st")" = HighWater=0 ] ||
    fail "high water with the mended edit and the pump of $version"
done
[ "$(wells "$example/pump.st" "$example/seldom/control.st")" != HighWater=0 ] ||
  fail "the wrong edit does no harm"

mkdir tmp
TMPDIR=$work/tmp "$source_dir/scripts/demo_fleet.sh" "$bin" >demo.out 2>demo.err </dev/null ||
  { cat demo.out demo.err; fail "exit code $? of the demo"; }
[ -z "$(ls tmp)" ] || fail "the demo leaves $(ls tmp)"

# Steps are numbered in the headings: part N is what `said` looks at from then on.
: >err
part() { awk -v number="$1." '/^== [0-9]+[.] / { on = $2 == number } on' demo.out >out; }
# never REGEX: the part does not say that
never() { if grep -qE -- "$1" out; then fail "said: $1"; fi; }

part 1
said '^part +north [+]2 +mill$'
said '^unit Pump +[0-9a-f]{8} +[0-9a-f]{8}[*]$'
said '^north [+]2: north, harbour, hill$'
said '^lake +unreachable +R0404: '

part 2
said '^counter.fleet: 2 part.s., '
said '^unit Pump +ok +different[*]$'
said '^Station.pump.starts +70[0-9]{3} +65535 +saturates$'
for name in north harbour; do said "^$name +District +done +1 of 1 +pause "; done
said '^mill +District +refused +0 of 1 +R0320: Pump is different$'
said '^hill +District +refused +1 of 1 +R0303: 1 live value'
said '^lake +unreachable +- +R0404: '
said '^3 left: '
said '^Station.pump.starts=70[0-9]{3}$'  # nothing was lost
said '^part +north [+]1 +mill +hill$'
said '^unit Pump +has it +different[*] +ok$'
said '^north +District +accepted +E1 *$'
said '^mill +District +had it not +- *$'

part 3
said '^1 +15s .* north$'
said '^2 +2s .* harbour, mill, hill, lake$'
said '^north: on trial$'
said '^north: failed: edit E2: plan [0-9a-f]{8} wave 1 by .*HighWater <= baseline.HighWater.. is FALSE in cycle'
said '^wave 1 has more failures than max_failed$'
said '^1 +north +failed '
for name in harbour mill hill lake; do said "^2 +$name +skipped "; done
said '^[(]exit code 7[)]$'
# The controller took it back: what ran before runs, and nobody else was switched.
was=$(sed -n 's/.* switched \([0-9a-f]*\) -> [0-9a-f]*  by .*/\1/p' out | tail -1)
said " undone [0-9a-f]{12} -> $was  by controller\$"
said 'HighWater = 1, baseline.HighWater. = 0'
said '^part +north [+]3$'
said '^unit Control +ok$'

part 4
said '^north: accepted$'
never 'is FALSE in cycle'
said '^1 +north +accepted '
for name in harbour mill hill; do said "^2 +$name +accepted "; done
said '^lake: lost: it does not answer; if the edit came there, it decides alone$'
said '^2 +lake +lost '
said '^plan [0-9a-f]{8} by .*: done$'

part 5
for name in north harbour mill hill; do said "^$name +District +had it +1 of 1"; done
said '^lake +District +done +1 of 1 +pause '
said '^lake +District +accepted +E1 *$'
said '^part +north [+]4$'
said '^unit Control +has it$'
said '^Pump.starts +UINT +DINT$'  # the mill has its own pump, as before
never 'unreachable'

# Told to end in the middle, it leaves no controller and no folder.
TMPDIR=$work/tmp setsid sh "$source_dir/scripts/demo_fleet.sh" "$bin" >demo.out 2>&1 </dev/null &
echo $! >demo.pid
wait_for '^north: on trial$' cat demo.out
ls -d tmp/*/state/*/ >controllers
kill -s TERM "$(cat demo.pid)"
wait "$(cat demo.pid)" && fail 'exit code 0 of a demo that was ended' || true
rm demo.pid
[ -z "$(ls tmp)" ] || fail "a demo that is ended leaves $(ls tmp)"
[ "$(wc -l <controllers)" -eq 4 ] || fail "other controllers than four: $(cat controllers)"
# Where nobody runs any more, nobody's working folder is there.
if ls -l /proc/[0-9]*/cwd 2>/dev/null | grep -F "$work/tmp/"; then fail "a controller still runs"; fi
