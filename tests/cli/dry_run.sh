#!/bin/sh
# case78: --dry-run says what the change would do, and ends as it would; nothing is journalled or
# stored, and it works while another change is on trial.
. "$(dirname "$0")/lib.sh"
cat >v1.st <<'ST'
PROGRAM Main VAR n : INT; gone : INT := 5; level : INT := 300; END_VAR
  n := n + 1; IF n > 1000 THEN n := 0; END_IF
END_PROGRAM
ST
sed 's/ gone : INT := 5;//; s/level : INT := 300/level : DINT := 300/' v1.st >v2.st
sed 's/level : DINT := 300/level : SINT := 3/' v2.st >v3.st
serve plc v1.st
stvm journal --dir plc >journal_before
cksum plc/slot_? plc/control_? >files_before

# Refused as the change is, with the same report.
expect 7 stvm change v2.st --dir plc --dry-run --format json
said '"refused": *"R0303"'
without_values() { sed 's/"live": *"[^"]*"//g; s/"after": *"[^"]*"//g' out; }
without_values >dry
stvm journal --dir plc >journal_after
cmp -s journal_before journal_after || fail "a dry run is in the journal"
[ "$(cksum plc/slot_? plc/control_?)" = "$(cat files_before)" ] || fail "a dry run was stored"
expect 7 stvm change v2.st --dir plc --dry-run --allow-loss --health Main.unknown
said 'R0401'
expect 7 stvm change v2.st --dir plc --yes --format json
without_values >real
cmp -s dry real || fail "a dry run says something else: $(diff dry real)"

# What only the switch looks at: the time that a task leaves.
mkdir busy1 busy2
printf 'name = "busy"\n[slack]\nfree_bytes = 9000000\n' | tee busy1/stc.toml >busy2/stc.toml
cat >busy1/a.st <<'ST'
TYPE Cell : STRUCT a : INT; b : INT; END_STRUCT END_TYPE
PROGRAM Main VAR c : ARRAY[1..400000] OF Cell; n : INT; END_VAR n := n + 1; c[1].a := n; END_PROGRAM
CONFIGURATION cfg RESOURCE r ON cpu
  TASK t (INTERVAL := T#1ms, PRIORITY := 1); PROGRAM Main WITH t : Main;
END_RESOURCE END_CONFIGURATION
ST
sed 's/a : INT; b : INT/a : DINT; b : DINT/' busy1/a.st >busy2/a.st
serve busy busy1
expect 7 stvm change busy2 --dir busy --dry-run
said 'R0304'
expect 7 stvm change busy2 --dir busy --yes
said 'R0304'
expect 0 stvm change busy2 --dir busy --dry-run --allow-overrun

# On trial: the next change is looked at, the trial goes on and can be undone.
expect 0 stvm change v2.st --dir plc --yes --allow-loss
stvm journal --dir plc >journal_before
expect 7 stvm change v3.st --dir plc --dry-run
said 'converted +Main.level : DINT -> SINT'
said '300 -> 127 LOSS: saturates'
said 'R0303: 1 live value'
expect 0 stvm change v3.st --dir plc --dry-run --allow-loss
stvm journal --dir plc >journal_after
cmp -s journal_before journal_after || fail "a dry run on trial is in the journal"
expect 0 stvm status --dir plc
said 'trial'
expect 0 stvm undo --dir plc --dry-run
said 'gone'
expect 0 stvm undo --dir plc
expect 0 stvm get Main.gone Main.level --dir plc
said 'Main.gone=5'
said 'Main.level=300'

# --all: one line for each variable, with its places and values (X1).
expect 7 stvm change v3.st --dir plc --dry-run --all --format json
said '"variable": *"Main.gone"'
said '"variable": *"Main.n"'
tr -d ' \n' <out | grep -q '"variable":"Main.gone","fate":"dropped","old_address":[0-9]*,"old_type":"INT","new_type":"","live":"5","after":"","loss":"isdropped"' ||
  fail "the fate of Main.gone is another"
tr -d ' \n' <out | grep -q '"variable":"Main.level","fate":"converted","old_address":\([0-9]*\),"new_address":[0-9]*,"old_type":"INT","new_type":"SINT","live":"300","after":"127","loss":"saturates"' ||
  fail "the fate of Main.level is another"
tr -d ' \n' <out | grep -q '"variable":"Main.n","fate":"kept","old_address":\([0-9]*\),"new_address":\1,' ||
  fail "the fate of Main.n is another"
expect 7 stvm change v3.st --dir plc --dry-run --all
said '^kept +Main.n : INT +[0-9]+  \(at [0-9]+\)$'
expect 0 stc diff v1.st v3.st --all
said '^dropped +Main.gone : INT +\(was at [0-9]+; removed\)$'
