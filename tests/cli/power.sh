#!/bin/sh
# The process is killed around changes: what boots, with which retained values, and what status and
# journal say of it.
. "$(dirname "$0")/lib.sh"

version() {  # version NUMBER: total is retained in all, in another type and place
  case $1 in
    1) variables='total : DINT; old_only : INT := 7;' ;;
    2) variables='more : ARRAY[0..20] OF INT; total : LINT;' ;;
    3) variables='total : DINT; again : INT;' ;;
  esac
  cat >"v$1.st" <<ST
VAR_GLOBAL RETAIN $variables END_VAR
PROGRAM Main VAR scans : DINT; END_VAR total := total + 1; scans := scans + 1; END_PROGRAM
ST
}
for n in 1 2 3; do version $n; done

number() { stvm get "$1" --dir plc --format json | sed 's/.*"value" *: *"\{0,1\}\(-\{0,1\}[0-9]*\).*/\1/' | tr -dc '0-9-'; }
above() { [ "$(number total)" -ge "$1" ] || fail "total is $(number total), not $1 or more"; }

serve plc v1.st
expect 0 stvm set total=100000 Main.scans=1000000 --dir plc
wait_saved plc
power_cut plc
serve plc
above 100000
[ "$(number Main.scans)" -lt 1000000 ] || fail "scans is not retained"
expect 0 stvm journal --dir plc
said 'started'

# During a trial: the accepted program boots, and its values are the trial's.
expect 0 stvm change v2.st --dir plc --yes --allow-loss
expect 0 stvm set total=200000 --dir plc
wait_saved plc
power_cut plc
expect 0 stvm journal --dir plc
said 'switched'
serve plc
above 200000
expect 0 stvm get old_only --dir plc
said '=7'
expect 0 stvm status --dir plc
said 'trial lost'
expect 0 stvm status --dir plc --format json
said '"trial_lost"'
expect 0 stvm journal --dir plc
said 'trial lost'

# After accept at once: the new one boots.
expect 0 stvm change v2.st --dir plc --yes --allow-loss
expect 0 stvm set total=300000 --dir plc
expect 0 stvm accept --dir plc
power_cut plc
serve plc
above 300000
expect 0 stvm get 'more[3]' --dir plc
expect 0 stvm status --dir plc --format json
grep -q trial_lost out && fail "no trial was lost"

# After undo at once: the old one boots.
expect 0 stvm change v3.st --dir plc --yes --allow-loss
expect 0 stvm set total=400000 --dir plc
expect 0 stvm undo --dir plc
power_cut plc
serve plc
above 400000
expect 0 stvm get 'more[3]' --dir plc

# A clean stop loses nothing at all.
expect 0 stvm set total=500000 --dir plc
expect 0 stvm stop --dir plc
expect 0 stvm journal --dir plc --format json
said '"event": *"stopped"'
said '"who"'
serve plc
above 500000
expect 0 stvm stop --dir plc

# Another program on the command line takes the values over.
serve plc v3.st
above 500000
power_cut plc

# case56: no program is intact. The controller answers, and takes one with its retained values.
stc build v3.st -o v3.img 2>/dev/null
damage_slots() {
  for file in slot_a slot_b slot_c; do
    dd if=/dev/urandom of=plc/$file bs=512 count=40 seek=1 conv=notrunc 2>/dev/null
  done
}
serve plc v3.img
expect 0 stvm set total=600000 --dir plc
expect 0 stvm stop --dir plc
damage_slots
serve plc --record none.rec
grep -q 'nothing is recorded' plc.log || fail "$(cat plc.log)"
expect 0 stvm status --dir plc
said 'no program: FAULT'
said '`stvm change SOURCES.IMAGE` brings a program'
said 'alarm: .* and no other program is intact'
expect 0 stvm status --dir plc --format json
json 'd["faulted"] and d["tasks"] == [] and d["name"] == "no program"'
expect 7 stvm get total --dir plc
expect 7 stvm restart --dir plc
said 'R0410'
expect 0 stvm journal --dir plc
said 'no other program is intact'
expect 0 stvm change v3.img --dir plc --dry-run
expect 0 stvm change v3.img --dir plc --yes
said 'accepted: it boots next'
expect 0 stvm status --dir plc
said 'v3: running'
above 600000
expect 0 stvm journal --dir plc
said 'installed .* by '
power_cut plc
serve plc
above 600000
power_cut plc
damage_slots
serve plc v1.st
expect 0 stvm status --dir plc
said 'alarm: cold start'
expect 0 stvm get old_only --dir plc
said '=7'
power_cut plc
for file in control_0 control_1 retain_0 retain_1 retain_2 journal traps; do
  head -c 3000 /dev/urandom >plc/$file
done
serve plc
expect 0 stvm status --dir plc
said 'FAULT'
said 'both control records are damaged'
expect 0 stvm restart --dir plc
expect 0 stvm status --dir plc
said ': running'
expect 0 stvm stop --dir plc

# Any bytes in any one file: it runs, or it is held with the reason, and answers.
for file in control_0 control_1 slot_a slot_b slot_c retain_0 retain_1 retain_2 journal traps lock; do
  for damage in random zeros empty; do
    case $damage in
      random) head -c 3000 /dev/urandom >plc/$file ;;
      zeros) head -c 3000 /dev/zero >plc/$file ;;
      empty) : >plc/$file ;;
    esac
    serve plc
    expect 0 stvm status --dir plc
    grep -q ': running\|: FAULT' out || fail "$file, $damage: $(cat out)"
    expect 0 stvm stop --dir plc
  done
done
serve plc v1.st
expect 0 stvm stop --dir plc
expect 7 stvm journal --dir nowhere
said 'R0501'

# R-09: a folder that was never used is a mistake, unless it is said that a program comes later.
expect 7 stvm serve --dir nowhere
said 'R0501.*nowhere does not exist; name an image or sources for it, or --create'
[ ! -e nowhere ] || fail "it was made all the same"
mkdir -m 700 empty
expect 7 stvm serve --dir empty
said 'empty holds no program yet'
[ -z "$(ls empty)" ] || fail "files were made: $(ls empty)"
serve waiting --create
grep -q 'new state folder: .*/waiting' waiting.log || fail "$(cat waiting.log)"
expect 0 stvm change v1.st --dir waiting --yes
expect 0 stvm status --dir waiting
said 'v1: running'
expect 0 stvm stop --dir waiting

# A disk without room: refused, and what ran runs on.
stc build v1.st -o v1.img 2>/dev/null
serve plc
text=$( (ulimit -f 1; exec "$bin/stvm" serve --dir full v1.img) 2>&1) && fail "no room, and it runs"
printf '%s\n' "$text" | grep -q 'R0409' || fail "$text"
expect 0 stvm stop --dir plc
