#!/bin/sh
# R-04 Exit codes, output that cannot be written, and what is refused in the forms for programs.
. "$(dirname "$0")/lib.sh"

cat >good.st <<'ST'
PROGRAM Main
VAR small : INT := -3; wide : LINT := 9007199254740993; real : REAL := 0.5; on : BOOL := TRUE;
  text : STRING := 'a$'b$N"c'; list : ARRAY[0..2] OF LINT := [1, 2, 3]; time : TIME := T#1s;
  point : STRUCT x : INT := 1; far : ULINT := 18446744073709551615; END_STRUCT;
  nan : REAL; word : WORD := 16#FF; nothing : POINTER TO INT; END_VAR
small := small;
END_PROGRAM
TEST 'holds' ASSERT_TRUE(TRUE); END_TEST
ST
sed 's/small := small;/small := nonsense;/' good.st >bad.st
printf 'PROGRAM Main VAR z, n : INT; END_VAR n := 1 / z; END_PROGRAM\n' >trap.st
expect 0 stc build good.st -o good.img

# Each code, as the table says.
expect 0 stc check good.st
expect 1 stc check bad.st
expect 1 stvm run trap.st --virtual-time --scans 1
expect 2 stc check --format
expect 2 stvm get --dir nowhere
expect 7 stc check missing.st
expect 7 stvm get Main.small --dir nowhere
said 'R0404'
# A compiler beside stvm that ends without a word is a fault of the tools.
mkdir beside
cp "$bin/stvm" beside/
printf '#!/bin/sh\nexit 3\n' >beside/stc
chmod +x beside/stc
expect 70 beside/stvm run good.st --virtual-time --scans 1
said 'R0599: stc failed without a reason'
for tool in stc stvm; do
  expect 0 $tool help --format json
  json '[row["code"] for row in d["exit_codes"]] == [0, 1, 2, 7, 70, 74]'
  expect 0 $tool --help
  for code in 0 1 2 7 70 74; do said "^  $code +[a-z]"; done
done
expect 0 stc explain exit_codes
said '^ +74 +output'

# Output that is lost is an error of its own; a file is as it should be all the same.
full() { "$@" >/dev/full 2>err </dev/null; }
closed() { "$@" >&- 2>err </dev/null; }
for way in full closed; do
  for command in 'stc explain limits' 'stc --version' 'stc help' 'stvm help run' 'stc dump good.img' \
    'stc check good.st --format json' 'stc test good.st' \
    'stvm run good.img --virtual-time --scans 1 --state'; do
    code=0
    $way $command || code=$?
    [ "$code" -eq 74 ] || fail "$way: exit code $code instead of 74: $command"
    grep -q ': standard output could not be written' err || fail "$way: not said: $command"
    grep -q '  help: the command has done its work' err || fail "$way: no way out: $command"
  done
  code=0
  $way stc check bad.st --format json || code=$?
  [ "$code" -eq 74 ] || fail "$way: findings"
  code=0
  $way stc check missing.st --format json || code=$?
  [ "$code" -eq 7 ] || fail "$way: what is refused stays refused, not $code"
done

closed stc build good.st -o x.img --quiet || fail "nothing was to be said"
cmp -s x.img good.img || fail "what was printed got into the image"
"$bin/stc" build good.st -o y.img >&- 2>&- <&- || fail "all three are closed"
cmp -s y.img good.img || fail "a closed stream got into the image"

# Neither does a file of the state folder, which stays open while a controller runs.
"$bin/stvm" serve --dir plc good.img >&- 2>err </dev/null &
echo $! >plc.pid
wait_for '^  running' stvm status --dir plc
expect 0 stvm stop --dir plc
if grep -qa ready plc/*; then fail "what was printed got into the state folder"; fi

# What is refused, as JSON, SARIF and for GitHub: one document each, the code in it.
for command in 'check missing.st' 'build missing.st -o x.img' 'build good.st -o no/where.img' \
  'diff missing.st good.st' 'export missing.st -o x.xml'; do
  expect 7 stc $command --format json
  json 'd["errors"] == 1 and d["diagnostics"][-1]["code"].startswith("R05")'
  json 'd["diagnostics"][-1]["message"] and d["diagnostics"][-1]["fix"]'
  expect 7 stc $command --format sarif
  json 'd["runs"][0]["results"][-1]["ruleId"].startswith("R05")'
  json 'd["runs"][0]["tool"]["driver"]["rules"][-1]["id"] == d["runs"][0]["results"][-1]["ruleId"]'
  expect 7 stc $command --format github
  said '^::error title=R050[13]::'
done
for command in 'test missing.st' 'fmt --check missing.st' 'import missing.xml -o x'; do
  expect 7 stc $command --format json
  # R0502: without pugixml, nothing is imported.
  json 'd["errors"] == 1 and d["diagnostics"][0]["code"] in ("R0501", "R0502")'
done
expect 2 stc check good.st --format json --frobnicate
json 'd["diagnostics"][0]["code"] == "R0504"'
for command in 'get Main.small' 'status' 'set Main.small=1' 'undo' 'accept' 'restart' \
  'abort' 'watch Main.small' 'force Main.small=1' 'stop'; do
  expect 7 stvm $command --dir nowhere --format json
  json 'd["diagnostics"][0]["code"] == "R0404" and d["diagnostics"][0]["severity"] == "error"'
done
expect 1 stc diff good.st bad.st --format json
json 'd["errors"] == 1 and d["diagnostics"][0]["code"].startswith("E2")'
expect 1 stc test bad.st --format json
json 'd["errors"] == 1'

# SARIF: version, addresses that hold on another machine, fingerprints that survive moved lines.
expect 1 stc check "$work/bad.st" --format sarif
json 'd["runs"][0]["tool"]["driver"]["version"].count(".") == 2'
json 'd["runs"][0]["results"][0]["locations"][0]["physicalLocation"]["artifactLocation"] ==
  {"uri": "bad.st", "uriBaseId": "SRCROOT"}'
json 'd["runs"][0]["originalUriBaseIds"]["SRCROOT"]["uri"] == "file://'"$work"'/"'
print() { python3 -c 'import json; print(*[r["partialFingerprints"]["lineOfCode/v1"]
  for r in json.load(open("out"))["runs"][0]["results"]])'; }
print >before
sed -i '1i\\n' bad.st
expect 1 stc check bad.st --format sarif
print >after
cmp before after || fail "a moved line has another fingerprint"
sed -i 's/small := nonsense;/small := nonsense + rubbish;/' bad.st
expect 1 stc check bad.st --format sarif
[ "$(print | tr ' ' '\n' | sort -u | wc -l)" = 2 ] || fail "two results of a line are told apart"

# Values have their type beside them, and are what they are.
typed() {
  json 'd["values"]["Main.small"] == {"type": "INT", "value": -3}'
  json 'd["values"]["Main.wide"] == {"type": "LINT", "value": "9007199254740993"}'
  json 'd["values"]["Main.real"]["value"] == 0.5 and d["values"]["Main.on"]["value"] is True'
  json 'd["values"]["Main.text"]["value"] == "a\u0027b\n\"c"'
  json 'd["values"]["Main.list"] == {"type": "ARRAY[0..2] OF LINT", "value": ["1", "2", "3"]}'
  json 'd["values"]["Main.point"]["value"] == {"x": 1, "far": "18446744073709551615"}'
  json 'd["values"]["Main.time"]["value"] == "T#1s" and d["values"]["Main.word"]["value"] == 255'
  json 'd["values"]["Main.nothing"]["value"] is None and d["values"]["Main.nan"]["value"] == "NaN"'
}
names="Main.small Main.wide Main.real Main.on Main.text Main.list Main.time Main.point Main.nan Main.word Main.nothing"
expect 0 stvm run good.img --virtual-time --scans 1 --set Main.nan=NaN --format json \
  $(for name in $names; do echo --print "$name"; done)
typed
serve plc good.img
expect 0 stvm set Main.nan=NaN --dir plc
expect 0 stvm get $names --dir plc --format json
typed
expect 0 stvm force Main.small=4 --dir plc --format json
json 'd["forces"][0]["type"] == "INT" and d["forces"][0]["value"] == 4'
expect 0 stvm stop --dir plc

# What follows a controller ends where nobody gets what it prints.
printf 'PROGRAM Main VAR n : INT; END_VAR n := n + 1; END_PROGRAM\n' >followed.st
serve plc followed.st
for command in 'events --follow' 'watch Main.n --interval 1' 'top --interval 1'; do
  code=0
  full timeout 60 "$bin/stvm" $command --dir plc || code=$?
  [ "$code" -eq 74 ] || fail "exit code $code instead of 74: stvm $command"
done
expect 0 stvm stop --dir plc
