#!/bin/sh
# X6 over F-02: a roll-out by waves to controllers that brokers lead to. One is behind a second
# broker, which is bridged to the first. A canary goes back by itself; a tool is killed and another
# one goes on; one is aborted; a broker is cut off in the middle of a wave; files come from a folder
# and a server that URLs lead to.
. "$(dirname "$0")/lib.sh"
stc key new office -o office.key >keys.toml 2>/dev/null || {
  echo "built without OpenSSL; tests/cli/keys.sh shows the refusal"
  exit 0
}
printf '[broker]\nurl = "mqtts://localhost:1"\n[controllers.one]\nagent = "one"\n' >fleet.toml
"$bin/stvm" fleet status --fleet fleet.toml --timeout 1 >out 2>&1 || true
if grep -q 'R0429.*libmosquitto-dev' out; then
  echo "built without libmosquitto; tests/cli/agent.sh shows the refusal"
  exit 0
fi
. "$source_dir/tests/cli/lib_broker.sh"

start_broker
broker_conf branch
cat >>branch.conf <<CONF
connection to-broker
address localhost:$(cat broker.port)
bridge_cafile $work/ca.pem
cleansession false
restart_timeout 1
topic # both 1
CONF
start_broker branch

project() {  # project FILE STEP LIMIT: `errors` grows where n has passed LIMIT
  cat >"$1" <<ST
FUNCTION_BLOCK Filler VAR_OUTPUT n : LINT; END_VAR n := n + $2; END_FUNCTION_BLOCK
PROGRAM Main VAR f : Filler; errors : DINT := 1; limit : LINT := $3; END_VAR
f(); IF f.n > limit THEN errors := errors + 5; END_IF END_PROGRAM
ST
}
# edit OLD NEW: x.fleet, and no plan.
edit() {
  expect 0 stc fleet "$1" "$2" -o x.fleet
  rm -f x.fleet.plan
}
broker_table >broker.toml
broker_table branch >branch.toml
# waves SOAK MORE_OF_BROKER: one canary, then the others, one of them behind the branch.
waves() {
  { broker_table; [ -z "${2:-}" ] || echo "$2"; } >fleet.toml
  for name in one two three; do
    printf '[controllers.%s]\nagent = "%s"\n' $name $name
  done >>fleet.toml
  cat >>fleet.toml <<TOML
[roll]
health = ["Main.errors <= baseline(Main.errors) + 2"]
soak = "$1"
[[wave]]
controllers = ["two"]
[[wave]]
percent = 100
parallel = 2
TOML
}
roll() { stvm fleet roll x.fleet --fleet fleet.toml --allow-overrun --sign office.key "$@"; }
plan() { verb=$1; shift; stvm fleet "$verb" x.fleet.plan --sign office.key "$@"; }
cat_plan() { "$bin/stvm" fleet watch x.fleet.plan --format json | python3 -c 'import json, sys
for c in json.load(sys.stdin)["controllers"]: print(c["wave"], c["controller"], c["state"])'; }
begin_roll() {
  "$bin/stvm" fleet roll x.fleet --fleet fleet.toml --allow-overrun --sign office.key --yes \
    >roll.log 2>&1 &
  tool=$!
}
end_tool() {
  kill "-$1" $tool
  wait $tool 2>/dev/null || true
}
none_on_trial() {
  for name in "$@"; do
    expect 0 stvm edits --dir "$name" --format json
    json 'not [e for e in d["edits"] if not e["undone"]]'
  done
}

far=9000000000000000000
project one.st 1 $far
project two.st 1000 $far
stc build -q one.st -o one.img
stc key sign one.img --key office.key -o one.signed
for name in one two three; do
  { echo "name = \"$name\""; cat keys.toml; } >$name.toml
  serve $name --trust $name.toml one.signed
done
start_agent one
start_agent two
start_agent three branch.toml
waves 1s
for name in one two three; do
  wait_for "^$name .*reached" "$bin/stvm" fleet status --fleet fleet.toml
done

# F-03: a roll-out without a key is none. All is well with one.
edit one.st two.st
expect 7 stvm fleet roll x.fleet --fleet fleet.toml --allow-overrun --yes
said 'R0420: agents carry out only what is signed'
[ ! -e x.fleet.plan ] || fail "a plan of what cannot be ordered"
expect 0 roll --dry-run
said '^two +.*possible'
expect 0 roll --yes
said '^two: on trial$'
said '^2 +three +accepted'
expect 0 stvm journal --dir three
said 'fleet file [0-9a-f]{12}, plan [0-9a-f]{8} wave 2 by .*signed by office'
for name in one two three; do [ "$(running $name)" = "$(running one)" ] || fail "$name"; done
none_on_trial one two three

# X6-04: the canary makes errors. Its controller takes the edit back by itself, the tool hears of it.
project bad.st 7 5
sed "s/limit : LINT := 5/limit : LINT := $far/; s/f.n > limit/f.n > 5/" bad.st >three.st
edit two.st three.st
waves 1h
expect 7 roll --yes
said '^two: failed: edit E[0-9]+: plan [0-9a-f]{8} wave 1 by [a-z]+: .Main.errors <= baseline'
said '^2 +one +skipped'
none_on_trial one two three

# X6-07: a tool that is killed leaves its trial to the deadline; another one goes on.
project four.st 3 $far
edit two.st four.st
begin_roll
wait_for '^1 two on trial$' cat_plan
end_tool 9
expect 0 stvm status --dir two
said '^  watched     by plan [0-9a-f]{8} wave 1 by [a-z]+; taken back in (2 h|1[0-9]+ min) unless'
expect 7 stvm fleet resume x.fleet.plan
said 'R0420: agents carry out only what is signed'
sed -i 's/soak = ..1h/soak = \\"1s/' x.fleet.plan
expect 0 plan resume
said '^2 +three +accepted'
expect 0 stvm journal --dir two
[ "$(grep -c 'switched.*plan.*wave 1' out)" -le 3 ] || fail "it was brought twice"

# X6-08: aborted, open trials go back.
project five.st 4 $far
edit four.st five.st
begin_roll
wait_for '^1 two on trial$' cat_plan
end_tool TERM
expect 0 plan abort
said '^1 +two +undone'
none_on_trial one two three

# A broker is cut off in the middle, and an agent behind it has ended: its controller is lost, and
# the rest of its wave goes back. What was ordered reaches it later, and so does the word that takes
# it back.
waves 1h
rm -f x.fleet.plan
begin_roll
wait_for '^1 two on trial$' cat_plan
end_tool TERM
kill -9 "$(cat three-agent.pid)"
wait_for '^three .*unreachable' "$bin/stvm" fleet status --fleet fleet.toml
kill -STOP "$(cat branch.pid)"
old=$(running three)
sed -i 's/soak = ..1h/soak = \\"1s/' x.fleet.plan
expect 7 plan resume --timeout 600
said '^2 +one +undone'
said '^2 +three +lost'
id=$("$bin/stvm" fleet watch x.fleet.plan | sed -n 's/^plan \([0-9a-f]*\) .*/\1/p' | head -1)
kill -CONT "$(cat branch.pid)"
start_agent three branch.toml
# The last word takes it back, whether or not the order of before came first.
wait_for "plan $id: (had it not|undone)" cat three.agent.log
none_on_trial one two three
[ "$(running three)" = "$old" ] || fail "it runs what it was told to give back"

# F-02: files from a folder that a URL leads to: the broker holds none. What is there under the
# name of a file must be that file.
mkdir files
waves 1s "files = \"file://$work/files\"
files_folder = \"files\""
edit four.st five.st
fleet change --yes --sign office.key >out 2>err
said '^three .*(done|had it)'
[ "$(ls files | wc -l)" -ge 2 ] || fail "nothing in the folder"
for file in files/*; do
  [ "$(sha256sum <"$file" | cut -c1-64)" = "$(basename "$file")" ] || fail "$file"
done
expect 0 fleet accept --yes --sign office.key

# The same from a server over TLS, whose certificate counts: `one` knows the CA, `three` does not.
free_port >https.port
cat >https.py <<'PY'
import functools, http.server, ssl, sys
handler = functools.partial(http.server.SimpleHTTPRequestHandler, directory="files")
server = http.server.ThreadingHTTPServer(("127.0.0.1", int(sys.argv[1])), handler)
tls = ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER)
tls.load_cert_chain("server.pem", "server.key")
server.socket = tls.wrap_socket(server.socket, server_side=True)
server.serve_forever()
PY
python3 https.py "$(cat https.port)" >https.log 2>&1 &
echo $! >https.pid
kill "$(cat one-agent.pid)"
wait "$(cat one-agent.pid)" || true
CURL_CA_BUNDLE=$work/ca.pem start_agent one
waves 1s "files = \"https://localhost:$(cat https.port)\"
files_folder = \"files\""
project six.st 5 $far
edit five.st six.st
wait_for '^one .*reached' "$bin/stvm" fleet status --fleet fleet.toml
fleet change --yes --sign office.key >out 2>err || true
said '^one .*done'
said 'R0502: https://localhost:[0-9]+/[0-9a-f]{64}: curl says 60'
rm -f x.fleet.left
# A file of another content, under the name of the one that is wanted.
project seven.st 6 $far
edit six.st seven.st
mkdir other
echo 'of somebody else' >other/"$(sha256sum <x.fleet | cut -c1-64)"
waves 1s "files = \"file://$work/other\"
files_folder = \"files\""
fleet change --yes --sign office.key >out 2>err || true
said '^one .*refused'
said "R0102: file://$work/other: another file is there"
none_on_trial two three
for name in one two three; do expect 0 stvm stop --dir $name; done
