#!/bin/sh
# stc build --watch: an image at each save, the same as that of a build from nothing.
. "$(dirname "$0")/lib.sh"

mkdir plant
cat >plant/pump.st <<'ST'
FUNCTION_BLOCK Pump
VAR_INPUT Start : BOOL; END_VAR
VAR_OUTPUT Hours : INT; END_VAR
  IF Start THEN
    Hours := Hours + 1;
  END_IF;
END_FUNCTION_BLOCK
ST
cat >plant/main.st <<'ST'
PROGRAM Main
VAR
  P1 : Pump;
END_VAR
  P1(Start := TRUE);
END_PROGRAM
ST

# said_of_watch COUNT REGEX: as often, however long that takes.
said_of_watch() {
  for _ in $(seq 4000); do
    [ "$(grep -cE -- "$2" watch.log)" -ge "$1" ] && return 0
    sleep 0.05
  done
  sed 's/^/  log: /' watch.log
  fail "not said $1 times: $2"
}
# built COUNT: as many builds have been reported.
built() { said_of_watch "$1" '^built '; }
# same: the image is that of a build from nothing.
same() {
  expect 0 stc build plant -q -o clean.img
  cmp -s clean.img watched.img || fail "another image: $1"
}
# save FILE: as editors do it, in one step.
save() { cat >"$1.new" && mv "$1.new" "$1"; }

# watch: begins to build at each save.
watch() {
  rm -f watched.img
  : >watch.log  # not by the new process, which may come to it late
  "$bin/stc" build plant --watch -o watched.img 2>>watch.log >watch.out </dev/null &
  echo $! >watch.pid
  built 1
}

watch
same 'the first one'
grep -q '^built everything in [0-9]* ms$' watch.log || fail "no line about the build"

sed 's/Hours + 1/Hours + 2/' plant/pump.st | save plant/pump.st
built 2
same 'statements'
tail -1 watch.log | grep -q '^built 1 POU in' || fail "more than one POU for a statement"

# An image that is gone is written at the next save, whatever has changed.
rm watched.img
printf '\n' >>plant/main.st
built 3
same 'written again'

sed 's/^VAR_OUTPUT/VAR_OUTPUT Runs : INT; END_VAR VAR_OUTPUT/' plant/pump.st | save plant/pump.st
built 4
same 'declarations'

# A mistake is reported; the image stays until it is mended.
cp watched.img before.img
sed 's/TRUE/Missing/' plant/main.st | save plant/main.st
said_of_watch 1 'main.st:5:.*error\[E2001\].*Missing'
cmp -s before.img watched.img || fail "an image in spite of errors"
sed 's/Missing/FALSE/' plant/main.st | save plant/main.st
built 5
same 'mended'

# A new file, a file that goes, other settings.
printf 'FUNCTION Twice : INT VAR_INPUT x : INT; END_VAR Twice := 2 * x; END_FUNCTION\n' |
  save plant/twice.st
built 6
same 'a new file'
rm plant/twice.st
built 7
same 'a file less'
echo 'name = "other"' >plant/stc.toml
built 8
same 'settings'
echo 'nam = 1' >plant/stc.toml
said_of_watch 1 R0506
rm plant/stc.toml
built 9
same 'without settings'

# A file that cannot be read at one look, and can at the next.
cp plant/main.st kept.st
printf 'x\0' | save plant/main.st
said_of_watch 1 R0502
save plant/main.st <kept.st
built 10
same 'readable again'

# The system says what is saved, also in folders that are made later.
grep -q inotify /proc/"$(cat watch.pid)"/fdinfo/* || fail "polls where the system says what is saved"
mkdir plant/more
printf 'FUNCTION Thrice : INT VAR_INPUT x : INT; END_VAR Thrice := 3 * x; END_FUNCTION\n' |
  save plant/more/thrice.st
built 11
same 'a new folder'
mv plant/more elsewhere
built 12
same 'a folder less'

# What the system does not say is looked for, however much else it says.
(while [ ! -e quiet ]; do
  echo x >>plant/noise.log
  sleep 0.2
done) &
echo $! >noise.pid
printf 'FUNCTION Half : INT VAR_INPUT x : INT; END_VAR Half := x / 2; END_FUNCTION\n' >elsewhere/half.st
wait_for x cat plant/noise.log
ln elsewhere/half.st plant/half.st
built 13
touch quiet
wait "$(cat noise.pid)"
rm noise.pid
same 'a second name, beside a file that is written all the time'

# A link that leads to itself is no source.
ln -s loop.st plant/loop.st
sed 's/Hours + 2/Hours + 4/' plant/pump.st | save plant/pump.st
built 14
same 'beside a link that leads to itself'
sed 's/Hours + 4/Hours + 2/' plant/pump.st | save plant/pump.st
built 15
rm plant/loop.st

# Neither longer nor, by its time of modification, newer, and in place.
cp -p plant/pump.st aged.st
sed 's/Hours + 2/Hours + 3/' plant/pump.st >aged.st
touch -r plant/pump.st aged.st
cp -p aged.st plant/pump.st
built 16
same 'of the same time'
sed 's/Hours + 3/Hours + 2/' plant/pump.st | save plant/pump.st
built 17

# A writer that never closes is not waited for.
cp plant/main.st kept.st
exec 4>plant/main.st
sed 's/FALSE/(FALSE)/' kept.st >&4
built 18
same 'still open'
exec 4>&-

# More happens than the system can tell.
kill -STOP "$(cat watch.pid)"
for _ in $(seq $(($(cat /proc/sys/fs/inotify/max_queued_events) / 4 + 1))); do
  echo >>plant/noise.log
  echo >>plant/noise2.log
done
save plant/main.st <kept.st
kill -CONT "$(cat watch.pid)"
built 19
same 'more than can be told'

# What a link leads to is polled.
cp plant/pump.st linked.st
ln -s ../linked.st pump.link && mv pump.link plant/pump.st
built 20
sed 's/Hours + 2/Hours + 5/' linked.st | save linked.st
built 21
same 'behind a link'
mv plant/pump.st pump.link && save plant/pump.st <linked.st

# From here on it believes late that a file is gone or complete: however slow this machine is,
# nothing is built in between, whatever else is saved. Who is held back is told by which file, once.
kill "$(cat watch.pid)"
wait "$(cat watch.pid)" || true
export STC_PATIENCE=3000
watch
unset STC_PATIENCE
lines() { grep -vc '^watched.img' watch.log; }
# held WHAT FILE: so it is, and nothing else was said since.
held() {
  before=$(lines)
  said_of_watch $((holds += 1)) '^waiting'
  tail -1 watch.log | grep -q "^waiting with what was saved: plant/$2" ||
    fail "held back, and not by $2: $1: $(tail -3 watch.log)"
  [ "$(lines)" -eq $((2 * holds)) ] || fail "built in between: $1: $(tail -3 watch.log)"
}
# complete WHAT: it is built for that, once.
complete() {
  built $((holds + 1))
  same "$1"
  [ "$(lines)" -eq $((2 * holds + 1)) ] || fail "built more than once: $1: $(tail -3 watch.log)"
}
holds=0
# save_another: what has nothing to do with that.
save_another() { sed 's/FALSE/FALSE OR FALSE/' plant/main.st | save plant/main.st; }
cp plant/pump.st away.st

mv plant/pump.st moved.st
save_another
held 'moved away' 'pump.st appears and disappears'
mv moved.st plant/pump.st
complete 'moved away and back'

rm plant/pump.st
exec 4>plant/pump.st
head -3 away.st >&4
save_another
held 'written piece by piece' 'pump.st is being written; until it is closed'
sed 1,3d away.st >&4
exec 4>&-
complete 'removed and written piece by piece'

: >plant/pump.st
save_another
held 'empty' 'pump.st appears and disappears'
cat away.st >plant/pump.st
complete 'empty for a moment'

exec 4>plant/pump.st
sed 's/Hours + 5/Hours + 6/' away.st | head -3 >&4
save_another
held 'written in place' 'pump.st is being written'
sed 's/Hours + 5/Hours + 6/' away.st | sed 1,3d >&4
exec 4>&-
complete 'written in place, beside another save'

exec 4>plant/four.st
printf 'FUNCTION Four : INT\nVAR_INPUT x : INT; END_VAR\n' >&4
save_another
held 'a new file' 'four.st is being written'
printf 'Four := 4 * x;\nEND_FUNCTION\n' >&4
exec 4>&-
complete 'a new file, beside another save'
