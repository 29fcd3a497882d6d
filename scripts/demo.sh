#!/bin/sh
# make demo: a bottling line runs in real time; its program is changed while bottles move, the change is
# taken back, and the power goes twice. Twenty seconds. usage: demo.sh BIN
set -eu
bin=$(cd "$1" && pwd)
cd "$(dirname "$0")/.."
state=$(mktemp -d)
cleanup() {
  "$bin/stvm" stop --dir "$state/plc" >/dev/null 2>&1 || true
  rm -rf "$state"
}
trap cleanup EXIT
trap 'exit 1' HUP INT PIPE TERM

bold='' plain=''
if [ -t 1 ] && [ -z "${NO_COLOR:-}" ]; then
  bold=$(printf '\033[1m')
  plain=$(printf '\033[0m')
fi
say() { printf '\n%s== %s%s\n' "$bold" "$*" "$plain"; }
step() {
  printf '%s$ %s%s\n' "$bold" "$*" "$plain"
  "$@"
}
stc() { "$bin/stc" "$@"; }
stvm() { "$bin/stvm" "$@" --dir "$state/plc"; }
count() { stvm get "$1" | sed 's/.*=//'; }
# The last lines of what a command says, whose beginning was shown before.
tail_of() {
  printf '%s$ %s | tail -2%s\n' "$bold" "$*" "$plain"
  "$@" | tail -2
}
missed() {
  stvm status --format json | tr ',{' '\n\n' | sed -n 's/.*"missed":\([0-9]*\).*/\1/p' |
    awk '{sum += $1} END {print sum + 0}'
}

counters='BottlesInfed BottlesFilled BottlesCapped Machine.Scans'

say "1. Compile the line ($(cat examples/bottling_line/*.st | wc -l) lines of Structured Text) and start it"
step stc build examples/bottling_line -o "$state/line.img"
"$bin/stvm" serve --dir "$state/plc" "$state/line.img" >"$state/log" 2>&1 &
plc=$!
for _ in $(seq 100); do
  stvm status >/dev/null 2>&1 && break
  sleep 0.05
done
step stvm status

say "2. Bottles come in and are filled (real time, 10 ms scans; 10 s)"
step stvm watch BottlesInfed BottlesFilled BottlesCapped TankLevel Machine.Blink.ET \
  --interval 2000 --count 6

say "3. Version 2: a reject station, soft start in 13 drives, a wider counter, another recipe"
before=$(missed)
filled=$(count BottlesFilled)
scans=$(count Machine.Scans)
step stvm change examples/bottling_line_v2 --yes --allow-loss
echo
echo "before: BottlesFilled $filled, Machine.Scans $scans"
echo "after:  BottlesFilled $(count BottlesFilled), Machine.Scans $(count Machine.Scans): counters and timers went on"

say "4. Version 2 runs, on trial"
# shellcheck disable=SC2086
step stvm watch $counters 'Machine.Conveyor[1].RunHours' --interval 500 --count 4
step stvm status

say "5. Take it back"
step stvm undo --yes
# shellcheck disable=SC2086
step stvm watch $counters --interval 500 --count 3

after=$(missed)
say "Scans missed by the change and its undo: $((after - before)) (and $before before them)"

# kill -9 in the place of a power cut: the process is gone at whatever instruction it is.
power_cut() {
  printf '%s$ kill -9 %s%s\n' "$bold" "$plc" "$plain"
  kill -9 "$plc"
  wait "$plc" 2>/dev/null || true
  echo "(the process is gone)"
}
power_on() {
  printf '%s$ stvm serve --dir plc%s\n' "$bold" "$plain"
  "$bin/stvm" serve --dir "$state/plc" >"$state/log" 2>&1 &
  plc=$!
  for _ in $(seq 100); do
    stvm status >/dev/null 2>&1 && break
    sleep 0.05
  done
}

say "6. Version 2 again, and the power goes while it is on trial: what was accepted boots"
tail_of stvm change examples/bottling_line_v2 --yes --allow-loss
step stvm set RecipeNumber=3
sleep 1
step stvm get TotalBottles RecipeNumber
power_cut
power_on
step stvm status | head -8
step stvm get TotalBottles RecipeNumber

say "7. Version 2, accepted, and the power goes: version 2 boots, with its retained values"
tail_of stvm change examples/bottling_line_v2 --yes --allow-loss
step stvm accept
sleep 1
power_cut
power_on
step stvm status | head -8
step stvm get TotalBottles RecipeNumber

say "8. Who changed what, and when"
step stvm journal
