#!/bin/sh
# B10: what a controller does while nothing is due. Counted, so that other load does not matter.
. "$(dirname "$0")/lib.sh"

cat >fast.st <<ST
PROGRAM Main VAR n : INT; END_VAR n := n + 1; END_PROGRAM
CONFIGURATION C
  TASK t (INTERVAL := T#20ms, PRIORITY := 1);
  PROGRAM m WITH t : Main;
END_CONFIGURATION
ST
sed 's/20ms/60s/' fast.st >slow.st

# The control thread sleeps once for a cycle. Commands wake it, too: few are given.
sleeps() { sed -n 's/^voluntary_ctxt_switches:[^0-9]*//p' "/proc/$(cat "$1.pid")/status"; }
cycles() { stvm status --dir "$1" --format json | sed 's/.*"cycles":\([0-9]*\).*/\1/'; }
serve fast fast.st
first=$(cycles fast)
slept=$(sleeps fast)
for _ in $(seq 4000); do
  sleep 1
  [ $(($(cycles fast) - first)) -ge 200 ] && break
done
now=$(cycles fast)
slept=$(($(sleeps fast) - slept))
[ "$slept" -le $(((now - first) * 3 / 2 + 50)) ] ||
  fail "$slept sleeps in $((now - first)) cycles"
stvm stop --dir fast >/dev/null

# A controller that waits for a minute stops at once, and answers at once.
serve slow slow.st
expect 0 stvm get m.n --dir slow
slept=$(sleeps slow)
sleep 2
slept=$(($(sleeps slow) - slept))
[ "$slept" -le 60 ] || fail "$slept sleeps in 2 s without a cycle"
expect 0 stvm stop --dir slow
said '^stopped'
serve slow
kill -s TERM "$(cat slow.pid)"
wait "$(cat slow.pid)" || fail "SIGTERM ended it with $?"
