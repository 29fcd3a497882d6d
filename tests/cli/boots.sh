#!/bin/sh
# D4, cases 55 and 77: what a controller comes up with when it ended during a trial, by the policy
# of the project and by how it ended. `status` says it before and behind.
. "$(dirname "$0")/lib.sh"

version() {  # version FOLDER MEMBERS STEP
  mkdir -p "$1"
  cat >"$1/main.st" <<ST
VAR_GLOBAL RETAIN total : DINT; $2 END_VAR
PROGRAM Main VAR n : DINT; END_VAR n := n + $3; END_PROGRAM
ST
}
version v1 'gone : INT := 3;' 1
version v2 '' 2
version v3 'more : INT := 9;' 3
stored() { cat plc/retain_* | cksum; }  # of values that nothing else changes
policy() { for v in v1 v2 v3; do printf '[change]\nboots = "%s"\n' "$1" >$v/stc.toml; done; }

printf '[change]\nboots = "always"\n' >v2/stc.toml
serve plc v1
expect 7 stvm change v2 --dir plc --yes
said 'R0506.*"accepted" or "last-edit"'

# The default: a power loss ends the trial, and gives back what it had dropped.
policy accepted
expect 0 stvm set total=1000 gone=44 --dir plc
expect 0 stvm change v2 --dir plc --yes --allow-overrun --allow-loss
expect 0 stvm status --dir plc
said 'power loss +they are lost, and what boots next runs'
power_cut plc
serve plc
expect 0 stvm get gone total --dir plc
said 'gone=44'
said 'total=1000'
expect 0 stvm status --dir plc
said 'trial lost'

# A clean stop keeps it all the same, with the way back.
expect 0 stvm change v2 --dir plc --yes --allow-overrun --allow-loss
expect 0 stvm change v3 --dir plc --yes --allow-overrun
expect 0 stvm stop --dir plc
serve plc
grep -q '2 edit(s) are on trial still' plc.log || fail "$(cat plc.log)"
expect 0 stvm status --dir plc
said 'running, on trial'
said '2 edit.s.'
expect 0 stvm journal --dir plc
said 'trial goes on'
expect 0 stvm get more total --dir plc
said 'more=9'
expect 0 stvm undo E1 --dir plc --yes
expect 0 stvm get gone total --dir plc
said 'gone=44'
said 'total=1000'

# The policy of system D.
policy last-edit
expect 0 stvm change v2 --dir plc --yes --allow-overrun --allow-loss
expect 0 stvm change v3 --dir plc --yes --allow-overrun
before=$(stored)
expect 0 stvm set total=2000 --dir plc
expect 0 stvm status --dir plc
said 'power loss +they go on, with their ways back'
running=$(sed -n 's/^ *running *\([0-9a-f]*\).*/\1/p' out)
[ -n "$running" ] || fail "what runs"
said "boots next +$running"
for _ in $(seq 4000); do [ "$(stored)" = "$before" ] || break; sleep 0.05; done
power_cut plc
serve plc
expect 0 stvm status --dir plc
said 'running, on trial'
said '2 edit.s.'
expect 0 stvm status --dir plc --format json
said '"last_edit_boots": *true'
expect 0 stvm edits --dir plc
said '^E3  20'
said '^E4  20'
expect 0 stvm get total more --dir plc
said 'total=2000'
expect 0 stvm undo E3 --dir plc --yes
expect 0 stvm get gone total --dir plc
said 'gone=44'
said 'total=2000'
expect 0 stvm stop --dir plc
