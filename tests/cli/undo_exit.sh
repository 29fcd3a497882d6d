#!/bin/sh
# X4, case 34: an edit whose FB_Exit always traps cannot be undone by `stvm undo` alone, which says the
# way out: --skip-exit. What then does not run is told before and after, in text, JSON and journal.
. "$(dirname "$0")/lib.sh"

cat >before.st <<'ST'
PROGRAM Main VAR n : DINT; END_VAR n := n + 1; END_PROGRAM
ST
cat >after.st <<'ST'
FUNCTION_BLOCK Bad VAR n, zero : INT; END_VAR
  METHOD FB_Exit : BOOL VAR_INPUT bInCopyCode : BOOL; END_VAR n := 1 / zero; END_METHOD
END_FUNCTION_BLOCK
PROGRAM Main VAR n : DINT; a, b, c, d : Bad; END_VAR n := n + 1; END_PROGRAM
ST
for strategy in in-place standby; do
  serve $strategy before.st
  expect 0 stvm change after.st --dir $strategy --yes --allow-overrun --strategy $strategy
  expect 7 stvm undo --dir $strategy --yes
  said 'R0310'
  expect 0 stc explain R0310
  said 'stvm undo --skip-exit'
  expect 0 stvm undo --skip-exit --dry-run --dir $strategy
  said '^FB_Exit +Main.a, Main.b, Main.c and 1 more +.does not run for what goes.$'
  expect 2 stvm undo E1 --only --skip-exit --dir $strategy
  expect 0 stvm edits --dir $strategy
  said '^E1 '
  expect 0 stvm undo --skip-exit --dir $strategy --yes --format json
  said '"kind": *"FB_Exit"'
  said '"undone": *true'
  expect 0 stvm journal --dir $strategy
  said 'edit E1, without FB_Exit of Main.a, Main.b, Main.c and 1 more'
  # It can be brought again, and the journal is there after the process was killed.
  expect 0 stvm redo --dir $strategy --yes --allow-overrun
  expect 0 stvm undo --skip-exit --dir $strategy --yes
  power_cut $strategy
  serve $strategy
  expect 0 stvm journal --dir $strategy
  said 'without FB_Exit of Main.a'
  expect 7 stvm get Main.a.n --dir $strategy
done
