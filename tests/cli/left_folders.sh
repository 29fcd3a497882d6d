#!/bin/sh
# A tool that is killed leaves its folder of intermediate files: the next one removes it, and neither
# those of tools that live nor what only looks like one.
. "$(dirname "$0")/lib.sh"

TMPDIR=$work/tmp
export TMPDIR
mkdir tmp tmp/stvm-notes
echo mine >tmp/stvm-notes/running.img
cat >main.st <<'ST'
PROGRAM Main VAR n : DINT; END_VAR n := n + 1; END_PROGRAM
ST
sed 's/+ 1/+ 2/' main.st >next.st
stc build main.st -q -o first.img
serve plc first.img
folders() { find tmp -name running.img | grep -vc stvm-notes || true; }

watch() {
  env ${preload:+"LD_PRELOAD=$preload"} "$bin/stvm" change --watch --yes main.st --dir plc >"$1.log" 2>&1 </dev/null &
  echo $! >"$1.pid"
  for _ in $(seq 4000); do
    grep -q 'what was saved is running already' "$1.log" && return 0
    sleep 0.05
  done
  fail "$1 does not follow: $(cat "$1.log")"
}
watch killed
[ "$(folders)" -eq 1 ] || fail "no folder, which this test is about"
power_cut killed
rm killed.pid
[ "$(folders)" -eq 1 ] || fail "the killed one took its folder along"

watch living
expect 0 stvm change --dry-run next.st --dir plc
[ "$(folders)" -eq 1 ] || fail "the folder of a tool that lives: $(find tmp)"
kill -0 "$(cat living.pid)" || fail "the other watch ended"
kill "$(cat living.pid)"
wait "$(cat living.pid)" 2>/dev/null || true
rm living.pid
expect 0 stvm change --dry-run next.st --dir plc
[ "$(folders)" -eq 0 ] || fail "left: $(find tmp)"
[ "$(cat tmp/stvm-notes/running.img)" = mine ] || fail "took what is not its own"

# Where files cannot be locked a folder is made all the same, and none is taken for one that was left.
preload=$2/tests/libno_locks.so
ASAN_OPTIONS=${ASAN_OPTIONS:+$ASAN_OPTIONS:}verify_asan_link_order=0
export ASAN_OPTIONS
[ -e "$preload" ] || fail "no $preload"
watch unlocked
[ "$(folders)" -eq 1 ] || fail "no folder without locks"
expect 0 env LD_PRELOAD="$preload" "$bin/stvm" change --dry-run next.st --dir plc
[ "$(folders)" -eq 1 ] || fail "the folder of a tool that lives, without locks: $(find tmp)"
kill -0 "$(cat unlocked.pid)" || fail "the other watch ended"
