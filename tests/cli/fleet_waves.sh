#!/bin/sh
# X6-01 to X6-10: an edit goes out by waves to controllers that are processes of their own. A canary
# fails and goes back by itself, a tool is killed and resumed, one is aborted, and nobody accepts.
. "$(dirname "$0")/lib.sh"

# project FILE STEP LIMIT: `errors` grows where n has passed LIMIT.
project() {
  cat >"$1" <<ST
FUNCTION_BLOCK Filler VAR_OUTPUT n : LINT; END_VAR n := n + $2; END_FUNCTION_BLOCK
PROGRAM Main VAR f : Filler; errors : DINT := 1; limit : LINT := $3; END_VAR
f(); IF f.n > limit THEN errors := errors + 5; END_IF END_PROGRAM
ST
}
# waves FILE SOAK MORE: one canary, then the others.
waves() {
  for name in one two three; do
    printf '[controllers.%s]\ndir = "%s"\n' $name $name
  done >"$1"
  cat >>"$1" <<TOML
[roll]
health = ["Main.errors <= baseline(Main.errors) + 2"]
soak = "$2"
${3:-}
[[wave]]
controllers = ["two"]
[[wave]]
percent = 100
parallel = 2
TOML
}
roll() { stvm fleet roll x.fleet --fleet fleet.toml --allow-overrun "$@"; }
# Of a plan that may not be there yet.
cat_plan() { "$bin/stvm" fleet watch x.fleet.plan --format json | python3 -c 'import json, sys
for c in json.load(sys.stdin)["controllers"]: print(c["wave"], c["controller"], c["state"])'; }
on_trial() { [ "$(stvm status --dir "$1" --format json | grep -c '"edits":1')" = 1 ]; }

project one.st 1 9000000000000000000
project two.st 1000 9000000000000000000
expect 0 stc fleet one.st two.st -o x.fleet
for name in one three; do serve $name one.st; done
serve two one.st

# Mistakes of the file have their place, and nothing is sent to anybody.
waves fleet.toml 1s 'soaks = 3'
expect 7 stvm fleet roll x.fleet --fleet fleet.toml --yes
said 'fleet.toml:10:1: error.R0506.: .soaks. is not known'
waves fleet.toml 1s 'grace = 5'
expect 7 stvm fleet roll x.fleet --fleet fleet.toml --yes
said '^ +10 . grace = 5$'
said '^ +[|] +\^'
waves fleet.toml 1s
expect 2 roll
said 'cannot ask for confirmation'
expect 2 stvm fleet roll x.fleet --dir one --yes
said 'from --fleet FILE'
# Units that start one after the other are no trial that one condition can watch.
expect 0 stc fleet one.st two.st -o each.fleet --start each
expect 2 stvm fleet roll each.fleet --fleet fleet.toml --yes --allow-overrun
said 'R0504.*make it without --start each'
[ ! -e each.fleet.plan ] || fail "a plan of what is refused"
sed 's/Main.errors <=/Main.error <=/' fleet.toml >other.toml
expect 7 stvm fleet roll x.fleet --fleet other.toml --yes --allow-overrun
said 'R0401'
said 'nothing was begun: in wave 1 two cannot take the edit'
[ ! -e x.fleet.plan ] || fail "a plan of nothing"

# All is well: the plan, the check of all, and two waves.
expect 0 roll --dry-run
said '^plan [0-9a-f]{8} by [a-z]+: fleet file [0-9a-f]{12}$'
said '^2 +1s +10min2s|^2 +1s +602s'
said '^healthy: Main.errors <= baseline'
said '^one +one +possible'
expect 0 roll --yes
said '^two: on trial$'
said '^2 +three +accepted'
expect 0 stvm journal --dir two
said 'fleet file [0-9a-f]{12}, plan [0-9a-f]{8} wave 1 by '
said '^ +edit E1, plan [0-9a-f]{8} wave 1 by '
expect 0 stvm fleet watch x.fleet.plan
said ': done$'
expect 0 stvm fleet watch x.fleet.plan --format json
json 'd["phase"] == "done" and [(c["controller"], c["wave"], c["state"]) for c in d["controllers"]] ==
      [("two", 1, "accepted"), ("one", 2, "accepted"), ("three", 2, "accepted")]'
expect 7 stvm fleet abort x.fleet.plan
said 'R0305.*it is over|R0305.*the roll-out is over'
expect 0 roll --yes
said '^two: had it$'

# The canary makes errors. It goes back by itself, with condition, values and cycle in its journal.
project bad.st 7 5
sed 's/limit : LINT := 5/limit : LINT := 9000000000000000000/; s/f.n > limit/f.n > 5/' bad.st >three.st
expect 0 stc fleet two.st three.st -o x.fleet
rm -f x.fleet.plan
waves fleet.toml 1h
expect 7 roll --yes
said '^two: failed: edit E[0-9]+: plan [0-9a-f]{8} wave 1 by [a-z]+: .Main.errors <= baseline'
said '^2 +one +skipped'
expect 0 stvm journal --dir two
said ' undone .* by controller$'
said 'edit E[0-9]+: plan [0-9a-f]{8} wave 1 by'
said 'is FALSE in cycle [0-9]+: Main.errors = 6, baseline.Main.errors. = 1'
for name in one two three; do
  expect 0 stvm edits --dir $name --format json
  json 'not [e for e in d["edits"] if not e["undone"]]'
done

# A tool that is killed leaves its trials to their deadline. Another one goes on.
project four.st 3 9000000000000000000
expect 0 stc fleet two.st four.st -o x.fleet
rm -f x.fleet.plan
waves fleet.toml 1h
"$bin/stvm" fleet roll x.fleet --fleet fleet.toml --allow-overrun --yes >roll.log 2>&1 &
tool=$!
wait_for '^1 two on trial$' cat_plan
expect 7 stvm fleet resume x.fleet.plan
said 'R0406.*a roll-out is at work on it'
kill -9 $tool
wait $tool 2>/dev/null || true
on_trial two || fail "it is on trial without a tool"
expect 0 stvm status --dir two
said '^  watched     by plan [0-9a-f]{8} wave 1 by [a-z]+; taken back in (2 h|1[0-9]+ min) unless accepted$'
expect 0 stvm status --dir two --format json
json 'd["watched_by"].startswith("plan ") and 0 < d["watch_left_ns"] < 3 * 3600 * 10**9'
expect 0 stvm status --dir one --format json
json '"watched_by" not in d'
expect 7 roll --yes
said 'R0302.*is not over'
sed -i 's/soak = ..1h/soak = \\"1s/' x.fleet.plan
expect 0 stvm fleet resume x.fleet.plan
said '^2 +three +accepted'
expect 0 stvm journal --dir two
[ "$(grep -c 'switched.*plan.*wave 1' out)" -le 3 ] || fail "it was brought twice"

# Aborted: open trials go back.
project five.st 4 9000000000000000000
expect 0 stc fleet four.st five.st -o x.fleet
rm -f x.fleet.plan
waves fleet.toml 1h
"$bin/stvm" fleet roll x.fleet --fleet fleet.toml --allow-overrun --yes >roll.log 2>&1 &
tool=$!
wait_for '^1 two on trial$' cat_plan
kill $tool
wait $tool 2>/dev/null || true
expect 0 stvm fleet abort x.fleet.plan
said '^1 +two +undone'
said ': aborted'
expect 7 stvm fleet watch x.fleet.plan

# With a window the tool waits, and the controller looks at what was before.
rm -f x.fleet.plan
waves fleet.toml 1s 'window = "700ms"'
began=$(date +%s%N)
expect 0 roll --yes
said '^2 +three +accepted'
[ $(($(date +%s%N) - began)) -gt 1400000000 ] || fail "it did not wait for two windows"
expect 0 stc fleet five.st four.st -o back.fleet
rm -f back.fleet.plan
expect 0 stvm fleet roll back.fleet --fleet fleet.toml --allow-overrun --yes

# Nobody accepts, and no tool is there: the controller goes back by its deadline.
rm -f x.fleet.plan
waves fleet.toml 1h 'accept = "at-end"'
sed 's/"two".$/&\nsoak = "1s"\ndeadline = "2s"/' fleet.toml >other.toml
"$bin/stvm" fleet roll x.fleet --fleet other.toml --allow-overrun --yes >roll.log 2>&1 &
tool=$!
wait_for '^1 two (on trial|failed)$' cat_plan
kill -9 $tool
wait $tool 2>/dev/null || true
wait_for 'nobody has accepted it by its deadline in cycle' stvm journal --dir two
expect 7 stvm fleet resume x.fleet.plan
said '^1 +two +failed'
for name in one two three; do expect 0 stvm stop --dir $name; done
