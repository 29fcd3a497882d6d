#!/bin/sh
# X1, X4: the report of an undo says what each value will be, and what does not fit its old type is a
# loss as by a change: refused without --allow-loss, before anything is undone.
. "$(dirname "$0")/lib.sh"

cat >v1.st <<'ST'
VAR_GLOBAL CONSTANT LIMIT : INT := 3; END_VAR
PROGRAM Main
VAR n : INT := 5; recipe : STRING[4] := 'abc'; hours : INT := 1234; quiet : INT := 8; seen : DINT; END_VAR
seen := n + LIMIT + quiet;
END_PROGRAM
ST
sed 's/VAR n : INT/VAR n : DINT/; s/STRING\[4\]/STRING[20]/; s/hours : INT := 1234; quiet : INT/quiet : DINT/; s/:= 3/:= 4/' v1.st >v2.st
sed 's/seen := n/seen := 1 + n/' v2.st >v3.st
serve plc v1.st
expect 0 stvm set Main.hours=77 --dir plc
expect 0 stvm change v2.st --dir plc --yes --allow-loss --allow-overrun
expect 0 stvm undo --dir plc --dry-run
said '^ +5 .as it was before the change, unless written since.$'
expect 0 stvm set Main.n=100000 "Main.recipe='strawberry'" --dir plc

loses() {
  said '100000 -> 32767 LOSS: saturates'
  said "'strawberry' -> 'stra' LOSS: truncates"
  [ "$(grep -c 'as it was before the change' out)" -eq 3 ] || fail "not restored: $(cat out)"
  said '^ +8 .as it was before the change, unless written since.$'
  said '^initialised +Main.hours : INT  := 77  .as it was before the change.$'
  said '^initialised +LIMIT : INT  4 -> 3  .as it was before the change.$'
  said '2 live value.s. would be lost:'
  said '^Main.n +100000 +32767 +saturates'
  said 'R0303.*2 live value.s. would be lost'
  said 'allow-loss'
}
expect 7 stvm undo --dir plc --dry-run
loses
# Nobody is asked, and nothing is undone.
expect 7 stvm undo --dir plc
loses
expect 7 stvm undo --dir plc --yes --format json
said '"loss_count": ?2'
said '"after": ?"32767"'
said '"undone": ?false'
said '"refused": ?"R0303"'
expect 0 stvm get Main.n --dir plc
said '^Main.n=100000$'

# Of several edits the report of each is of what it finds behind those above it, and the loss of the
# last one keeps all.
expect 0 stvm change v3.st --dir plc --yes --allow-overrun
expect 7 stvm undo E1 --dir plc --dry-run
said '^undo of E2$'
said '^undo of E1$'
said '100000 -> 32767 LOSS: saturates'
said '^code +Main '
said 'R0303.*undo of E1: 2 live value'
expect 7 stvm undo E1 --dir plc --yes
expect 0 stvm edits --dir plc
said '^E2  20'
expect 0 stvm undo E1 --dir plc --dry-run --allow-loss
expect 0 stvm undo E1 --dir plc --yes --allow-loss
said 'E2 undone between'
said 'E1 undone between'
expect 0 stvm get Main.n Main.recipe Main.hours Main.quiet LIMIT --dir plc
said '^Main.n=32767$'
said "^Main.recipe='stra'$"
said '^Main.hours=77$'
said '^Main.quiet=8$'
said '^LIMIT=3$'

# Two edits that both convert: the report of the lower one has the values that the upper one leaves.
sed 's/seen : DINT/seen : DINT; a : INT/' v1.st >w1.st
sed 's/a : INT/a : DINT/' w1.st >w2.st
sed 's/a : INT/a : LINT/' w1.st >w3.st
serve two w1.st
expect 0 stvm change w2.st --dir two --yes --allow-overrun
expect 0 stvm change w3.st --dir two --yes --allow-overrun
expect 0 stvm set Main.a=5000000000 --dir two
expect 7 stvm undo E1 --dir two --dry-run
said '5000000000 -> 2147483647 LOSS: saturates'
said '2147483647 -> 32767 LOSS: saturates'
expect 0 stvm undo E1 --dir two --yes --allow-loss --format json
said '"after": ?"32767"'
expect 0 stvm get Main.a --dir two
said '^Main.a=32767$'

# What the controller takes back by itself is not held up by a loss.
sed 's/a : INT/a : DINT/; s/^seen := /IF a > 40000 THEN a := a \/ (a - a); END_IF; seen := /' w1.st >w4.st
expect 0 stvm change w4.st --dir two --yes --allow-overrun
expect 0 stvm set Main.a=50000 --dir two
wait_for 'undone by the controller' stvm status --dir two
expect 0 stvm get Main.a --dir two
said '^Main.a=32767$'
