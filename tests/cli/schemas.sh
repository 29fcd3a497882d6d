#!/bin/sh
# R-04 What each command answers with --format json is what its schema in docs/schemas says, and each
# command that has that form has a schema.
. "$(dirname "$0")/lib.sh"

schemas=$source_dir/docs/schemas
cat >valid.py <<'PY'
# The part of JSON schema that those files use; a word that is not known here is an error.
import json, re, sys
KINDS = {"object": dict, "array": list, "string": str, "boolean": bool, "integer": int,
         "number": (int, float)}

def check(value, schema, at):
    for word, want in schema.items():
        if word in ("$schema", "title", "properties"):
            continue
        if word == "type":
            kind = isinstance(value, KINDS[want]) and (want == "boolean" or value is not True and value is not False)
            if not kind: return f"{at}: not {want}: {value!r}"
        elif word == "enum":
            if value not in want: return f"{at}: {value!r} is none of {want}"
        elif word == "pattern":
            if not re.search(want, value): return f"{at}: {value!r} does not match {want}"
        elif word == "required":
            lost = set(want) - set(value)
            if lost: return f"{at}: lacks {lost}"
        elif word == "items":
            for i, item in enumerate(value):
                if wrong := check(item, want, f"{at}[{i}]"): return wrong
        elif word == "additionalProperties":
            known = schema["properties"]
            for key, part in value.items():
                inner = known.get(key, want)
                if inner is False: return f"{at}: {key} is not in the schema"
                if inner is not True and (wrong := check(part, inner, f"{at}.{key}")): return wrong
        elif word == "anyOf":
            if all(check(value, other, at) for other in want): return f"{at}: none of the forms"
        else:
            return f"unknown word {word}"
    return None

wrong = check(json.load(open("out")), json.load(open(sys.argv[1])), "")
if wrong: sys.exit(wrong)
PY
seen=""
# answers SCHEMA CODE COMMAND...
answers() {
  schema=$1 code=$2
  shift 2
  expect "$code" "$@" --format json
  holds "$schema"
}
# holds SCHEMA: what the last command answered is what SCHEMA says
holds() {
  schema=$1
  python3 valid.py "$schemas/$schema.schema.json" >wrong 2>&1 || fail "$schema: $(cat wrong)"
  seen="$seen $schema"
}

mkdir plant
cat >plant/main.st <<'ST'
PROGRAM Main VAR n : INT; d : INT; END_VAR n := n + 1; d := n; END_PROGRAM
TEST 'holds' ASSERT_TRUE(TRUE); END_TEST
TEST 'fails' ASSERT_EQ(1, 2); END_TEST
ST
printf 'embed_sources = true\n' >plant/stc.toml
sed 's/d := n/d := m/' plant/main.st >bad.st
printf 'PROGRAM Main VAR z : INT; n : INT; END_VAR n := 1 / z; END_PROGRAM\n' >trap.st
answers stc-build 0 stc build plant -o plant.img
answers stc-check 1 stc check bad.st
answers stc-test 1 stc test plant
answers stc-test 1 stc test plant --seed 3 --coverage reached
answers stc-test-list 0 stc test plant --list
answers stc-fmt 1 stc fmt --check plant
answers stc-source 0 stc source plant.img
answers stc-source 0 stc source plant.img -o back
answers stc-xref 0 stc xref plant
answers stc-xref 0 stc xref plant --at plant/main.st:1:57
answers refused 7 stc check missing.st
cp plant/main.st old.st
mkdir next
sed 's/n : INT;/n : DINT; more : INT;/; s/d := n/d := DINT_TO_INT(n)/' plant/main.st >next/main.st
cp plant/stc.toml next
answers stc-diff 0 stc diff plant next --all --text
code=0
stc export plant/main.st -o x.xml >out 2>err || code=$?
if [ "$code" -eq 0 ]; then
  answers stc-export 0 stc export plant/main.st -o x.xml
  answers stc-import 0 stc import x.xml -o imported
else
  seen="$seen stc-export stc-import"
fi
for tool in stc stvm; do
  answers $tool-help 0 $tool help
  answers $tool-version 0 $tool version
done
answers stvm-run 0 stvm run plant.img --virtual-time --scans 2 --print Main.n --state --hash
answers stvm-run 1 stvm run trap.st --virtual-time --scans 2
expect 0 stvm run plant.img --virtual-time --scans 2 --record r.rec
answers stvm-replay 0 stvm replay r.rec --print Main.n
answers stvm-bench 0 stvm bench plant.img --scans 10
# Whether this machine is good enough (0 or 1) differs from run to run on one that is loaded.
code=0
stvm doctor --seconds 1 --format json >out 2>err || code=$?
[ "$code" -le 1 ] || fail "stvm doctor: exit code $code"
holds stvm-doctor

answers refused 7 stc fleet plant.img next -o next.fleet
answers stc-fleet 0 stc fleet plant.img next -o next.fleet --table free
answers stc-check 1 stc check next --online-base plant.img
answers stc-build 1 stc build next -o next.img --online-base plant.img
answers stc-package 0 stc package next --base plant.img -o next.pkg
json "d['bytes'] == $(wc -c <next.pkg) and d['digest'] == '$(sha256sum <next.pkg | cut -d' ' -f1)'"
json 'd["file"] == "next.pkg" and d["base"] != d["next"]'
answers refused 7 stc package missing.st --base plant.img -o next.pkg
answers refused 1 stc package bad.st --base plant.img -o next.pkg
# What prints something else has no such form, and a log of results is no answer of what makes one.
for command in 'dump plant' 'draw plant'; do
  answers refused 2 stc $command
  said 'unknown option --format'
done
for command in 'package next --base plant.img -o x' 'fleet plant.img next -o x'; do
  expect 2 stc $command --format sarif
  said '--format is text or json, not `sarif`'
done
expect 2 stc package next --base plant.img --watch --format json
said '--watch and --format contradict each other'
answers stc-explain 0 stc explain online-edits
serve plc plant.img
at() { command=$1; shift; stvm "$command" --dir plc "$@"; }
answers stvm-get 0 at get Main.n
answers stvm-get-list 0 at get --list
answers stvm-watch 0 at watch Main.n --count 1
answers stvm-set 0 at set Main.n=3
answers stvm-force 0 at force Main.n=3
answers stvm-get-forces 0 at get --forces
answers stvm-unforce 0 at unforce --all
answers stvm-status 0 at status
answers stvm-status-task 0 at status --task Main
answers stvm-source 0 at source
answers stvm-abort 0 at abort
answers stvm-fleet-status 0 at fleet status
answers stvm-fleet-status 0 at fleet status next.fleet
answers stvm-fleet-diff 1 at fleet diff next.fleet
answers stvm-fleet 0 at fleet change next.fleet --dry-run
printf 'VAR_GLOBAL g : INT; END_VAR PROGRAM Main END_PROGRAM\n' >one.st
printf 'VAR_GLOBAL g : INT; h : INT; END_VAR PROGRAM Main END_PROGRAM\n' >two.st
printf 'VAR_GLOBAL g : DINT; END_VAR PROGRAM Main END_PROGRAM\n' >other.st
expect 0 stc fleet one.st two.st -o two.fleet
serve other other.st
answers stvm-fleet-status 7 stvm fleet status two.fleet --dir other
answers stvm-change 0 at change next --yes --dry-run --all
# Errors of the sources come from the compiler behind it, in that form too, beside the text.
answers refused 1 at change bad.st --yes
json '[(e["code"], e["file"], e["line"]) for e in d["diagnostics"]] == [("E2001", "bad.st", 1)]'
said '^bad.st:1:[0-9]+: error.E2001.'
answers refused 1 stvm run bad.st
answers stvm-change 0 at change next --yes --all
answers stvm-status 0 at status
answers stvm-status-units 0 at status --units
answers stvm-edits 0 at edits
answers stvm-undo 0 at undo --dry-run
answers stvm-undo 0 at undo
answers stvm-edits 0 at edits
answers stvm-redo 0 at redo --yes
sed 's/more : INT/more, less : INT/' next/main.st >third.st
expect 0 at change third.st --yes
answers stvm-edits 0 at edits
answers stvm-undo 0 at undo E1 --yes
expect 0 at change next --yes
answers stvm-accept 0 at accept
answers stvm-revert 0 at revert --yes --allow-loss
answers stvm-fleet 0 at fleet change next.fleet --yes --allow-overrun
answers stvm-fleet 0 at fleet undo next.fleet --yes
answers stvm-fleet 0 at fleet accept next.fleet --yes
sed 's/more : INT/more, most : INT/' next/main.st >fourth.st
stvm accept --dir plc >/dev/null 2>&1 || true
answers stvm-image 0 at image -o now.img
json "d['file'] == 'now.img' and d['bytes'] == $(wc -c <now.img)"
expect 0 stc fleet now.img fourth.st -o roll.fleet --table free
printf '[controllers.plc]\ndir = "plc"\n[[wave]]\ncount = 1\nsoak = "0s"\n' >fleet.toml
answers stvm-fleet 0 stvm fleet roll roll.fleet --fleet fleet.toml --dry-run
answers stvm-fleet-roll 0 stvm fleet roll roll.fleet --fleet fleet.toml --yes --allow-overrun
answers stvm-fleet-roll 0 stvm fleet watch roll.fleet.plan
answers stvm-restart 0 at restart
answers stvm-journal 0 at journal
answers stvm-events 0 at events
answers refused 7 at get Main.nothing
answers stvm-stop 0 at stop

# Keys, where OpenSSL is there.
code=0
stc key new office -o office.key >out 2>err || code=$?
if [ "$code" -eq 0 ]; then
  cp out keys.toml
  answers stc-key 0 stc key new chief --revokes --days 3 -o chief.key
  json 'd["revokes"] and d["until"] > "2026" and d["file"] == "chief.key"'
  python3 -c 'import json; print(json.load(open("out"))["trust"])' >>keys.toml
  answers stc-key 0 stc key new other -o other.key
  json 'd["until"] is None and d["key"] in d["trust"]'
  answers stc-key 0 stc key sign plant.img --key office.key --target plc -o plant.signed
  json "d['content'] == '$(sha256sum <plant.img | cut -d' ' -f1)' and d['signer'] is None"
  answers stc-key 0 stc key verify plant.signed --trust keys.toml
  json '(d["signer"], d["kind"], d["target"]) == ("office", "image", "plc")'
  answers refused 7 stc key verify plant.img --trust keys.toml
  answers stc-key 0 stc key revoke office --trust keys.toml --key chief.key -o gone.signed
  json 'd["kind"] == "list of revoked keys" and d["target"] is None'
  (echo 'name = "plc"' && cat keys.toml) >plc.toml
  serve locked plant.signed --trust plc.toml
  answers stvm-revoke 0 stvm revoke gone.signed --dir locked
else
  seen="$seen stc-key stvm-revoke"
fi

# Every schema was used, and every command with this form has one.
for file in "$schemas"/*.schema.json; do
  name=$(basename "$file" .schema.json)
  case " $seen " in *" $name "*) ;; *) fail "no answer for $name" ;; esac
done
for tool in stc stvm; do
  expect 0 $tool help --format json
  for verb in $(python3 -c 'import json
for c in json.load(open("out"))["commands"]:
    if any("json" in o["choices"] for o in c["options"]): print(c["name"])'); do
    [ -e "$schemas/$tool-$verb.schema.json" ] || fail "$tool $verb has no schema"
  done
done
