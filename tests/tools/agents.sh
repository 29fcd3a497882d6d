#!/bin/sh
# F-04: the table of docs/FLEET.md: so many agents in one process against a real mosquitto over TLS.
# usage: agents.sh BUILD_DIR [COUNT...]
set -eu
bin=$1/bin
shift
[ $# -gt 0 ] || set -- 100 300 1000
mosquitto=$(command -v mosquitto || ls /usr/sbin/mosquitto)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT INT TERM
cd "$work"
openssl req -x509 -newkey ec -pkeyopt ec_paramgen_curve:P-256 -nodes -days 2 -subj /CN=test-ca \
  -keyout ca.key -out ca.pem 2>/dev/null
openssl req -newkey ec -pkeyopt ec_paramgen_curve:P-256 -nodes -subj /CN=localhost \
  -keyout broker.key -out broker.csr 2>/dev/null
echo 'subjectAltName = DNS:localhost' >san
openssl x509 -req -in broker.csr -CA ca.pem -CAkey ca.key -CAcreateserial -days 2 -extfile san \
  -out broker.pem 2>/dev/null
port=$(python3 -c 'import socket; s = socket.socket(); s.bind(("127.0.0.1", 0))
print(s.getsockname()[1])')
cat >broker.conf <<CONF
user $(id -un)
listener $port 127.0.0.1
certfile $work/broker.pem
keyfile $work/broker.key
allow_anonymous true
persistence true
persistence_location $work/
max_queued_messages 0
log_type error
CONF
program() {
  echo "FUNCTION_BLOCK Filler VAR_OUTPUT n : LINT; END_VAR n := n + $2; END_FUNCTION_BLOCK
PROGRAM Main VAR f : Filler; END_VAR f(); END_PROGRAM" >"$1"
}
program v1.st 1
program v2.st 2
"$bin/stc" fleet v1.st v2.st -o x.fleet >/dev/null
echo "| controllers | all connected, s | half has it, s | the others, s | broker again, s \
| accepted, s | messages each | KiB each | agent, KiB | broker, KiB each |"
echo "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |"
for count in "$@"; do
  rm -f mosquitto.db
  "$bin/agents" "$mosquitto" "$work" "$port" "$work/v1.st" "$work/x.fleet" "$count" \
    2>mosquitto.err
done
