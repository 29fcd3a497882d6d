# For scripts that need a real broker, after lib.sh: mosquitto over TLS, with certificates of a CA
# that is made for the test, and agents of controllers with keys. The test is skipped where there is
# no mosquitto (scripts/setup.sh installs it).
broker_program=$(command -v mosquitto || ls /usr/sbin/mosquitto 2>/dev/null) || true
if [ -z "$broker_program" ] || ! command -v openssl >/dev/null; then
  echo "SKIPPED: no mosquitto or no openssl here (scripts/setup.sh installs them)"
  exit 77
fi

make_ca() {  # make_ca NAME: NAME.pem, NAME.key
  openssl req -x509 -newkey ec -pkeyopt ec_paramgen_curve:P-256 -nodes -days 2 -subj "/CN=$1" \
    -keyout "$1.key" -out "$1.pem" 2>/dev/null
}
make_ca ca
echo 'subjectAltName = DNS:localhost' >san
openssl req -newkey ec -pkeyopt ec_paramgen_curve:P-256 -nodes -subj /CN=localhost \
  -keyout server.key -out server.csr 2>/dev/null
openssl x509 -req -in server.csr -CA ca.pem -CAkey ca.key -CAcreateserial -days 2 -extfile san \
  -out server.pem 2>/dev/null
free_port() {
  python3 -c 'import socket; s = socket.socket(); s.bind(("127.0.0.1", 0))
print(s.getsockname()[1])'
}

# broker_conf NAME: NAME.conf and NAME.port; what the broker keeps survives it.
broker_conf() {
  free_port >"$1.port"
  mkdir -p "$1.kept"
  cat >"$1.conf" <<CONF
user $(id -un)
listener $(cat "$1.port") 127.0.0.1
certfile $work/server.pem
keyfile $work/server.key
allow_anonymous true
persistence true
persistence_location $work/$1.kept/
autosave_interval 1
autosave_on_changes true
CONF
}
# start_broker [NAME]
start_broker() {
  [ -e "${1:-broker}.conf" ] || broker_conf "${1:-broker}"
  "$broker_program" -c "${1:-broker}.conf" >>"${1:-broker}.log" 2>&1 &
  echo $! >"${1:-broker}.pid"
}
stop_broker() {
  kill "$(cat "${1:-broker}.pid")" && wait "$(cat "${1:-broker}.pid")" || true
}
# broker_table [NAME]: the table [broker] that leads there.
broker_table() {
  printf '[broker]\nurl = "mqtts://localhost:%s"\nca = "%s/ca.pem"\nprefix = "plant/a"\n' \
    "$(cat "${1:-broker}.port")" "$work"
}
# start_agent NAME [BROKER_FILE]: beside the controller of folder NAME, with NAME.toml as trust.
start_agent() {
  "$bin/stvm" agent --dir "$1" --broker "${2:-broker.toml}" --trust "$1.toml" \
    >>"$1.agent.log" 2>&1 &
  echo $! >"$1-agent.pid"
}
# fleet VERB OPTIONS: of x.fleet, at the controllers of fleet.toml. Nothing here is urgent.
fleet() {
  verb=$1
  shift
  "$bin/stvm" fleet "$verb" x.fleet --fleet fleet.toml --allow-overrun --timeout 600 "$@"
}
running() {
  "$bin/stvm" status --dir "$1" --format json | sed 's/.*"running":"\([0-9a-f]*\)".*/\1/'
}
