#!/bin/sh
# R-05 What becomes of warnings: by command line, stc.toml and pragmas. R-07 helps that work.
. "$(dirname "$0")/lib.sh"

mkdir plant
cat >plant/main.st <<'ST'
PROGRAM Main
  VAR unused : INT; n, kept : INT; d : DINT := 5; END_VAR
  n := d;
  {warning off W0001}
  n := d + kept;
  {warning restore W0001}
END_PROGRAM
ST
# summary WANT COMMAND...: the last line but refusals of what it says
summary() {
  want=$1
  shift
  "$@" >out 2>err || true
  got=$(grep -E '^[0-9]+ error' err)
  [ "$got" = "$want" ] || fail "$*: $got, not $want"
}
expect 0 stc check plant
summary "0 errors, 2 warnings, 1 note" stc check plant
expect 1 stc check -Werror plant
summary "2 errors, 1 note" stc check -Werror plant
summary "2 errors, 1 note" stc check --warn error plant
summary "1 error, 1 warning, 1 note" stc check -W error --warn W0003=warning plant
summary "1 error, 2 warnings" stc check --warn=W0013=error plant
expect 0 stc check -Werror --warn W0003=off --warn W0001=note plant
summary "0 errors, 2 notes" stc check -Werror --warn W0003=off --warn W0001=note plant

# The settings of the project, and the command line over them.
printf '[warnings]\nas_errors = true\nW0003 = "off"\nW0013 = "warning"\n' >plant/stc.toml
summary "1 error, 1 warning" stc check plant
summary "0 errors, 2 warnings" stc check --warn W0001=warning plant
expect 1 stc build plant -o plant.img
[ ! -e plant.img ] || fail "an image in spite of an error"
expect 0 stc build plant -o plant.img --warn W0001=off
expect 1 stc test plant
expect 1 stvm run plant --scans 1 --virtual-time
expect 0 stvm run plant --scans 1 --virtual-time --warn W0001=off

# Whatever has no effect is refused.
refused() {
  text=$1
  shift
  expect 2 "$@"
  grep -qF "$text" err || fail "$*: lacks $text"
}
refused 'neither `error` nor CODE=LEVEL' stc check plant --warn all
refused 'the level is error, warning, note or off' stc check plant --warn W0003=of
refused '`W003` is no code of a warning; did you mean `W0003`?' stc check plant --warn W003=off
refused '`E3001` is an error' stc check plant --warn E3001=off
refused 'W0003 is given twice' stc check plant --warn W0003=off --warn W0003=error
bad_settings() {
  printf '[warnings]\n%s\n' "$1" >plant/stc.toml
  expect 7 stc check plant
  grep -qF "$2" err || fail "$1: lacks $2"
}
bad_settings 'W0003 = "of"' '`W0003` must be "error", "warning", "note" or "off", not "of"; did you mean `off`?'
bad_settings 'W003 = "off"' 'did you mean `warnings.W0003`?'
bad_settings 'E3001 = "off"' '`E3001` is an error; only warnings and notes have a level'
bad_settings 'all = true' 'known in [warnings] are as_errors and the codes of warnings'
rm plant/stc.toml

# A level counts in every form of the answer.
expect 1 stc check plant --warn W0003=error --format json
python3 - <<'PY' || fail "levels in JSON: $(cat out)"
import json
found = json.load(open("out"))
assert (found["errors"], found["warnings"], found["notes"]) == (1, 1, 1), found
levels = {d["code"]: d["severity"] for d in found["diagnostics"]}
assert levels == {"W0003": "error", "W0001": "warning", "W0013": "note"}, levels
PY
expect 1 stc check plant --warn W0003=error --format sarif
grep -q '"ruleId":"W0003","ruleIndex":[0-9]*,"level":"error"' out || fail "levels in SARIF"
expect 1 stc check plant --warn W0003=error --format github
grep -q '^::error .*title=W0003' out || fail "levels for GitHub"

# Examples that come along say nothing.
for example in "$source_dir"/examples/*; do
  case $example in */timing) continue ;; esac  # four versions, each compiled alone
  [ -d "$example" ] || continue
  expect 0 stc check "$example"
  [ ! -s err ] || fail "$example: $(cat err)"
done
for example in "$source_dir"/examples/timing/*.st; do
  expect 0 stc check "$example"
  [ ! -s err ] || fail "$example: $(cat err)"
done

# The helps of R-07, and that the first of them compiles.
helps() {
  file=$source_dir/tests/golden/check/$1.st
  shift
  stc check "$file" >out 2>err || true
  for text in "$@"; do
    grep -qF "$text" err || fail "no help: $text"
  done
}
helps fail_help_r07 'write `n := n + 1`' 'write `n := n - 1`' 'write `ELSIF`'
helps fail_types_r07 'convert what it gives: TO_REAL(' 'let it arrive at EN: GE(EN:=_, ...)'
helps right_operand_traps 'use AND_THEN' 'compute it in a box with EN, or jump over the rung'
cat >mode.st <<'ST'
TYPE Mode : (Off, On); END_TYPE
PROGRAM Main VAR m : Mode; i : INT := 1; END_VAR m := i; END_PROGRAM
ST
expect 0 stc check mode.st
grep -qF 'for example with TO_Mode' err || fail "no help for an enumeration"
sed 's/m := i/m := TO_Mode(i)/' mode.st >explicit.st
expect 0 stc check -Werror explicit.st
expect 1 stc check --dialect iec mode.st
grep -qF 'choose the literal with CASE' err || fail "no help in strict IEC"
cat >open.st <<'ST'
FUNCTION_BLOCK Open VAR x AT %I* : INT; y AT %Q* : BOOL; END_VAR y := x > 0; END_FUNCTION_BLOCK
PROGRAM Main VAR o : Open; END_VAR o(); END_PROGRAM
ST
expect 1 stc check --dialect iec open.st
grep -qF 'VAR_CONFIG Main.o.x AT %IW0 : INT; END_VAR' err || fail "no address of an INT"
grep -qF 'VAR_CONFIG Main.o.y AT %QX0.0 : BOOL; END_VAR' err || fail "no address of an output"

# The compiler that stays follows the pragmas of what is saved; a warning that is an error gives no
# image there, either.
mkdir live
saved() {
  printf 'PROGRAM Main\n  VAR n : INT; d : DINT := 5; END_VAR\n%s\nEND_PROGRAM\n' "$1" >live/next
  mv live/next live/main.st
}
# reported TIMES: so often W0001 was said since the last save
reported() {
  for _ in $(seq 4000); do
    [ "$(grep -c 'R0505\|^built ' watch.log)" -ge "$builds" ] && break
    sleep 0.05
  done
  builds=$((builds + 1))
  got=$(grep -c 'error\[W0001\]' watch.log || true)
  [ "$got" -eq "$1" ] || fail "W0001 was said $got times, not $1: $(cat watch.log)"
}
builds=1
saved '  {warning off W0001} n := d; {warning restore}'
"$bin/stc" build live --watch -o live.img --warn W0001=error >watch.out 2>watch.log </dev/null &
echo $! >watch.pid
reported 0
saved '  n := 1; n := 2; n := 3; {warning off W0001} n := d; {warning restore}'
reported 0
cp live.img before.img
saved '  {warning off W0001} n := 4; {warning restore} n := d;'
reported 1
cmp -s before.img live.img || fail "an image in spite of a warning that is an error"
saved '  n := d; {warning off W0001} n := d; {warning restore}'
reported 2
saved '  {warning off W0001} n := d; n := d; {warning restore}'
reported 2
cmp -s before.img live.img && fail "no image after the error"

# With iec a quotient of what was cut: both conversions that the help names compile.
printf 'PROGRAM p VAR w : INT; END_VAR w := (w + 1) MOD 4; END_PROGRAM\n' >cut.st
expect 0 stc check --dialect iec cut.st
said 'W0084.*cut to `INT` before it is divided'
said 'help: convert an operand: \(TO_DINT\(a\) \+ b\) / c; where .* TO_INT\(\(TO_DINT\(a\) \+ b\) / c\)'
printf 'PROGRAM p VAR w : INT; END_VAR w := TO_INT((TO_DINT(w) + 1) MOD 4); END_PROGRAM\n' >cut.st
expect 0 stc check --dialect iec cut.st
grep -q W0084 out err && fail 'the help is warned of'

# So many are listed, and each form says that there are more; the limit is in the table of limits.
{
  echo 'PROGRAM Main VAR a : INT; l : DINT; END_VAR'
  for _ in $(seq 205); do echo '  a := l;'; done
  echo 'END_PROGRAM'
} >many.st
expect 0 stc check many.st
said '^0 errors, 205 warnings, 1 note \(201 shown\)$'
expect 0 stc check many.st --format json
json 'len([e for e in d["diagnostics"] if e["severity"] == "warning"]) == 200 and d["warnings"] == 205'
expect 0 stc check many.st --format sarif
json 'len(d["runs"][0]["results"]) >= 200'
json 'd["runs"][0]["invocations"][0]["executionSuccessful"]'
json '"warnings 200 are listed" in d["runs"][0]["invocations"][0]["toolExecutionNotifications"][0]["message"]["text"]'
expect 0 stc check many.st --format github
said '^::warning title=stc::of 205 warnings 200 are listed$'
sed "s/a := l/a := 'text'/" many.st >many_errors.st
expect 1 stc check many_errors.st --format github
said '^::warning title=stc::of 205 errors 200 are listed$'
expect 0 stc check cut.st --format sarif
json '"invocations" not in d["runs"][0]'
expect 0 stc explain limits
said '^ *200  errors of one run that are listed, .* kMostListedMessages$'
exit 0
