#!/bin/sh
# R-12, F-01: the agent of a controller as a service of a real systemd. It connects to a real broker, an
# edit goes out to it, is taken back and accepted; agent and controller are killed and go on; when it
# is stopped, the broker says so.
. "$(dirname "$0")/lib.sh"
. "$source_dir/tests/cli/lib_broker.sh"
stc key new office -o office.key >keys.toml 2>/dev/null || {
  echo "built without OpenSSL: no agents"
  exit 77
}
. "$source_dir/tests/cli/lib_machine.sh"
ls packages/stvm-agent_*.deb >out || fail "no package of the agent"
expect 0 there sh -c 'apt-get install -y --no-install-recommends /root/stvm_*.deb /root/stvm-agent_*.deb'

start_broker
printf 'FUNCTION_BLOCK F VAR_OUTPUT n : LINT; END_VAR n := n + 1; END_FUNCTION_BLOCK
PROGRAM Main VAR f1 : F; END_VAR f1(); END_PROGRAM\n' >v1.st
sed 's/n + 1/n + 2/' v1.st >v2.st
stc build -q v1.st -o v1.img
stc key sign v1.img --key office.key -o v1.signed
stc fleet v1.st v2.st -o x.fleet >out

# there_is FILE: what comes in stands in /etc/stvm, for the user of the service to read.
there_is() { there tee "/etc/stvm/$1" >/dev/null; }
there_is line.img <v1.signed
there_is ca.pem <ca.pem
broker_table | sed 's#^ca = .*#ca = "ca.pem"#' | there_is broker.toml
{ echo 'name = "line"'; cat keys.toml; } | there_is line.trust.toml
there mkdir -p /etc/systemd/system/stvm@line.service.d
# As the comments of the unit say it.
there sed -n 's/^#   \(\[Service\]\|ExecStart=.*\)$/\1/p; s/^#     \(--trust .*\)$/  \1/p' \
  /usr/lib/systemd/system/stvm-agent@.service >trust.conf
[ "$(wc -l <trust.conf)" -eq 4 ] || fail "other comments: $(cat trust.conf)"
there tee /etc/systemd/system/stvm@line.service.d/trust.conf <trust.conf >/dev/null
expect 0 there systemctl daemon-reload
expect 0 there systemd-analyze verify --man=no stvm-agent@line.service
silent_on err

# The agent may come first.
expect 0 there systemctl enable --now stvm-agent@line
expect 0 there systemctl enable --now stvm@line
expect 0 there systemd-analyze security --threshold=25 stvm-agent@line
{ broker_table; printf '[controllers.line]\nagent = "line"\n'; } >fleet.toml
wait_for '^line .*reached' "$bin/stvm" fleet status --fleet fleet.toml
expect 0 fleet change --yes --sign office.key
said '^line .*done'
expect 0 there stvm journal --dir /var/lib/stvm/line
said 'signed by office'
expect 0 fleet undo --yes --sign office.key
wait_for '^line .*done' fleet change --yes --sign office.key

# Both are killed, the agent last; the edit on trial is undone by that, as after a power cut.
was=$(main_pid stvm@line)
there kill -KILL "$was"
has_followed stvm@line "$was" there stvm status --dir /var/lib/stvm/line >out
was=$(main_pid stvm-agent@line)
there kill -KILL "$was"
has_followed stvm-agent@line "$was" true
wait_for '^line .*done' fleet change --yes --sign office.key
expect 0 fleet accept --yes --sign office.key
said '^line .*accepted'

expect 0 there systemctl stop stvm-agent@line
expect 0 there systemctl show stvm-agent@line -p Result
said '^Result=success$'
wait_for '^line .*unreachable' "$bin/stvm" fleet status --fleet fleet.toml
expect 0 there stvm status --dir /var/lib/stvm/line
said ': running$'
