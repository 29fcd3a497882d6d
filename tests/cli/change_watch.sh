#!/bin/sh
# stvm change --watch: every save reaches the running controller, under the rules of a single change.
. "$(dirname "$0")/lib.sh"

mkdir plant
cat >plant/pump.st <<'ST'
FUNCTION_BLOCK Pump
VAR_INPUT Start : BOOL; END_VAR
VAR_OUTPUT Hours : DINT; END_VAR
VAR Step : INT := 1; END_VAR
  IF Start THEN
    Hours := Hours + Step;
  END_IF;
END_FUNCTION_BLOCK
ST
cat >plant/main.st <<'ST'
PROGRAM Main
VAR
  P1 : Pump;
  Cycles : DINT;
  Last : DINT := 70000;
END_VAR
  P1(Start := TRUE);
  Cycles := Cycles + 1;
END_PROGRAM
ST
# save FILE: as editors do it, in one step.
save() { cat >"$1.new" && mv "$1.new" "$1"; }
# until COUNT REGEX: the watch has said it as often.
until_said() {
  for _ in $(seq 4000); do
    [ "$(times_said "$2")" -ge "$1" ] && return 0
    sleep 0.05
  done
  sed 's/^/  log: /' watch.log watch.out
  fail "not said $1 times: $2"
}
times_said() { cat watch.log watch.out | grep -cE -- "$1" || true; }
running() { stvm image --dir plc -o "$1" 2>/dev/null || fail "no image"; }
follow() {
  : >watch.out  # not by the new process, which may come to it late
  : >watch.log
  "$bin/stvm" change --watch "$@" plant --dir plc >>watch.out 2>>watch.log </dev/null &
  echo $! >watch.pid
}
end_follow() {
  kill "$(cat watch.pid)"
  wait "$(cat watch.pid)" || true
  rm watch.pid
}

stc build plant -q -o first.img
serve plc first.img
# Nobody is there who could be asked.
expect 2 stvm change --watch plant --dir plc
said 'R0504.*--yes'
# What was typed before the question confirms nothing: the terminal has it (and says so, by its
# echo) when the change begins. What comes then is the end of input.
sed 's/+ Step/+ 3 * Step/' plant/pump.st >other.st
cp plant/main.st other_main.st
mkfifo typed
script -qec "sh -c 'until [ -e is_typed ]; do sleep 0.05; done
  exec $bin/stvm change other.st other_main.st --dir plc'" /dev/null <typed >typed.log 2>&1 &
typing=$!
exec 3>typed
printf 'y\n' >&3
wait_for '^y' cat typed.log
touch is_typed
wait_for 'Switch now' cat typed.log
exec 3>&-
wait "$typing" || true
stvm image --dir plc -o typed.img || fail "no image"
cmp first.img typed.img || fail "switched by what was typed before the question"

follow --yes --permanent
until_said 1 'what was saved is running already'

# Statements: one POU is compiled, values stay, and what runs is what a build against it gives.
sed 's/+ Step/+ 2 * Step/' plant/pump.st | save plant/pump.st
until_said 1 'accepted: it boots next'
until_said 1 '^code +Pump'
until_said 1 'running [0-9]+ ms after it was saved: seen .* and answered [0-9.]+ later'
running now.img
expect 0 stc build plant -q --base first.img -o wanted.img
cmp now.img wanted.img || fail "another program than that of a build"
expect 0 stvm get --dir plc Main.Cycles
said 'Main.Cycles *[:=].*[1-9]'

# Mistakes: said, and nothing happens to what runs.
sed 's/Cycles + 1/Missing + 1/' plant/main.st | save plant/main.st
until_said 1 'main.st:8:.*error\[E2001\].*Missing'
running still.img
cmp now.img still.img || fail "changed in spite of errors"
sed 's/Missing + 1/Cycles + 3/' plant/main.st | save plant/main.st
until_said 2 'accepted: it boots next'

# Declarations, and statements behind that: what runs is the base of the next one.
sed 's/^VAR Step/VAR Runs : DINT := 7; END_VAR VAR Step/' plant/pump.st | save plant/pump.st
until_said 3 'accepted: it boots next'
until_said 1 'initialised +Main.P1.Runs'
running before.img
sed 's/Hours := Hours/Runs := Runs + 1; Hours := Hours/' plant/pump.st | save plant/pump.st
until_said 4 'accepted: it boots next'
running now.img
expect 0 stc build plant -q --base before.img -o wanted.img
cmp now.img wanted.img || fail "another program than that of a build against the running one"

# A refusal leaves the program, says why, and the next save is another try.
sed 's/Last : DINT := 70000/Last : INT/' plant/main.st | save plant/main.st
until_said 1 'R0301.*would be lost|would be lost'
running still.img
cmp now.img still.img || fail "changed in spite of the refusal"
sed 's/Last : INT/Last : LINT/' plant/main.st | save plant/main.st
until_said 5 'accepted: it boots next'
expect 0 stvm get --dir plc Main.Last
said '70000'
end_follow

# On trial: the next save waits until it is accepted or undone; what was undone is no base.
follow --yes
until_said 1 'what was saved is running already'
sed 's/Cycles + 3/Cycles + 4/' plant/main.st | save plant/main.st
until_said 1 'on trial'
sed 's/Cycles + 4/Cycles + 5/' plant/main.st | save plant/main.st
until_said 1 'waiting: the last change, by .*, is still on trial'
expect 0 stvm accept --dir plc
until_said 2 'switched between'
expect 0 stvm undo --dir plc
# What was undone does not run: saved again, it is brought again.
{ cat plant/main.st; echo; } | save plant/main.st
until_said 3 'switched between'
running undone.img
# Undone while another save waits, which was made on top of it: that one waits for a next save.
sed 's/Cycles + 5/Cycles + 50/' plant/main.st | save plant/main.st
until_said 2 'waiting: the last change, by .*, is still on trial'
expect 0 stvm undo --dir plc
until_said 1 'undone: what was saved meanwhile is not brought'
running left.img
expect 0 stvm status --dir plc
if grep -q 'on trial' out; then fail "brought what was made on top of what was undone"; fi
sed 's/Cycles + 50/Cycles + 6/' plant/main.st | save plant/main.st
until_said 4 'switched between'
expect 0 stvm status --dir plc
said 'trial'
running now.img
expect 0 stc build plant -q --base left.img -o wanted.img
cmp now.img wanted.img || fail "brought what was made on top of what was undone"
expect 0 stvm accept --dir plc
expect 0 stvm journal --dir plc
said 'undone'

end_follow

# An end of input answers one question, not those behind it.
mkfifo keys
: >watch.out
: >watch.log
script -qec "$bin/stvm change --watch plant --dir plc" /dev/null <keys >>watch.out 2>>watch.log &
echo $! >watch.pid
exec 3>keys
until_said 1 'what was saved is running already'
sed 's/Cycles + 6/Cycles + 8/' plant/main.st | save plant/main.st
until_said 1 'Switch now'
printf '\004' >&3
until_said 1 'not switched'
sed 's/Cycles + 8/Cycles + 6 + 2/' plant/main.st | save plant/main.st
until_said 2 'Switch now'
printf 'y\n' >&3
until_said 1 'switched between'
exec 3>&-
end_follow
expect 0 stvm accept --dir plc
sed 's/Cycles + 6 + 2/Cycles + 6/' plant/main.st | save plant/main.st

follow --yes --permanent
until_said 1 'accepted: it boots next'

# A file that an editor takes away and makes again is never left out of the program.
end_follow
export STC_PATIENCE=3000
follow --yes --permanent --allow-loss
unset STC_PATIENCE
until_said 1 'what was saved is running already'
expect 0 stvm set --dir plc Main.Last=123456
cp plant/main.st away.st
rm plant/main.st
sed 's/Hours := Hours/Hours := 1 * Hours/' plant/pump.st | save plant/pump.st
until_said 1 'waiting with what was saved: plant/main.st appears and disappears'
sed 's/Cycles + 6/Cycles + 9/' away.st | save plant/main.st
until_said 1 'accepted: it boots next'
expect 0 stvm get --dir plc Main.Last
said '123456'
grep -qE 'dropped +[1-9]|error\[' watch.out watch.log && fail "without a file that was just away"

# The controller ends, and with it the watch.
expect 0 stvm stop --dir plc
sed 's/Cycles + 9/Cycles + 7/' plant/main.st | save plant/main.st
code=0
wait "$(cat watch.pid)" || code=$?
rm watch.pid
[ "$code" -eq 7 ] || fail "exit code $code of the watch"
grep -q R0404 watch.log || fail "does not say that the controller is gone"
