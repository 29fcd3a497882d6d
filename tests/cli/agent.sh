#!/bin/sh
# F-01 to F-03: controllers that a broker leads to. Real agents and a real mosquitto over TLS, with
# certificates of this test: identities and health are there, an edit goes out, is undone
# and accepted; who is away gets it later; an agent is killed and the broker restarted; what the
# wrong key has signed changes nothing.
. "$(dirname "$0")/lib.sh"

# A build without the library says so.
printf '[broker]\nurl = "mqtts://localhost:1"\n[controllers.one]\nagent = "one"\n' >fleet.toml
echo 'PROGRAM Main VAR n : INT; END_VAR n := n + 1; END_PROGRAM' >a.st
stc key new office -o office.key >keys.toml 2>/dev/null || {
  echo "built without OpenSSL: agents need it; tests/cli/keys.sh shows the refusal"
  exit 0
}
{ echo 'name = "one"'; cat keys.toml; } >one.toml
expect 2 stvm agent --dir one
said 'R0504: agent: it needs --broker FILE and --trust KEYS'
expect 7 stvm agent --dir one --broker keys.toml --trust one.toml
said 'keys.toml:1:1: error.R0506'
expect 7 stvm agent --dir one --broker fleet.toml --trust keys.toml
said 'R0427: keys.toml: an agent needs .name'
printf '[broker]\nurl = "mqtt://elsewhere"\n' >plain.toml
code=0
"$bin/stvm" agent --dir one --broker plain.toml --trust one.toml >out 2>err || code=$?
if grep -q 'R0429.*libmosquitto-dev' err; then
  [ $code = 7 ] || fail "exit code $code"
  expect 7 stvm fleet status --fleet fleet.toml
  said 'R0429.*libmosquitto-dev'
  echo "built without libmosquitto: refused, as it should be"
  exit 0
fi
said 'R0504.*without TLS only a broker of this machine'
. "$source_dir/tests/cli/lib_broker.sh"
make_ca other-ca
start_broker

# Two controllers with keys, and their agents.
project() {  # project FILE STEP
  cat >"$1" <<ST
FUNCTION_BLOCK Filler VAR_OUTPUT n : LINT; END_VAR n := n + $2; END_FUNCTION_BLOCK
PROGRAM Main VAR f : Filler; errors : DINT; END_VAR f(); IF f.n < 0 THEN errors := errors + 1;
END_IF END_PROGRAM
ST
}
project v1.st 1
project v2.st 2
stc build -q v1.st -o v1.img
stc key sign v1.img --key office.key -o v1.signed
stc fleet v1.st v2.st -o x.fleet 2>/dev/null
broker_table >broker.toml
broker_table >fleet.toml
for name in one two; do
  { echo "name = \"$name\""; cat keys.toml; } >$name.toml
  serve $name --trust $name.toml v1.signed
  start_agent $name
  printf '[controllers.%s]\nagent = "%s"\n' $name $name >>fleet.toml
done

# F-01: what they are is there without asking them.
wait_for '^two +Main|^two +v1|^two +[A-Za-z0-9]+ +reached' "$bin/stvm" fleet status --fleet fleet.toml
expect 0 stvm fleet status x.fleet --fleet fleet.toml
said 'Filler'
old=$(running one)

# E-01: what agents publish are units as they know them; for those of the edit they are asked.
mkdir joined
cp v2.st joined
printf '[units]\nJoined = ["Filler", "Main"]\n' >joined/stc.toml
stc fleet v1.st joined -o joined.fleet 2>/dev/null
expect 0 stvm fleet status joined.fleet --fleet fleet.toml --sign office.key
said '^unit Joined +ok +ok *$|^unit Joined +ok *$'
expect 7 stvm fleet status joined.fleet --fleet fleet.toml
said 'R0420'

# F-03: unsigned, and signed by somebody else. Nothing happens there.
expect 7 fleet change --yes
said 'R0420: agents carry out only what is signed'
stc key new stranger -o stranger.key >stranger.toml
expect 7 fleet change --yes --sign stranger.key
said 'R0422'
[ "$(running one)$(running two)" = "$old$old" ] || fail "an order of a stranger was carried out"

# F-02: the check, the change; again; undo, twice.
expect 0 fleet change --dry-run --sign office.key
said '^one +.*possible'
[ "$(running one)" = "$old" ] || fail "a dry run changed it"
expect 0 fleet change --yes --sign office.key
said '^one .*done'
said '^two .*done'
expect 0 stvm journal --dir one
said 'fleet file [0-9a-f]{12}, plan [0-9a-f]{8} wave 1 by .*signed by office'
expect 0 fleet change --yes --sign office.key
said '^one .*had it'
expect 0 fleet undo --yes --sign office.key
[ "$(running one)$(running two)" = "$old$old" ] || fail "it is not taken back"
expect 0 fleet undo --yes --sign office.key

# R-09: SIGHUP has it read the file of the broker anew and connect; a bad file changes nothing.
cp broker.toml good.toml
echo nonsense >broker.toml
kill -HUP "$(cat two-agent.pid)"
wait_for 'agent: SIGHUP: stays connected' cat two.agent.log
sed 's#^ca = .*#ca = "/nowhere/ca.pem"#' good.toml >broker.toml
cmp -s good.toml broker.toml && fail "the broker has no ca"
kill -HUP "$(cat two-agent.pid)"
wait_for 'agent: connects as before: .*nowhere' cat two.agent.log
wait_for '^two .*reached' "$bin/stvm" fleet status --fleet fleet.toml
cp good.toml broker.toml
kill -HUP "$(cat two-agent.pid)"
wait_for '^2$' grep -c 'agent: SIGHUP: connects anew' two.agent.log
wait_for '^two .*reached' "$bin/stvm" fleet status --fleet fleet.toml

# An agent is killed: its will says so. What is ordered waits, and it comes back to it.
kill -9 "$(cat two-agent.pid)"
wait_for '^two .*unreachable' "$bin/stvm" fleet status --fleet fleet.toml
expect 1 fleet change --yes --sign office.key
said '^one .*done'
said 'R0404: its agent is not connected to the broker; the order waits for it'
[ "$(running two)" = "$old" ] || fail "who ordered that?"
# Nor does it start by what is asked meanwhile, and that takes it away neither.
expect 1 fleet change --dry-run --sign office.key
said '^one .*had it'
said 'R0404: its agent is not connected to the broker, and no other one shows its program: noth'
stvm fleet continue x.fleet --yes --sign office.key --allow-overrun >out 2>err || true
said 'nothing new is ordered'
# So does the broker, with all that it keeps.
stop_broker
start_broker
start_agent two
wait_for '"edits":1' "$bin/stvm" status --dir two --format json
wait_for '^two .*had it' fleet change --yes --sign office.key
[ ! -e x.fleet.left ] || fail "somebody is left"
expect 0 fleet accept --yes --sign office.key
said '^two .*accepted'
new=$(running two)

# A broker with another certificate is no broker.
sed 's/ca.pem/other-ca.pem/' fleet.toml >other-fleet.toml
expect 7 stvm fleet status --fleet other-fleet.toml --timeout 3
said 'R0404.*the broker knows no agent'
