#!/bin/sh
# C9: while a condition of the user is TRUE nothing is switched; who or what aborted a change is said
# in its answer, in the status and in the journal; the next change works.
. "$(dirname "$0")/lib.sh"
program() {  # program FILE DECLARATIONS
  cat >"$1" <<ST
PROGRAM Main VAR n : DINT; alarm : BOOL; level : INT := 300; $2 END_VAR n := n + 1; END_PROGRAM
ST
}
mkdir next
program v1.st ''
program next/v2.st 'more : INT := 5;'
printf '[change]\nunless = "Main.alarm"\n' >next/stc.toml

serve plc v1.st
expect 0 stvm abort --dir plc
said 'nothing is being prepared'
expect 0 stvm abort --dir plc --format json
said '"aborted": *false'

expect 7 stvm change next --unless Main.level --yes --dir plc
said 'R0402.*Main.level'
expect 7 stvm change next --unless Main.nobody --yes --dir plc
said 'R0401'

expect 0 stvm set Main.alarm=TRUE Main.level=4711 --dir plc
for strategy in in-place standby; do
  expect 7 stvm change next --yes --strategy $strategy --dir plc
  said 'R0306.*by the condition `Main.alarm`, which is TRUE; the old program runs on'
done
expect 7 stvm change next --dry-run --dir plc
said 'R0306'
expect 0 stvm status --dir plc
said '^  aborted +[0-9]{4}-.*by the condition `Main.alarm`'
said 'change +idle'
expect 0 stvm journal --dir plc
said 'cancelled.*'
said 'aborted by the condition `Main.alarm`, which is TRUE'
expect 0 stvm get Main.level --dir plc
said '=4711'

expect 0 stvm set Main.alarm=FALSE --dir plc
expect 0 stvm change next --yes --dir plc
expect 0 stvm get Main.level Main.more --dir plc
said '=4711'
said '=5'
expect 0 stvm status --dir plc --format json
said '"aborted": *""'
expect 0 stvm abort --dir plc
said 'on trial: `stvm undo` takes it back'
expect 0 stvm undo --dir plc
