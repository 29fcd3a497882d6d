#!/bin/sh
# A start that is refused has changed nothing: what boots, the trial and the journal are as they were
# (R-09, X5).
. "$(dirname "$0")/lib.sh"
for k in 1 2 3; do
  printf 'PROGRAM Main VAR n : DINT; END_VAR n := n + %s; END_PROGRAM\n' $k >v$k.st
done
serve() { "$bin/stvm" serve --dir plc "$@" >log 2>&1 & echo $! >plc.pid; wait_for 'running' stvm status --dir plc; }
stop() { expect 0 stvm stop --dir plc; wait "$(cat plc.pid)" || true; rm plc.pid; }
serve v1.st
# A folder has one controller, also when somebody has removed its lock, its socket, or both (X5).
for gone in lock control; do
  rm -f plc/$gone
  refused_by_it() { expect 7 stvm serve --dir plc "$@"; said "R0408: a controller already runs in plc"; }
  refused_by_it
  refused_by_it v2.st
done
kill "$(cat plc.pid)"
wait "$(cat plc.pid)" || true
serve
expect 0 stvm change --dir plc -y v2.st
expect 0 stvm status --dir plc --format json
cp out before
stop
mkdir lacks
printf 'PROGRAM Main VAR i AT %%IB0 : BYTE; n : INT; END_VAR n := i; END_PROGRAM\n' >lacks/m.st
printf '[devices.sim]\ndriver = "simulated"\ninputs = "none.csv"\nmap = ["byte 0 -> %%IB0"]\n' >lacks/stc.toml
refused() {  # refused CODE TEXT OPTIONS...
  code=$1
  text=$2
  shift 2
  expect "$code" stvm serve --dir plc "$@"
  said "$text"
}
refused 2 'R0504: --device foo.x' --device foo.x=1 v3.st
refused 7 'R0503' --record /nonexistent/x v3.st
refused 7 'R0118' --code-limit 10 v3.st
refused 7 'R0412' lacks
refused 2 'R0504' --cpu 99999 v3.st
# Nor does it leave a folder that was not there.
for options in '--device foo.x=1 v3.st' '--record /nonexistent/x v3.st' '--code-limit 10 v3.st' 'lacks' \
  '--cpu 99999 v3.st' '--trust nowhere.toml v3.st'; do
  for folder in fresh deep/er; do
    code=0
    "$bin/stvm" serve --dir $folder $options >out 2>err || code=$?
    [ "$code" -ne 0 ] && [ ! -e $folder ] || fail "$code, and there is a folder: $options: $(ls $folder)"
  done
done
said '^stvm: R0501: nowhere.toml: |built without OpenSSL'
mkdir empty
expect 7 stvm serve --dir empty --code-limit 10 v3.st
[ -d empty ] || fail "a folder that was there is gone"
serve
expect 0 stvm status --dir plc --format json
json 'd["running"] == json.load(open("before"))["running"] and d["edits"] == 1'
expect 0 stvm journal --dir plc
grep -q ' installed .* -> ' out && fail "something was installed"
grep -q 'trial lost' out && fail "the trial was ended"
expect 0 stvm undo --dir plc -y
stop
# What nothing refuses is installed, and replaces the trial.
serve v3.st
expect 0 stvm journal --dir plc
said ' installed '
stop
