#!/bin/sh
# An output never takes the place of what the command reads, by whatever name it is given.
. "$(dirname "$0")/lib.sh"
mkdir pr
cat >pr/main.st <<'ST'
PROGRAM Main VAR n : INT; END_VAR n := f(n); END_PROGRAM
TEST 'counts' VAR m : Main; END_VAR m(); ASSERT_EQ(m.n, 1); END_TEST
ST
printf 'FUNCTION f : INT VAR_INPUT x : INT; END_VAR f := x + 1; END_FUNCTION\n' >pr/f.st
printf 'name = "pr"\n' >pr/stc.toml
ln -s pr/main.st link
ln pr/f.st hard.img
expect 0 stc build pr -o pr.img
expect 0 stc build pr -o old.img --define OLD
expect 0 stvm run pr.img --virtual-time --scans 2 --record run.rec
expect 0 stvm run pr.img --virtual-time --scans 2 --record run.rec
cp -a pr was && cp pr.img was.img && cp run.rec was.rec

# kept COMMAND...: refused, and everything is as before.
kept() {
  expect 7 "$@"
  said "R0503: .*: is a source, or read by this command"
  said "or name another file"
  diff -r was pr && cmp was.img pr.img && cmp was.rec run.rec || fail "overwritten by $*"
}
for output in pr/main.st ./pr/../pr/f.st pr/stc.toml link hard.img; do
  kept stc build pr -o $output
  kept stc test pr --format junit -o $output
done
kept stc build pr/main.st -o pr/main.st
kept stc build pr/f.st -o pr/main.st  # a source, though none of this command
kept stc build pr --base pr.img -o pr.img
kept stc test missing.st --format junit -o pr/main.st
kept stc package pr --base old.img -o pr/f.st
kept stc package pr.img --base old.img -o pr.img
kept stc package pr --base pr.img -o ./pr.img
for option in --trace --plot --chart --record; do
  for output in pr/main.st link pr/stc.toml; do
    kept stvm run pr --virtual-time --scans 2 $option $output
  done
  kept stvm run pr.img --virtual-time --scans 2 $option ./pr.img
done
kept stvm serve pr.img --dir plc --record pr.img
kept stvm serve pr --dir plc --record pr/main.st
kept stvm replay run.rec --trace run.rec
kept stvm replay run.rec --plot ./run.rec

# What is there already and was written by such a command is written anew.
expect 0 stc build pr -o pr.img
expect 0 stc test pr --format junit -o pr.xml
expect 0 stc test pr --format junit -o pr.xml
: >empty.st
expect 0 stc build pr -o empty.st
cp pr/main.st values.svg
expect 7 stc draw pr/main.st --values values.svg -o values.svg
cmp pr/main.st values.svg || fail "the values were overwritten"

# A file is signed in place; the key is kept.
if stc key new -o sign.key >out 2>&1; then
  expect 0 stc key sign pr.img --key sign.key -o pr.img
  cp sign.key sign.kept
  expect 7 stc key sign pr.img --key sign.key -o sign.key
  said 'R0503'
  cmp sign.key sign.kept || fail "the key was overwritten"
fi
