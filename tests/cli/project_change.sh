#!/bin/sh
# [change] of stc.toml (docs/PROJECT.md): what stvm change and serve do when they are given a project folder, and that options win;
# the limits of serve.
. "$(dirname "$0")/lib.sh"

mkdir line
cat >line/main.st <<'ST'
FUNCTION_BLOCK Pump VAR_INPUT on : BOOL; END_VAR VAR n : INT; END_VAR IF on THEN n := n + 1; END_IF END_FUNCTION_BLOCK
PROGRAM Main VAR p : Pump; END_VAR p(on := TRUE); END_PROGRAM
ST
printf '[change]\nrestricted = true\nstrategy = "standby"\ndata_limit = 100\n' >line/stc.toml
expect 0 stc check line

# Standby needs its areas three times: too much for the project's limit.
serve plc line
sed -i 's/n + 1/n + 2/' line/main.st
expect 7 stvm change line --dir plc --yes
said 'bytes'
expect 0 stvm change line --dir plc --yes --strategy in-place
expect 0 stvm accept --dir plc
# The interface of a POU.
sed -i 's/on : BOOL;/on : BOOL; fast : BOOL;/' line/main.st
expect 7 stvm change line --dir plc --yes --strategy in-place
said 'R0307'
expect 2 stvm change line --dir plc --yes --restricted --unrestricted
said 'contradict each other'
expect 0 stvm change line --dir plc --yes --strategy in-place --unrestricted
expect 0 stvm accept --dir plc
# R-03 A source by its name is a part of the project above it, which says how it is changed.
sed -i 's/fast : BOOL;/fast, slow : BOOL;/' line/main.st
expect 7 stvm change line/main.st --dir plc --yes
said 'R0307'
expect 0 stvm change line/main.st --dir plc --yes --unrestricted --strategy in-place
expect 0 stvm accept --dir plc

# Options win at serve, too.
serve roomy line --data-limit 0
sed -i 's/n + 2/n + 3/' line/main.st
expect 0 stvm change line --dir roomy --yes
expect 0 stvm stop --dir roomy
expect 7 stvm serve line --dir tight --code-limit 16
said 'code'
expect 2 stvm serve line --dir tight --code-limit many
# D5 The slack of code slots: the project's, or the option's.
needs() { sed -n 's/.*needs a code slot of \([0-9]*\) bytes.*/\1/p' err; }
expect 7 stvm serve line --dir tight --code-limit 16 --code-slack 0
least=$(needs)
cp line/stc.toml kept.toml
printf '[slack]\ncode_percent = 1000\n' >line/stc.toml
expect 7 stvm serve line --dir tight --code-limit 16
[ "$(needs)" -gt $((least * 2)) ] || fail "the project's slack: $(needs), without $least"
expect 7 stvm serve line --dir tight --code-limit 16 --code-slack 0
[ "$(needs)" -eq "$least" ] || fail "the option's slack: $(needs), without $least"
expect 2 stvm serve line --dir tight --code-slack 10001
mv kept.toml line/stc.toml

# Mistakes are found by every command that reads the project.
for line in 'strategy = "copy"' 'restricted = 1' 'data_limit = "x"' 'data_limit = -1' 'speed = 3'; do
  printf '[change]\n%s\n' "$line" >line/stc.toml
  expect 7 stc check line
  said 'R0506'
  expect 7 stvm change line --dir plc --yes
  said 'R0506'
done
expect 0 stvm stop --dir plc
