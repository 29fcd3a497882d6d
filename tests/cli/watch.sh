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

# built COUNT: as many builds have been reported.
built() {
  for _ in $(seq 200); do
    [ "$(grep -c '^built ' watch.log)" -ge "$1" ] && return 0
    sleep 0.05
  done
  sed 's/^/  log: /' watch.log
  fail "not built $1 times"
}
# same: the image is that of a build from nothing.
same() {
  expect 0 stc build plant -q -o clean.img
  cmp -s clean.img watched.img || fail "another image: $1"
}
# save FILE: as editors do it, in one step.
save() { cat >"$1.new" && mv "$1.new" "$1"; }

"$bin/stc" build plant --watch -o watched.img 2>watch.log >watch.out </dev/null &
echo $! >watch.pid
built 1
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
for _ in $(seq 100); do
  grep -q 'main.st:5.*Missing' watch.log && break
  sleep 0.05
done
grep -q 'main.st:5:.*error\[E2001\].*Missing' watch.log || fail "the mistake is not reported"
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
for _ in $(seq 100); do
  grep -q 'R0506' watch.log && break
  sleep 0.05
done
grep -q 'R0506' watch.log || fail "bad settings are not reported"
rm plant/stc.toml
built 9
same 'without settings'

# A file that cannot be read at one look, and can at the next.
cp plant/main.st kept.st
printf 'x\0' | save plant/main.st
for _ in $(seq 100); do
  grep -q 'R0502' watch.log && break
  sleep 0.05
done
grep -q 'R0502' watch.log || fail "a file that is no text is not reported"
save plant/main.st <kept.st
built 10
same 'readable again'

# Editors that take a file away and write it anew: nothing is built in between, whatever else is
# saved. One that stays away is gone (above).
lines=$(wc -l <watch.log)
mv plant/pump.st away.st
sleep 0.3
[ "$(wc -l <watch.log)" -eq "$lines" ] || fail "built without a file that was just away"
sed 's/TRUE/(TRUE)/' plant/main.st | save plant/main.st
sleep 0.2
[ "$(wc -l <watch.log)" -eq "$lines" ] || fail "built without a file that was just away, for another one"
mv away.st plant/pump.st
built 11
same 'away for a moment, beside another save'
cp plant/pump.st away.st
rm plant/pump.st
{ head -3 away.st && sleep 0.3 && sed 1,3d away.st; } >plant/pump.st
built 12
same 'removed and written piece by piece'
: >plant/pump.st
sleep 0.3
cat away.st >plant/pump.st
built 13
same 'empty for a moment'
tail -3 watch.log | grep -qv '^built ' && fail "something was wrong in between"

# The system says what is saved, also in folders that are made later.
grep -q inotify /proc/"$(cat watch.pid)"/fdinfo/* || fail "polls where the system says what is saved"
mkdir plant/more
printf 'FUNCTION Thrice : INT VAR_INPUT x : INT; END_VAR Thrice := 3 * x; END_FUNCTION\n' |
  save plant/more/thrice.st
built 14
same 'a new folder'
mv plant/more elsewhere
built 15
same 'a folder less'

# What the system does not say is looked for, however much else it says.
(for _ in $(seq 75); do
  [ -e quiet ] && break
  echo x >>plant/noise.log
  sleep 0.2
done) &
printf 'FUNCTION Half : INT VAR_INPUT x : INT; END_VAR Half := x / 2; END_FUNCTION\n' >elsewhere/half.st
sleep 0.3
ln elsewhere/half.st plant/half.st
built 16
touch quiet
same 'a second name, beside a file that is written all the time'

# A link that leads to itself is no source.
ln -s loop.st plant/loop.st
sed 's/Hours + 2/Hours + 4/' plant/pump.st | save plant/pump.st
built 17
same 'beside a link that leads to itself'
sed 's/Hours + 4/Hours + 2/' plant/pump.st | save plant/pump.st
built 18
rm plant/loop.st

# Neither longer nor, by its time of modification, newer, and in place.
cp -p plant/pump.st aged.st
sed 's/Hours + 2/Hours + 3/' plant/pump.st >aged.st
touch -r plant/pump.st aged.st
cp -p aged.st plant/pump.st
built 19
same 'of the same time'
sed 's/Hours + 3/Hours + 2/' plant/pump.st | save plant/pump.st
built 20

# Written in place, with a pause: nothing is built of a half, whatever else is saved meanwhile.
# slowly FILE SECONDS
slowly() {
  cat >slow.new
  { head -3 slow.new && sleep "$2" && sed 1,3d slow.new; } >"$1"
}
# one_more COUNT WHAT: it was built for that time, once, and nothing else was said.
events() { grep -vc '^watched.img' watch.log; }
one_more() {
  built "$1"
  same "$2"
  [ "$(events)" -eq $((lines + 1)) ] || fail "built of a half: $2: $(tail -3 watch.log)"
  lines=$((lines + 1))
}
lines=$(events)
cp plant/main.st kept.st
sed 's/FALSE/TRUE/' kept.st | slowly plant/main.st 2.4
one_more 21 'written in place'
slowly plant/main.st 0.8 <kept.st &
sleep 0.2
sed 's/Hours + 2/Hours + 6/' plant/pump.st | save plant/pump.st
wait $!
one_more 22 'written in place, beside another save'
printf 'FUNCTION Four : INT\nVAR_INPUT x : INT; END_VAR\n\nFour := 4 * x;\nEND_FUNCTION\n' |
  slowly plant/four.st 2.4 &
sleep 0.2
sed 's/Hours + 6/Hours + 2/' plant/pump.st | save plant/pump.st
wait $!
one_more 23 'a new file, beside another save'
# A writer that never closes is not waited for.
exec 4>plant/main.st
sed 's/FALSE/TRUE/' kept.st >&4
sleep 1
[ "$(events)" -eq "$lines" ] || fail "built of a file that is still open"
one_more 24 'still open'
exec 4>&-
# One that goes on and on holds everything back, and is named, once.
(while [ ! -e written ]; do
  printf '(* more *)\n' >&4
  sleep 0.3
done) 4>plant/endless.st &
sed 's/Hours + 2/Hours + 7/' plant/pump.st | save plant/pump.st
for _ in $(seq 200); do
  grep -q '^waiting' watch.log && break
  sleep 0.05
done
grep -q '^waiting with what was saved: plant/endless.st is being written' watch.log ||
  fail "held back, and not by whom"
sleep 1
[ "$(events)" -eq $((lines + 1)) ] || fail "named more than once, or built: $(tail -3 watch.log)"
lines=$((lines + 1))
touch written
wait $!
one_more 25 'behind an endless writer'
rm plant/endless.st
sed 's/Hours + 7/Hours + 2/' plant/pump.st | save plant/pump.st
one_more 26 'without it'
# More happens than the system can tell.
kill -STOP "$(cat watch.pid)"
for _ in $(seq $(($(cat /proc/sys/fs/inotify/max_queued_events) / 4 + 1))); do
  echo >>plant/noise.log
  echo >>plant/noise2.log
done
slowly plant/main.st 1 <kept.st &
sleep 0.2
kill -CONT "$(cat watch.pid)"
wait $!
one_more 27 'more than can be told'

# What a link leads to is polled.
cp plant/pump.st linked.st
ln -s ../linked.st pump.link && mv pump.link plant/pump.st
built 28
sed 's/Hours + 2/Hours + 5/' linked.st | save linked.st
built 29
same 'behind a link'
